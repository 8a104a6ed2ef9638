#include "app/panels/learners/attempt_panel.h"

#include <algorithm>
#include <utility>

#include "app/panels/widgets/scroll_area.h"
#include "app/trainer/folder_list.h"

namespace insonate::ui {
namespace {

/// Returns who wrote a comment and when, in the computer's own time.
std::string origin_of(const Comment& comment) {
  return (comment.author.empty() ? "" : comment.author + ", ") + time_text(comment.written_ms / 1000);
}

}  // namespace

void AttemptPanel::close_fields(bool keep) {
  store_ = keep && comment_.is_open();
  forget_ = !keep && comment_.is_open();
  if (!keep) author_was_open_ = author_is_refused_ = false;
  comment_.close();
  author_.close();
}

AttemptRequest AttemptPanel::draw(const Theme& theme, Rect where, LearnersPage& page, const Run& run,
                                  std::map<std::string, Rect>& places) {
  const AttemptSummary* attempt = page.attempt();
  if (Key now(page.database().string(), attempt ? attempt->number : 0); std::exchange(shown_, now) != now) {
    comment_.close();
    store_ = forget_ = false;
    doubtful_ = 0;
  }
  if (!attempt) return AttemptRequest::none;
  AttemptRequest request = AttemptRequest::none;
  Rect buttons = where.take_top(theme.px(34));
  where.take_top(theme.px(10));
  const float gap = theme.px(8), half = (buttons.w - gap) / 2;
  places["review"] = buttons.take_left(half);
  if (button(theme, "review", places["review"], "Review  (Enter)", ButtonKind::primary))
    request = AttemptRequest::review;
  buttons.take_left(gap);
  places["write_report"] = buttons;
  if (button(theme, "write_report", buttons, "Write report")) request = AttemptRequest::report;
  const Rect fields = where.take_bottom(theme.px(34 + 8 + 36));
  where.take_bottom(gap);
  draw_fields(theme, fields, page, run, places);
  draw_comments(theme, where, page, run, places);
  return request;
}

/// Takes the typed id. One that is refused stays in its field, and no comment is stored without it.
void AttemptPanel::choose_author(LearnersPage& page) {
  author_is_refused_ = true;
  page.choose_author(typed_author_);
  author_is_refused_ = false;
}

void AttemptPanel::draw_fields(const Theme& theme, Rect where, LearnersPage& page, const Run& run,
                               std::map<std::string, Rect>& places) {
  std::string& draft = drafts_[shown_];
  const auto store = [&] {
    run([&] {
      choose_author(page);
      page.add_comment(draft);
      draft.clear();
    });
  };
  if (std::exchange(store_, false)) store();
  if (std::exchange(forget_, false)) draft.clear();
  places["comment_field"] = where.take_top(theme.px(36));
  ImGui::PushID("comment");
  draft = comment_.draw(theme, places["comment_field"], draft, "Write a comment");
  ImGui::PopID();
  where.take_top(theme.px(8));

  places["add_comment"] = where.take_right(theme.px(130));
  where.take_right(theme.px(8));
  if (std::exchange(author_was_open_, author_.is_open()) && !author_.is_open()) run([&] { choose_author(page); });
  if (!author_.is_open() && !author_is_refused_) typed_author_ = page.choice().author;
  places["author_field"] = where;
  ImGui::PushID("author");
  typed_author_ = author_.draw(theme, where, typed_author_, "Your id, if you like");
  ImGui::PopID();
  const bool blank = draft.find_first_not_of(' ') == std::string::npos;
  draw_tooltip(theme, places["add_comment"],
               "It is kept with the attempt. Reports that are written from now on have it.");
  if (button(theme, "add_comment", places["add_comment"], "Add comment", ButtonKind::normal, !blank)) {
    comment_.close();
    store();
  }
}

void AttemptPanel::draw_comments(const Theme& theme, const Rect& where, LearnersPage& page, const Run& run,
                                 std::map<std::string, Rect>& places) {
  const std::string& draft = drafts_[shown_];
  const float line = theme.px(24), between = theme.px(10), widest = where.w - theme.px(14);
  // A field shows one line of a long comment, so the whole of it is shown here while it is typed.
  const bool shows_draft = comment_.is_open() && text_width(theme.text, draft) > where.w - theme.px(24);
  float height = shows_draft ? paragraph_height(theme.text, draft, widest) + line : 0;
  for (const Comment& comment : page.comments())
    height += paragraph_height(theme.text, comment.text, widest) + line + between;
  if (height == 0) return draw_text({where.x, where.y, where.w, line}, theme.text, colour::kMuted, "No comments yet.");
  std::int64_t removed = 0;
  {
    const ScrollArea area(theme, "comments", where, height);
    Rect rest = area.content();
    rest.w = widest;
    for (const Comment& comment : page.comments()) {
      const Rect text = rest.take_top(paragraph_height(theme.text, comment.text, widest));
      Rect below = rest.take_top(line);
      rest.take_top(between);
      if (area.shows(text))
        draw_paragraph({text.x, text.y, text.w, text.h + 1}, theme.text, colour::kText, comment.text);
      if (!area.shows(below)) continue;
      const std::string id = "remove_comment_" + std::to_string(comment.number);
      const bool doubtful = comment.number == doubtful_;
      const Rect remove = below.take_right(theme.px(76)).inset(0, theme.px(1));
      if (area.shows_all_of(remove)) places[id] = remove;
      ImGui::SetCursorScreenPos(remove.min());
      const bool clicked = ImGui::InvisibleButton(id.c_str(), {remove.w, remove.h});
      if (doubtful || ImGui::IsItemHovered()) fill(remove, colour::kRaised, theme.px(4));
      draw_text(remove, theme.small_text, doubtful ? colour::kAmber : colour::kMuted, doubtful ? "Remove?" : "Remove",
                Align::centre);
      draw_text(below, theme.small_text, colour::kMuted, origin_of(comment));
      if (clicked) doubtful ? removed = comment.number : doubtful_ = comment.number;
    }
    if (shows_draft) {
      const Rect text = rest.take_top(paragraph_height(theme.text, draft, widest));
      draw_paragraph({text.x, text.y, text.w, text.h + 1}, theme.text, colour::kAccent, draft);
      draw_text(rest.take_top(line), theme.small_text, colour::kMuted, "Enter stores it, Escape forgets it");
      ImGui::SetScrollY(height);
    }
  }
  if (removed == 0) return;
  doubtful_ = 0;
  run([&] { page.remove_comment(removed); });
}

}  // namespace insonate::ui
