// Where the views lie, without a window.
#include "app/panels/layout.h"

#include <catch2/catch.hpp>

#include <set>

using namespace insonate;
using namespace insonate::ui;

namespace {

constexpr float kGap = 8;
constexpr LayoutName kNames[] = {LayoutName::standard, LayoutName::slices, LayoutName::four};
constexpr View kViews[] = {View::ultrasound, View::recorded, View::space,   View::slice,
                           View::blend,      View::axial,    View::coronal, View::sagittal};

std::set<View> seen(const std::map<View, Rect>& places) {
  std::set<View> views;
  for (const auto& [view, rect] : places) views.insert(view);
  return views;
}

bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.x + b.w + kGap - 0.5f && b.x < a.x + a.w + kGap - 0.5f && a.y < b.y + b.h + kGap - 0.5f &&
         b.y < a.y + a.h + kGap - 0.5f;
}

bool same(const Rect& a, const Rect& b) {
  return a.x == b.x && a.y == b.y && a.w == b.w && a.h == b.h;
}

}  // namespace

TEST_CASE("each layout has its views, and without anatomy only the ultrasound and the 3D view") {
  const Rect area{8, 80, 1264, 460};
  CHECK(seen(lay_out({LayoutName::standard, {}}, area, kGap, {})) ==
        std::set{View::ultrasound, View::space, View::slice, View::blend});
  CHECK(seen(lay_out({LayoutName::slices, {}}, area, kGap, {})) ==
        std::set{View::ultrasound, View::space, View::axial, View::coronal, View::sagittal});
  CHECK(seen(lay_out({LayoutName::four, {}}, area, kGap, {})) ==
        std::set{View::ultrasound, View::space, View::slice, View::blend});
  for (const LayoutName name : kNames)
    CHECK(seen(lay_out({name, {}}, area, kGap, {.anatomy = false})) == std::set{View::ultrasound, View::space});
}

TEST_CASE("views lie within the area, apart from each other, and fill it on any screen") {
  for (const Rect& area :
       {Rect{8, 80, 1008, 340}, Rect{8, 80, 1264, 460}, Rect{16, 160, 2528, 960}, Rect{0, 0, 900, 900}})
    for (const LayoutName name : kNames)
      for (const bool anatomy : {true, false})
        for (const bool recorded : {true, false}) {
          const auto places = lay_out({name, {}}, area, kGap, {anatomy, recorded, recorded});
          CAPTURE(area.w, area.h, int(name), anatomy, recorded);
          CHECK(places.contains(View::recorded) == recorded);
          float left = 1e9f, right = 0, top = 1e9f, bottom = 0;
          for (const auto& [view, rect] : places) {
            CHECK(rect.w >= 100);
            CHECK(rect.h >= 100);
            left = std::min(left, rect.x), right = std::max(right, rect.x + rect.w);
            top = std::min(top, rect.y), bottom = std::max(bottom, rect.y + rect.h);
            for (const auto& [other, place] : places) CHECK((view == other || !overlap(rect, place)));
          }
          CHECK(left == area.x);
          CHECK(right == area.x + area.w);
          CHECK(top == area.y);
          CHECK(bottom == area.y + area.h);
        }
}

TEST_CASE("a fan fills the ultrasound's panel, and a CT's pane is as wide as the fan in it") {
  struct Window {
    Rect area;
    bool charts;
  };
  // What top bar, console and charts leave of windows of 1280 x 720, 1600 x 1000 and 2560 x 1440.
  for (const auto& [area, charts] : {Window{{8, 80, 1264, 312}, true},
                                     {{8, 80, 1264, 460}, false},
                                     {{8, 80, 1584, 592}, true},
                                     {{8, 80, 1584, 715}, false},
                                     {{8, 80, 2544, 860}, true},
                                     {{8, 80, 2544, 1040}, false}}) {
    const auto places = lay_out({LayoutName::standard, {}}, area, kGap, {.charts = charts});
    CAPTURE(area.w, area.h, charts);
    const Rect& ultrasound = places.at(View::ultrasound);
    CHECK(ultrasound.w < 1.65f * ultrasound.h);  // a fan is 1.2 to 1.4 times as wide as high, and has scales beside it
    for (const View view : {View::slice, View::blend}) CHECK(places.at(view).w > 1.2f * places.at(view).h);
    CHECK(places.at(View::space).w > 1.0f * places.at(View::space).h);
  }
}

TEST_CASE("slice and blend lie side by side if they are joined, in a flat area too") {
  const Rect flat{8, 80, 1264, 312};
  const auto beside = [&](bool joined) {
    const auto places = lay_out({LayoutName::standard, {}}, flat, kGap, {.charts = true, .joined = joined});
    return places.at(View::slice).y == places.at(View::blend).y;
  };
  CHECK(beside(true));
  CHECK_FALSE(beside(false));
}

TEST_CASE("the four views are of equal size, and the slices too") {
  const auto four = lay_out({LayoutName::four, {}}, {0, 0, 1001, 601}, kGap, {});
  const auto slices = lay_out({LayoutName::slices, {}}, {0, 0, 1001, 601}, kGap, {});
  for (const View view : {View::space, View::slice, View::blend}) {
    CHECK(four.at(view).w == four.at(View::ultrasound).w);
    CHECK(four.at(view).h == four.at(View::ultrasound).h);
  }
  for (const View view : {View::coronal, View::sagittal, View::space}) {
    CHECK(slices.at(view).w == slices.at(View::axial).w);
    CHECK(slices.at(view).h == slices.at(View::axial).h);
  }
}

TEST_CASE("a large view has the area for itself, if it may be seen") {
  const Rect area{8, 80, 1264, 460};
  for (const LayoutName name : kNames)
    for (const View view : kViews) {
      CAPTURE(name_of(view));
      const auto places = lay_out({name, view}, area, kGap, {});
      if (view == View::recorded) {
        CHECK(places.size() > 1);  // there is none
        continue;
      }
      REQUIRE(places.size() == 1);
      CHECK(same(places.at(view), area));
      const auto hidden = lay_out({name, view}, area, kGap, {.anatomy = false});
      if (view == View::ultrasound || view == View::space)
        CHECK(hidden.size() == 1);
      else
        CHECK(seen(hidden) == std::set{View::ultrasound, View::space});
    }
}

TEST_CASE("a recorded image and the ultrasound have one size, and are large together") {
  const Rect area{8, 80, 1264, 460};
  const LayoutRules rules{.recorded = true, .charts = true};
  for (const std::optional<View>& large :
       {std::optional<View>(), std::optional(View::ultrasound), std::optional(View::recorded)}) {
    const auto places = lay_out({LayoutName::standard, large}, area, kGap, rules);
    CHECK(places.at(View::recorded).w == places.at(View::ultrasound).w);
    CHECK(places.at(View::recorded).h == places.at(View::ultrasound).h);
    CHECK((places.size() == 2) == large.has_value());
  }
  CHECK_FALSE(lay_out({LayoutName::standard, View::space}, area, kGap, rules).contains(View::recorded));
}

TEST_CASE("views have names of their own") {
  std::set<std::string> names;
  for (const View view : kViews) names.insert(name_of(view));
  CHECK(names.size() == std::size(kViews));
  CHECK_FALSE(names.contains(""));
}
