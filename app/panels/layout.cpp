#include "app/panels/layout.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace insonate::ui {
namespace {

using Places = std::map<View, Rect>;

/// Cuts an area into two columns or rows of equal size.
std::pair<Rect, Rect> columns(Rect area, float gap) {
  const Rect left = area.take_left(std::floor((area.w - gap) / 2));
  return {left, {area.x + area.w - left.w, area.y, left.w, area.h}};
}
std::pair<Rect, Rect> rows(Rect area, float gap) {
  const Rect upper = area.take_top(std::floor((area.h - gap) / 2));
  return {upper, {area.x, area.y + area.h - upper.h, area.w, upper.h}};
}

/// The widest fan, a curved one of usual depth or a sector, is so many times as wide as high.
constexpr float kFan = 1.45f;

/// The ultrasound comes first. The other views get a third of the width, and at most what makes them square. Where the
/// height limits the fan, they get the width that it leaves. The CT's panes are not higher than a fan that fills their
/// width. In a flat area they lie beside the 3D view, not below.
Places standard(Rect area, float gap, const LayoutRules& rules) {
  float others = std::min(area.w * 0.35f, area.h * (rules.recorded ? 1.0f : 0.82f));
  if (!rules.recorded)
    others = std::max(others, std::min(area.w * (rules.charts ? 0.6f : 0.45f), area.w - gap - area.h * kFan));
  Rect side = area.take_right(std::round(others));
  area.take_right(gap);
  Places places{{View::ultrasound, area}};
  if (!rules.anatomy) {
    places[View::space] = side;
    return places;
  }
  constexpr float kFlat = 1.6f;
  if (side.w > kFlat * side.h && !rules.joined) {
    const auto [upper, lower] = rows(side.take_right(std::round(std::min(0.4f * side.w, kFan * side.h / 2))), gap);
    side.take_right(gap);
    return {{View::ultrasound, area}, {View::space, side}, {View::slice, upper}, {View::blend, lower}};
  }
  const float panes = std::min(side.h * 0.42f, (side.w - gap) / 2 / kFan + gap);
  places[View::space] = side.take_top(std::round(side.h - panes));
  side.take_top(gap);
  std::tie(places[View::slice], places[View::blend]) = columns(side, gap);
  return places;
}

/// The patient's axes as radiologists know them, around the 3D view.
Places slices(Rect area, float gap, const LayoutRules& rules) {
  Rect others = area.take_right(std::round(area.w * (rules.anatomy ? 0.55f : 0.4f)));
  area.take_right(gap);
  Places places{{View::ultrasound, area}};
  if (!rules.anatomy) {
    places[View::space] = others;
    return places;
  }
  const auto [upper, lower] = rows(others, gap);
  std::tie(places[View::axial], places[View::space]) = columns(upper, gap);
  std::tie(places[View::coronal], places[View::sagittal]) = columns(lower, gap);
  return places;
}

Places four(const Rect& area, float gap, const LayoutRules& rules) {
  Places places;
  if (!rules.anatomy) {
    std::tie(places[View::ultrasound], places[View::space]) = columns(area, gap);
    return places;
  }
  const auto [upper, lower] = rows(area, gap);
  std::tie(places[View::ultrasound], places[View::space]) = columns(upper, gap);
  std::tie(places[View::slice], places[View::blend]) = columns(lower, gap);
  return places;
}

bool may_be_seen(View view, const LayoutRules& rules) {
  switch (view) {
    case View::ultrasound:
    case View::space:
      return true;
    case View::recorded:
      return rules.recorded;
    case View::slice:
    case View::blend:
    case View::axial:
    case View::coronal:
    case View::sagittal:
      return rules.anatomy;
  }
  return false;
}

Places named(LayoutName name, const Rect& area, float gap, const LayoutRules& rules) {
  switch (name) {
    case LayoutName::standard:
      return standard(area, gap, rules);
    case LayoutName::slices:
      return slices(area, gap, rules);
    case LayoutName::four:
      return four(area, gap, rules);
  }
  return {};
}

}  // namespace

const char* name_of(View view) {
  switch (view) {
    case View::ultrasound:
      return "ultrasound";
    case View::recorded:
      return "recorded";
    case View::space:
      return "space";
    case View::slice:
      return "slice";
    case View::blend:
      return "blend";
    case View::axial:
      return "axial";
    case View::coronal:
      return "coronal";
    case View::sagittal:
      return "sagittal";
  }
  return "";
}

std::map<View, Rect> lay_out(const Layout& layout, const Rect& area, float gap, const LayoutRules& rules) {
  Places places;
  if (layout.large && may_be_seen(*layout.large, rules))
    // A recorded image is compared with the ultrasound, so the two are large together.
    places[*layout.large == View::recorded ? View::ultrasound : *layout.large] = area;
  else
    places = named(layout.name, area, gap, rules);
  if (const auto ultrasound = places.find(View::ultrasound); rules.recorded && ultrasound != places.end())
    // Equal sizes give both the same scale.
    std::tie(places[View::ultrasound], places[View::recorded]) = columns(Rect(ultrasound->second), gap);
  return places;
}

}  // namespace insonate::ui
