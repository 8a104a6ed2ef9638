// Whether all of a page can be read in each size of text, on small and large screens.
#include <catch2/catch.hpp>

#include "app/panels/pages/help_page.h"
#include "app/panels/pages/settings_page.h"
#include "app/panels/scan/guide_layer.h"
#include "app/panels/views/look_panel.h"
#include "sim/files/files.h"

using namespace insonate;
using namespace insonate::ui;

namespace {

constexpr TextSize kTextSizes[] = {TextSize::normal, TextSize::large, TextSize::largest};

/// Calls `draw` within a frame of each size of screen and text, and checks that no text was cut and that what was
/// placed lies on the screen.
template <typename Draw>
void check_readable(Draw draw) {
  for (const auto& [width, height] : {std::pair{1280.0f, 720.0f}, {1280.0f, 800.0f}, {1600.0f, 1000.0f}})
    for (const TextSize size : kTextSizes) {
      ImGui::CreateContext();
      {
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = {width, height};
        ImGui::GetIO().DeltaTime = 0.1f;
        Theme theme(assets_folder() / "fonts");
        Look look;
        look.text_size = size;
        theme.fit(width, height, look);
        ImGui::NewFrame();
        std::map<std::string, Rect> places;
        take_cut_texts();
        draw(theme, Rect{0, 0, width, height}, places);
        ImGui::Render();
        CAPTURE(width, height, int(size));
        CHECK(take_cut_texts() == std::vector<std::string>());
        for (const auto& [name, place] : places) {
          CAPTURE(name, place.y, place.h);
          CHECK(place.y + place.h < height);
          CHECK(place.x + place.w < width);
        }
      }
      ImGui::DestroyContext();
    }
}

}  // namespace

TEST_CASE("a text that is cut is reported once") {
  check_readable([](const Theme& theme, const Rect& screen, std::map<std::string, Rect>&) {
    ImGui::Begin("text");
    draw_text({0, 0, screen.w, 30}, theme.text, colour::kText, "It fits");
    CHECK(take_cut_texts().empty());
    draw_text({0, 0, 30, 30}, theme.text, colour::kText, "It does not fit");
    CHECK(take_cut_texts() == std::vector<std::string>{"It does not fit"});
    draw_paragraph({0, 0, 90, 20}, theme.text, colour::kText, "It has more lines than there is room for");
    CHECK(take_cut_texts().size() == 1);
    ImGui::End();
  });
}

TEST_CASE("every page of help can be read in every size of text") {
  for (const HelpTopic topic :
       {HelpTopic::start, HelpTopic::learners, HelpTopic::check, HelpTopic::scan, HelpTopic::exam, HelpTopic::replay,
        HelpTopic::setup, HelpTopic::author, HelpTopic::score, HelpTopic::volume, HelpTopic::open, HelpTopic::settings})
    check_readable([&](const Theme& theme, const Rect& screen, std::map<std::string, Rect>& places) {
      draw_help(theme, screen, topic, places);
    });
}

TEST_CASE("the settings can be read in every size of text, with long paths") {
  Preferences preferences;
  preferences.out = "/home/somebody/Documents/Ultrasound/Practice/Reports and pictures";
  preferences.results = "/home/somebody/Documents/Ultrasound/Practice/Results of this year/results.db";
  check_readable([&](const Theme& theme, const Rect& screen, std::map<std::string, Rect>& places) {
    draw_settings(theme, screen, preferences, {}, "/home/somebody/.config/insonate/settings.toml", places);
  });
}

TEST_CASE("the looks of the patient have their whole names in every size of text") {
  PatientLook look;
  look.choose(std::nullopt);
  check_readable([&](const Theme& theme, const Rect& screen, std::map<std::string, Rect>& places) {
    ImGui::Begin("look");
    LookPanel().draw(theme, {0, 0, screen.w * 0.4f, screen.h * 0.4f}, look, places);
    ImGui::End();
  });
}

TEST_CASE("the guide shows what to do now and next, with its keys, in every size of text") {
  ReferenceView view;
  view.title = "Liver from under the ribs, hepatic veins";
  Guiding guiding;
  guiding.view = &view;
  guiding.advice = {"Slide 184 mm towards the head and the patient's right.", "Rotate 120\u00b0 counter-clockwise.",
                    "Tilt 39\u00b0, the beam towards the patient's right.",
                    "Rock 16\u00b0, the beam away from the marker."};
  guiding.keys = {"\u2191 \u2190", "Q", "A", "W"};
  check_readable([&](const Theme& theme, const Rect& screen, std::map<std::string, Rect>&) {
    ImGui::Begin("guide");
    const float width = screen.w - theme.px(16);
    CHECK(draw_guide_strip(theme, {0, 0, width, guide_strip_height(theme)}, guiding, true) >= 2);
    ImGui::End();
  });
}
