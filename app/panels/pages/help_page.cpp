#include "app/panels/pages/help_page.h"

#include <algorithm>
#include <vector>

#include "app/panels/pages/overlays.h"

namespace insonate::ui {
namespace {

struct Key {
  const char* keys;
  const char* meaning;
};

struct Help {
  const char* title;
  const char* purpose;
  std::vector<Key> keys;
};

/// How the probe moves, wherever there is one.
const std::vector<Key> kProbe{
    {"Up, Down", "slide the probe towards the head, the feet"},
    {"Left, Right", "slide it to the patient's right, left, and on round the body"},
    {"Page Down, Page Up", "press it into the skin, lift it"},
    {"E, Q", "rotate it clockwise, counter-clockwise, seen from its handle"},
    {"W, S", "rock the beam away from the marker, towards the marker"},
    {"A, D", "tilt the beam to head or feet, if the marker is to the patient's right"},
    {"Shift", "with any of these: slowly"},
    {"Drag on the ultrasound", "slide; with Shift rock and tilt; the wheel rotates"},
    {"Drag the probe", "put it elsewhere on the patient"},
};
const std::vector<Key> kPatient{
    {"Drag the patient", "turn; middle button or Shift shifts; right button or wheel zooms"},
    {"V, Home, N", "see the patient from the next side; as at first; landmarks' names"},
};
const std::vector<Key> kViews{
    {"F5, F6, F7", "the usual views; slices along the patient's axes; four of one size"},
    {"Double click a view", "make it large; again, or Escape: back"},
    {"Drag the CT, O", "across the window, up and down the level; outlines of organs"},
    {"Wheel on a slice, B, X", "through the slices; to the probe; cross at its face or in the fan"},
};
const std::vector<Key> kLook{{"K", "how the patient looks in 3D"}};
const std::vector<Key> kEffects{{"F8", "effects of the picture, off and on, in practice"}};
/// While the anatomy is hidden there is no CT, and landmarks have no names.
const std::vector<Key> kExamPatient{
    {"Drag the patient", "turn; middle button or Shift shifts; right button or wheel zooms"},
    {"V, Home", "see the patient from the next side; as at first"},
};
const std::vector<Key> kExamViews{
    {"F5, F7", "the usual views; views of one size"},
    {"Double click a view", "make it large; again: back"},
};
const std::vector<Key> kMachine{
    {"Space", "freeze the picture"},
    {"+, \u2212 and [, ]", "gain; depth"},
};
const std::vector<Key> kUndo{
    {"Ctrl Z, Ctrl Y", "undo what is placed, a knob, or a move of the probe; do a knob or a move again"}};
const std::vector<Key> kTools{
    {"Click the frozen picture", "measure from end to end; drag an end to move it"},
    {"C", "calipers or ellipse, where both may be used"},
    {"Backspace, Delete", "take back the last thing placed; all of it"},
    {"1 to 9", "choose an answer, a name, or which caliper comes next"},
    {"Enter", "answer; go on to the next step of an exam"},
};
const std::vector<Key> kFiles{
    {"M", "mark this moment, in the recording too"},
    {"R", "record the run; end the recording"},
    {"P, L", "save the picture; begin and end a clip of it"},
};
const std::vector<Key> kSweep{{"T, U", "begin and end a sweep; see the volume of its pictures"}};
const std::vector<Key> kWindow{
    {"F1, F3, F11", "this help; settings; full screen"},
    {"Ctrl Q", "end the program; an exam: asks first, then hands it in"},
};

std::vector<Key> keys_of(std::initializer_list<std::vector<Key>> parts) {
  std::vector<Key> all;
  for (const std::vector<Key>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Help help_of(HelpTopic topic) {
  switch (topic) {
    case HelpTopic::start:
      return {
          "Help: the start page",
          "Choose on the left what to do, in the middle on which patient, and on the right who is learning and with "
          "which tracker. Mouse and keyboard can take the probe over from a tracker, but for an exam that counts; Tab "
          "gives it back.",
          keys_of({{{"Up, Down", "choose what to do"},
                    {"Enter", "begin it"},
                    {"Ctrl O", "open a case, CT, scenario or recorded scan; or drop it on the window"},
                    {"F2", "set up a tracker"}},
                   kWindow})};
    case HelpTopic::learners:
      return {"Help: learners and attempts",
              "On the left who has practised and taken exams, in the middle how they do over time and where they lose "
              "points, on the right the chosen attempt with its comments.",
              keys_of({{{"Up, Down", "choose a learner"},
                        {"Enter", "look at the chosen attempt again"},
                        {"Arrows of the chart", "the attempts at another scenario"},
                        {"Write report", "the attempt's report, with the comments that it has now"},
                        {"Write all as CSV", "learners, attempts, scores and comments as tables"},
                        {"Escape", "to the start page"}},
                       kWindow})};
    case HelpTopic::check:
      return {"Help: checking a scenario",
              "On the left the text of the file, on the right what is wrong with it, as insonate-score check finds it. "
              "Edit the file in any editor: when it is saved, it is checked again.",
              keys_of({{{"Up, Down", "choose a problem, and show its line"},
                        {"Enter", "practise the scenario, once no problem is left"},
                        {"F5", "check again: a patient that the scenario names may have changed"},
                        {"Ctrl O", "check another scenario; or drop it on the window"},
                        {"Escape", "to the start page"}},
                       kWindow})};
    case HelpTopic::scan:
      return {"Help: scanning", "The large picture is the ultrasound. The 3D view shows the probe that it comes from.",
              keys_of({kProbe,
                       kPatient,
                       kViews,
                       kLook,
                       kEffects,
                       {{"Tab", "take the probe, give it back to the tracker"}},
                       kMachine,
                       kUndo,
                       kTools,
                       {{"Escape", "give up what is being placed; else to the start page"},
                        {"G", "the guide: the way to the view; its use is in the report"},
                        {"F4", "the score sheet of steps that are over, again"}},
                       kFiles,
                       kSweep,
                       {{"Ctrl O", "open a case, CT, scenario or recorded scan"},
                        {"F2", "choose a tracker, or set up the one in use"}},
                       kWindow})};
    case HelpTopic::exam:
      return {"Help: an exam that counts",
              "Do what each step asks for, hold the view still, and go on. Once the exam has begun, its clock runs on "
              "while this page is open.",
              keys_of({kProbe,
                       kExamPatient,
                       kExamViews,
                       kMachine,
                       {{"Ctrl Z, Ctrl Y", "undo what is placed, or a knob; do a knob again"}},
                       kTools,
                       kFiles,
                       kWindow})};
    case HelpTopic::replay:
      return {"Help: looking at a run again",
              "The time line below shows the steps and how far the probe was from their views. Nothing is scored or "
              "stored.",
              keys_of({{{"Space", "play, pause"},
                        {"Left, Right", "sample by sample"},
                        {"Up, Down", "faster, slower"},
                        {"Home, End", "the beginning, the end"},
                        {"Drag the time line", "go to that moment"},
                        {"Drag the patient", "turn; middle button or Shift shifts; right button or wheel zooms"},
                        {"V", "see the patient from the next side"},
                        {"P, L", "save the picture; begin and end a clip of it"},
                        {"Ctrl O", "open another recorded scan"},
                        {"Escape", "back to the start page, or to the learners"}},
                       kViews,
                       kLook,
                       kWindow})};
    case HelpTopic::setup:
      return {
          "Help: setting up a tracker",
          "The five steps on the left find how the sensor lies on the dummy probe and where the mannequin lies. Each "
          "says what to do. The foot switch or the probe's button works like Space.",
          keys_of({{{"Space, Enter", "mark the place; go on to the next step"},
                    {"Backspace", "take the last mark back; do the step again"},
                    {"Click a step", "go back to it"},
                    {"Escape", "close; what is complete is kept"}},
                   kWindow})};
    case HelpTopic::author:
      return {"Help: making views of a case",
              "Hold the probe where the view should be, choose the structures that it shows, name it and store it. "
              "Scenarios can then ask for it.",
              keys_of({kProbe,
                       kPatient,
                       kViews,
                       kLook,
                       kMachine,
                       kUndo,
                       {{"1 to 9", "choose a structure of the view"},
                        {"Enter", "store the view"},
                        {"Escape", "to the start page"}},
                       kWindow})};
    case HelpTopic::score:
      return {
          "Help: the score",
          "Each step has its points and, where some are missing, the reason. A critical criterion that earns nothing "
          "fails the exam. The report has all of it, with pictures "
          "and the probe's path, for printing or for a teacher.",
          keys_of({{{"Escape", "close the sheet, and go on scanning"}, {"F4", "close the sheet; show it again"}},
                   kWindow})};
    case HelpTopic::volume:
      return {"Help: the volume of a sweep",
              "Three planes that are perpendicular to each other, and the volume itself. Bluish voxels lie between the "
              "sweep's pictures, dark ones were not seen.",
              keys_of({{{"Drag in a plane", "the point in which the planes meet; right button: turns the two others"},
                        {"Wheel, Up, Down", "along the plane's normal; the probe's plane along the sweep"},
                        {"Drag in the volume", "turn; middle button or Shift shifts; right button or wheel zooms"},
                        {"C, Home", "cut the volume at the probe's plane, or not; planes and volume as at first"},
                        {"S", "save the volume"},
                        {"Escape, U", "back to the scan"}},
                       kWindow})};
    case HelpTopic::open:
      return {"Help: opening a file",
              "Click through the folders or type a path. A CT is a NIfTI, NRRD or MetaImage file or a folder of DICOM "
              "files; a case is a folder that insonate-case has made.",
              keys_of({{{"Up, Down", "choose in the list"},
                        {"Enter", "go into the folder, or open the file"},
                        {"Escape", "cancel"}},
                       kWindow})};
    case HelpTopic::settings:
      return {"Help: settings",
              "They hold for this computer's user, take effect at once, and are kept. None of them changes a score.",
              keys_of({{{"Escape", "close"}}, kWindow})};
  }
  return {};
}

/// Keys and what they do, in columns. A text that is too long for its column is wrapped.
class KeyTable {
public:
  KeyTable(const Theme& theme, const std::vector<Key>& keys, float width, int columns)
      : theme_(theme), keys_(keys), width_(width), column_((width - gap() * float(columns - 1)) / float(columns)) {
    for (const Key& key : keys) name_ = std::max(name_, text_width(theme.strong, key.keys) + theme.px(16));
    float all = 0;
    for (const Key& key : keys) all += row_height(key);
    // Each column but the last ends with the row that makes it as high as its share.
    float height = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      height += row_height(keys[i]);
      height_ = std::max(height_, height);
      if (int(ends_.size()) + 1 == columns || height < all / float(columns)) continue;
      ends_.push_back(i + 1);
      height = 0;
    }
  }

  float width() const { return width_; }
  float height() const { return height_; }

  void draw(const Rect& where) const {
    Rect rest{where.x, where.y, column_, where.h};
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      if (std::find(ends_.begin(), ends_.end(), i) != ends_.end())
        rest = {rest.x + column_ + gap(), where.y, column_, where.h};
      Rect row = rest.take_top(row_height(keys_[i]));
      draw_paragraph(row.take_left(name_), theme_.strong, colour::kText, keys_[i].keys);
      draw_paragraph(row, theme_.text, colour::kMuted, keys_[i].meaning);
    }
  }

private:
  float gap() const { return theme_.px(28); }
  float row_height(const Key& key) const {
    const float text = paragraph_height(theme_.text, key.meaning, column_ - name_);
    return text + theme_.text->FontSize * 0.25f;
  }

  const Theme& theme_;
  const std::vector<Key>& keys_;
  float width_, column_, name_ = 0, height_ = 0;
  std::vector<std::size_t> ends_;
};

}  // namespace

HelpAnswer draw_help(const Theme& theme, const Rect& screen, HelpTopic topic, std::map<std::string, Rect>& places) {
  const Help help = help_of(topic);
  const float widest = screen.w - theme.px(16), margins = 2 * theme.px(28);
  const auto around = [&](float width) {
    return theme.px(28 + 10 + 14 + 14 + 38 + 2 * 24) + paragraph_height(theme.text, help.purpose, width - margins);
  };
  // Where many keys meet a low screen or large text, they stand in two columns.
  const KeyTable one(theme, help.keys, std::min(theme.px(760), widest) - margins, 1);
  const bool fits = around(one.width() + margins) + one.height() <= screen.h - theme.px(16);
  const KeyTable table = fits ? one : KeyTable(theme, help.keys, widest - margins, 2);
  const float width = table.width() + margins;
  const float purpose = paragraph_height(theme.text, help.purpose, table.width());
  Rect sheet = begin_overlay(theme, screen, {width, around(width) + table.height()});
  draw_text(sheet.take_top(theme.px(28)), theme.heading, colour::kText, help.title);
  sheet.take_top(theme.px(10));
  draw_paragraph(sheet.take_top(purpose), theme.text, colour::kText, help.purpose);
  sheet.take_top(theme.px(14));
  table.draw(sheet.take_top(table.height()));
  Rect buttons = sheet.take_bottom(theme.px(38));
  HelpAnswer answer = HelpAnswer::none;
  places["close_help"] = buttons.take_right(theme.px(150));
  if (button(theme, "close_help", places["close_help"], "Close  (Esc)", ButtonKind::primary))
    answer = HelpAnswer::close;
  places["about"] = buttons.take_left(theme.px(150));
  if (button(theme, "about", places["about"], "About Insonate")) answer = HelpAnswer::about;
  buttons.take_left(theme.px(8));
  places["help_settings"] = buttons.take_left(theme.px(130));
  if (button(theme, "help_settings", places["help_settings"], "Settings  (F3)")) answer = HelpAnswer::settings;
  end_overlay();
  return answer;
}

}  // namespace insonate::ui
