#pragma once

#include <algorithm>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"

namespace insonate::ui {

/// Returns the upper part of an area that whole rows fill, so that no row is cut before the area is scrolled.
inline Rect whole_rows(const Rect& area, float row) {
  return {area.x, area.y, area.w, row * float(std::max(1, int(area.h / row)))};
}

/// An area that scrolls if its content is higher than it. Everything that is drawn during its life lies in it and
/// is cut off at its edges.
///
///     const ScrollArea area(theme, "rows", where, kRow * rows.size());
///     draw(area.content());
class ScrollArea {
public:
  /// @param height  of the content
  ScrollArea(const Theme& theme, const char* id, const Rect& where, float height);
  ~ScrollArea();
  ScrollArea(const ScrollArea&) = delete;
  ScrollArea& operator=(const ScrollArea&) = delete;

  /// Returns where the content lies now: as wide as the area without its scroll bar, and above or below it in part.
  const Rect& content() const { return content_; }
  /// Returns whether a part of the content is seen in part, or completely.
  bool shows(const Rect& part) const { return part.y + part.h > where_.y && part.y < where_.y + where_.h; }
  bool shows_all_of(const Rect& part) const { return part.y >= where_.y && part.y + part.h <= where_.y + where_.h; }
  /// Scrolls as little as brings a part of the content into view, from the next frame on.
  void bring_into_view(const Rect& part) const;

private:
  Rect where_, content_;
};

}  // namespace insonate::ui
