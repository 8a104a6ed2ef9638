#include "app/panels/pages/open_dialog.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "app/panels/pages/overlays.h"
#include "app/panels/start/start_list.h"

namespace insonate::ui {
namespace {

const char* title_of(Wanted wanted) {
  switch (wanted) {
    case Wanted::anything:
      return "Open";
    case Wanted::patient:
      return "Open a CT or a case";
    case Wanted::scenario:
      return "Open a scenario";
    case Wanted::checked:
      return "Check a scenario";
    case Wanted::recording:
      return "Open a recorded scan";
    case Wanted::calibration:
      return "Use a calibration";
    case Wanted::landmarks:
      return "Use a patient's landmarks";
    case Wanted::drawing:
      return "Use a drawing of the probe";
    case Wanted::look:
      return "Use a transfer function";
    case Wanted::output:
      return "The folder for reports, pictures and recordings";
    case Wanted::cases:
      return "The folder of your own patients";
    case Wanted::results:
      return "The database of results";
  }
  return "Open";
}

const char* what_is_shown(Wanted wanted) {
  switch (wanted) {
    case Wanted::anything:
      return "CTs, case and DICOM folders, scenarios and recorded scans. Or drop one on the window.";
    case Wanted::patient:
      return "CTs (NIfTI, NRRD, MetaImage), case folders and DICOM folders. Or drop one on the window.";
    case Wanted::scenario:
    case Wanted::checked:
      return "Scenario files (.toml).";
    case Wanted::recording:
      return "Recorded scans (.igs.mha, .seq.mha, .seq.nrrd).";
    case Wanted::calibration:
      return "Calibration files (.toml).";
    case Wanted::landmarks:
      return "Lists of landmarks (.toml).";
    case Wanted::drawing:
      return "Drawings of a probe (.toml).";
    case Wanted::look:
      return "Transfer functions (.toml), such as those that were saved here.";
    case Wanted::cases:
      return "Go to the folder whose case folders are to be listed.";
    case Wanted::output:
      return "Go to the folder, or type one that is to be made.";
    case Wanted::results:
      return "Choose a database (.db), or type the name of a new one.";
  }
  return "";
}

}  // namespace

void OpenDialog::open(Wanted wanted) {
  std::error_code error;
  // A path with a slip in it can be corrected instead of typed again.
  const std::filesystem::path typed = wanted == wanted_ ? path_.data() : "";
  wanted_ = wanted;
  go_to(list_.folder.empty() ? std::filesystem::current_path(error) : list_.folder);
  if (!typed.empty() && !std::filesystem::exists(typed, error)) put(typed);
}

void OpenDialog::go_to(const std::filesystem::path& folder) {
  list_ = list_folder(folder, wanted_);
  put(list_.folder);
}

void OpenDialog::put(const std::filesystem::path& path) {
  const std::string text = path.string();
  path_[text.copy(path_.data(), path_.size() - 1)] = 0;
  ready_ = false;
  ++texts_;
}

void OpenDialog::draw_field(const Theme& theme, const Rect& field) {
  fill(field, colour::kRaised, theme.px(4));
  ImGui::SetCursorScreenPos({field.x, field.y + (field.h - theme.text->FontSize) / 2 - theme.px(4)});
  ImGui::PushFont(theme.text);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {theme.px(10), theme.px(4)});
  ImGui::SetNextItemWidth(field.w);
  if (!ready_) ImGui::SetKeyboardFocusHere();
  ImGui::PushID(texts_);  // a field that is active keeps its own text, so another text is another field
  const bool edited = ImGui::InputText("##path", path_.data(), path_.size(), ImGuiInputTextFlags_AutoSelectAll);
  if (edited && path().is_absolute() && is_plain_folder(path())) list_ = list_folder(path(), wanted_);
  ImGui::PopID();
  ready_ = ready_ || ImGui::IsItemActive();
  ImGui::PopStyleVar();
  ImGui::PopFont();
}

void OpenDialog::move_choice(int by) {
  if (list_.entries.empty()) return;
  const auto chosen = std::ranges::find(list_.entries, std::filesystem::path(path_.data()), &FolderEntry::path);
  const bool any = chosen != list_.entries.end();
  const auto last = std::ptrdiff_t(list_.entries.size()) - 1;
  const auto next = any ? std::clamp<std::ptrdiff_t>(chosen - list_.entries.begin() + by, 0, last) : 0;
  put(list_.entries[std::size_t(next)].path);
}

bool OpenDialog::draw_entries(const Theme& theme, const Rect& where, std::map<std::string, Rect>& places) {
  std::vector<ListRow> rows;
  std::optional<std::size_t> chosen;
  for (const FolderEntry& entry : list_.entries) {
    if (entry.path == path_.data()) chosen = rows.size();
    std::string about = entry.kind;
    if (entry.bytes > 0) about += ", " + size_text(entry.bytes);
    if (entry.changed_s > 0) about += (about.empty() ? "" : ", ") + time_text(entry.changed_s);
    const std::string name = entry.path.filename().string();
    rows.push_back({"entry_" + name, entry.is_folder ? name + "/" : name, about});
  }
  const auto clicked = draw_list(theme, "entries", where, rows, chosen, places);
  if (rows.empty()) {
    const std::string empty = !list_.problem.empty() ? list_.problem
                              : list_.is_series      ? "This folder holds DICOM files: Open takes them as a CT."
                              : is_folder(wanted_)   ? "There are no folders here. Open takes this one."
                                                     : "Nothing here can be opened.";
    draw_paragraph(where.inset(theme.px(14), theme.px(12)), theme.text,
                   list_.problem.empty() ? colour::kMuted : colour::kAmber, empty);
  }
  if (!clicked) return false;
  const FolderEntry entry = list_.entries[*clicked];
  if (entry.is_folder) {
    // The second click of a double click falls on whatever lies there in the folder that the first one entered.
    if (ImGui::GetIO().MouseClickedLastCount[0] < 2) go_to(entry.path);
    return false;
  }
  put(entry.path);
  return ImGui::IsMouseDoubleClicked(0) || chosen == clicked;
}

OpenDialog::Answer OpenDialog::draw(const Theme& theme, const Rect& screen, std::map<std::string, Rect>& places) {
  Answer answer = Answer::none;
  Rect sheet = begin_overlay(theme, screen, {theme.px(820), std::min(theme.px(620), screen.h - theme.px(60))});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kText, title_of(wanted_));
  sheet.take_top(theme.px(4));
  draw_text(sheet.take_top(theme.px(24)), theme.text, colour::kMuted, what_is_shown(wanted_));
  sheet.take_top(theme.px(10));
  Rect top = sheet.take_top(theme.px(38));
  const auto go = [&](const char* id, const char* text, const std::filesystem::path& folder) {
    places[id] = top.take_left(theme.px(76));
    top.take_left(theme.px(8));
    if (button(theme, id, places[id], text)) go_to(folder);
  };
  go("folder_up", "Up", folder_above(list_.folder));
  go("folder_home", "Home", home_folder());
  draw_field(theme, top);
  sheet.take_top(theme.px(10));
  Rect buttons = sheet.take_bottom(theme.px(38));
  sheet.take_bottom(theme.px(12));
  bool open = draw_entries(theme, sheet, places);

  // A folder is gone into, unless it is itself what is looked for.
  const bool any = path_[0] != 0, is_here = path() == list_.folder;
  const bool enters = is_plain_folder(path()) && !(is_folder(wanted_) && is_here);
  places["open_path"] = buttons.take_right(theme.px(140));
  const bool opens = enters || wanted_ == Wanted::anything || wanted_ == Wanted::checked;
  const bool asked = button(theme, "open_path", places["open_path"], opens ? "Open  (Enter)" : "Choose  (Enter)",
                            ButtonKind::primary, any && !(enters && is_here)) ||
                     confirmed_;
  if (enters && is_here) draw_tooltip(theme, places["open_path"], "Choose a file or a folder in the list first.");
  if (asked && enters)
    go_to(path());
  else if (asked && any)
    open = true;
  buttons.take_right(theme.px(8));
  places["cancel_open"] = buttons.take_right(theme.px(140));
  if (button(theme, "cancel", places["cancel_open"], "Cancel  (Esc)")) answer = Answer::cancelled;
  if (open || (asked && !any)) answer = any ? Answer::chosen : Answer::cancelled;
  if (list_.left_out > 0)
    draw_text(buttons, theme.small_text, colour::kMuted, std::to_string(list_.left_out) + " more are not listed.");
  confirmed_ = false;
  end_overlay();
  return answer;
}

}  // namespace insonate::ui
