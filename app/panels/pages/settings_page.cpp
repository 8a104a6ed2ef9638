#include "app/panels/pages/settings_page.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "app/panels/pages/overlays.h"
#include "app/panels/widgets/choice_rows.h"
#include "app/recording/results.h"

namespace insonate::ui {
namespace {

constexpr float kWidth = 860, kLabel = 250, kSettingRow = 42, kReset = 80, kChoose = 90, kGap = 8;
constexpr const char *kHere = "18944", *kNetwork = "0.0.0.0:18944";

/// Draws the page's rows from the top down.
class Rows {
public:
  Rows(const Theme& theme, const Rect& rest, std::map<std::string, Rect>& places)
      : theme_(theme), rest_(rest), places_(places) {}

  /// Draws the choices of a setting. Returns which other one was clicked.
  std::optional<std::size_t> choose(const std::string& id, const char* label, const std::vector<std::string>& texts,
                                    std::size_t chosen) {
    std::vector<Choice> choices;
    for (std::size_t i = 0; i < texts.size(); ++i)
      choices.push_back({"settings_" + id + "_" + std::to_string(i), texts[i],
                         i == chosen ? ButtonKind::chosen : ButtonKind::normal, true});
    const auto clicked = row_of_choices(theme_, next(label), choices, places_);
    return clicked == chosen ? std::nullopt : clicked;
  }

  enum class PathAnswer { none, choose, reset };
  /// Draws a path with buttons to change it.
  PathAnswer path(const std::string& id, const char* label, const std::filesystem::path& path,
                  const std::string& otherwise) {
    const std::string text = path.empty() ? otherwise : path.string();
    Rect line = next(label, path_height(theme_, text));
    PathAnswer answer = PathAnswer::none;
    const auto press = [&](const std::string& what, const char* words, float width, bool enabled) {
      Rect place = line.take_right(theme_.px(width));
      line.take_right(theme_.px(kGap));
      place =
          places_["settings_" + id + "_" + what] = {place.x, place.centre().y - theme_.px(17), place.w, theme_.px(34)};
      return button(theme_, ("settings_" + id + "_" + what).c_str(), place, words, ButtonKind::normal, enabled);
    };
    if (press("reset", "Reset", kReset, !path.empty())) answer = PathAnswer::reset;
    if (press("choose", "Choose", kChoose, true)) answer = PathAnswer::choose;
    const float height = paragraph_height(theme_.text, text, line.w);
    draw_paragraph({line.x, line.centre().y - height / 2, line.w, height}, theme_.text,
                   path.empty() ? colour::kMuted : colour::kText, text);
    return answer;
  }

  /// Returns the height of a path's row, in which a long path has several lines.
  static float path_height(const Theme& theme, const std::string& text) {
    const float width = theme.px(kWidth - 2 * 28 - kLabel - kReset - kChoose - 2 * kGap);
    return std::max(theme.px(kSettingRow), paragraph_height(theme.text, text, width) + theme.px(12));
  }

  /// Draws a setting that cannot be changed now.
  void fixed(const char* label, const std::string& text) { draw_text(next(label), theme_.text, colour::kMuted, text); }

  void heading(const char* text) {
    rest_.take_top(theme_.px(8));
    draw_text(rest_.take_top(theme_.px(30)), theme_.strong, colour::kAccent, text);
  }

private:
  Rect next(const char* label) { return next(label, theme_.px(kSettingRow)); }
  Rect next(const char* label, float height) {
    Rect line = rest_.take_top(height).inset(0, theme_.px(4));
    draw_text(line.take_left(theme_.px(kLabel)), theme_.text, colour::kText, label);
    return line;
  }

  const Theme& theme_;
  Rect rest_;
  std::map<std::string, Rect>& places_;
};

std::string own_results_text() {
  try {
    return own_results().string();
  } catch (const std::exception&) {
    return "none";
  }
}

}  // namespace

SettingsAnswer draw_settings(const Theme& theme, const Rect& screen, const Preferences& preferences,
                             const Options& options, const std::filesystem::path& kept_in,
                             std::map<std::string, Rect>& places) {
  SettingsAnswer answer;
  Preferences wanted = preferences;
  std::error_code error;
  const std::string out_text = std::filesystem::absolute(options.out, error).string();
  const std::string cases_text = "those in the working folder", results_text = own_results_text();
  float paths = 0;
  for (const auto& [path, otherwise] :
       {std::pair{&wanted.out, &out_text}, {&wanted.cases, &cases_text}, {&wanted.results, &results_text}})
    paths += Rows::path_height(theme, path->empty() ? *otherwise : path->string());
  Rect sheet =
      begin_overlay(theme, screen, {theme.px(kWidth), theme.px(2 * 24 + 28 + 6 * kSettingRow + 3 * 38 + 60) + paths});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kText, "Settings");
  Rect buttons = sheet.take_bottom(theme.px(38));
  Rows rows(theme, sheet, places);
  const auto set = [&]<typename Word>(Word& of, std::optional<std::size_t> clicked) {
    if (clicked) of = Word(*clicked);
  };

  rows.heading("How it looks");
  Look& look = wanted.look;
  set(look.text_size, rows.choose("text", "Text", {"Normal", "Large", "Largest"}, std::size_t(look.text_size)));
  set(look.length_unit, rows.choose("depth", "Depth in", {"cm", "mm"}, std::size_t(look.length_unit)));
  set(look.marker, rows.choose("marker", "The probe's marker", {"Left, as for the abdomen", "Right, as for the heart"},
                               std::size_t(look.marker)));
  set(look.tint, rows.choose("tint", "The ultrasound's colour", {"Grey", "Warm", "Cool"}, std::size_t(look.tint)));

  rows.heading("The ultrasound");
  if (const auto level =
          rows.choose("quality", "Quality", {"Fast", "Balanced", "Exact"}, std::size_t(quality_named(options.quality))))
    wanted.quality = quality_names()[*level];
  const std::vector<std::string> servers{"", kHere, kNetwork};
  std::vector<std::string> server_texts{"No", "On this computer", "On the network"};
  const auto served = std::find(servers.begin(), servers.end(), wanted.igtl_server);
  if (served == servers.end()) server_texts.push_back("At " + wanted.igtl_server);
  if (!options.igtl_server.empty())
    rows.fixed("Sent to 3D Slicer and others", options.igtl_server + ", by the command line");
  else if (const auto server = rows.choose("server", "Sent to 3D Slicer and others", server_texts,
                                           std::size_t(std::distance(servers.begin(), served))))
    wanted.igtl_server = servers[*server];

  rows.heading("Files");
  const auto path = [&](const std::string& id, const char* label, std::filesystem::path& of,
                        const std::string& otherwise, Wanted browse) {
    switch (rows.path(id, label, of, otherwise)) {
      case Rows::PathAnswer::none:
        break;
      case Rows::PathAnswer::choose:
        answer.browse = browse;
        break;
      case Rows::PathAnswer::reset:
        of.clear();
        break;
    }
  };
  path("out", "Reports, pictures, recordings", wanted.out, out_text, Wanted::output);
  path("cases", "Patients of your own", wanted.cases, cases_text, Wanted::cases);
  if (!options.results.empty())
    rows.fixed("Results of learners", options.results.string() + ", by the command line");
  else
    path("results", "Results of learners", wanted.results, results_text, Wanted::results);

  places["settings_close"] = buttons.take_right(theme.px(150));
  answer.close = button(theme, "settings_close", places["settings_close"], "Close  (Esc)", ButtonKind::primary);
  buttons.take_right(theme.px(kGap));
  const std::string kept =
      kept_in.empty() ? "Not kept: the file of settings cannot be used." : "Changes are kept in " + kept_in.string();
  const float kept_height = paragraph_height(theme.small_text, kept, buttons.w);
  draw_paragraph({buttons.x, buttons.centre().y - kept_height / 2, buttons.w, kept_height}, theme.small_text,
                 kept_in.empty() ? colour::kAmber : colour::kMuted, kept);
  end_overlay();
  if (wanted != preferences) answer.wanted = wanted;
  return answer;
}

}  // namespace insonate::ui
