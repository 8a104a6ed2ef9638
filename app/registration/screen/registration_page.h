#pragma once

#include <map>
#include <string>

#include "app/panels/widgets/theme.h"
#include "app/panels/widgets/widgets.h"
#include "app/registration/live_session.h"
#include "app/registration/registration_pictures.h"

namespace insonate::ui {

/// What the person asked for on the page.
struct RegistrationWish {
  bool refine = false;  ///< turn refining on or off
  bool search = false, reset = false, save = false;
};

/// The page of a live registration: the received image, the simulated one and their blend, what is known of the
/// estimate, and buttons.
class RegistrationPage {
public:
  /// Draws the page into ImGui's current frame.
  /// @param notice  what has been saved, or why not; empty: nothing
  RegistrationWish draw(const Theme& theme, const Rect& screen, const LiveSession& session,
                        const RegistrationPictures& pictures, double pictures_per_second, const std::string& notice);

  /// Returns the rectangles of the buttons and pictures, by name.
  const std::map<std::string, Rect>& places() const { return places_; }

private:
  void draw_picture(const Theme& theme, const Rect& where, const char* name, const char* title,
                    const gl::Texture& texture, bool shown);
  void draw_facts(const Theme& theme, Rect where, const LiveSession& session, double pictures_per_second) const;
  RegistrationWish draw_buttons(const Theme& theme, Rect row, const LiveSession& session);

  std::map<std::string, Rect> places_;
};

}  // namespace insonate::ui
