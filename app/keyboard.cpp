#include "app/keyboard.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "devices/live/probe_buttons.h"
#include "scenarios/metrics/motion_meter.h"

namespace insonate {
namespace {

constexpr double kSlide_mm_s = 60, kPress_mm_s = 15, kTurn_deg_s = 60;
static_assert(kSlide_mm_s > MotionMeter::kMoving_mm_s && kTurn_deg_s > MotionMeter::kMoving_deg_s,
              "each slide and turn by a key is a movement of the probe, as one by hand would be");
constexpr double kFine = 8 / kSlide_mm_s, kFinePress = 0.2;  // 8 mm and 8 degrees a second, and 3 mm of pressing
/// A frame that took longer moves the probe no farther: nothing jumps after a pause.
constexpr double kLongestFrame_s = 0.1;

/// Whether a key edits text rather than typing some.
bool edits_text(const KeyEvent& event) {
  switch (event.key) {
    case GLFW_KEY_BACKSPACE:
    case GLFW_KEY_DELETE:
    case GLFW_KEY_LEFT:
    case GLFW_KEY_RIGHT:
    case GLFW_KEY_HOME:
    case GLFW_KEY_END:
      return true;
    case GLFW_KEY_A:
    case GLFW_KEY_C:
    case GLFW_KEY_V:
    case GLFW_KEY_X:
    case GLFW_KEY_Y:
    case GLFW_KEY_Z:
      return event.modifiers & GLFW_MOD_CONTROL;
    default:
      return false;
  }
}

/// Returns the key on which an American keyboard has what the person's keyboard has on this one. Returns
/// GLFW_KEY_UNKNOWN if the trainer has no use for that.
int written_on(int key) {
  const char* const name = glfwGetKeyName(key, 0);
  if (!name || !name[0] || name[1]) return GLFW_KEY_UNKNOWN;
  switch (name[0]) {
    case '+':
    case '=':
      return GLFW_KEY_EQUAL;
    case '-':
      return GLFW_KEY_MINUS;
    case '[':
      return GLFW_KEY_LEFT_BRACKET;
    case ']':
      return GLFW_KEY_RIGHT_BRACKET;
    default:
      return name[0] >= 'a' && name[0] <= 'z' ? GLFW_KEY_A + (name[0] - 'a') : GLFW_KEY_UNKNOWN;
  }
}

/// Returns what a key counts as. Letters count by what is written on them. Digits, of which some keyboards have only
/// the places, and keys of other alphabets count by their place, unless that would make two keys the same.
int meaning_of(int key) {
  const bool is_digit = key >= GLFW_KEY_0 && key <= GLFW_KEY_9;
  if (key < GLFW_KEY_APOSTROPHE || key > GLFW_KEY_WORLD_2 || is_digit) return key;
  if (const int written = written_on(key); written != GLFW_KEY_UNKNOWN) return written;
  for (int other = GLFW_KEY_A; other <= GLFW_KEY_RIGHT_BRACKET; ++other)
    if (other != key && written_on(other) == key) return GLFW_KEY_UNKNOWN;
  for (const int other : {GLFW_KEY_SEMICOLON, GLFW_KEY_APOSTROPHE, GLFW_KEY_COMMA, GLFW_KEY_PERIOD, GLFW_KEY_SLASH,
                          GLFW_KEY_MINUS, GLFW_KEY_EQUAL})
    if (other != key && written_on(other) == key) return GLFW_KEY_UNKNOWN;
  return key;
}

bool is_enter(const KeyEvent& event) {
  return event.key == GLFW_KEY_ENTER || event.key == GLFW_KEY_KP_ENTER;
}

}  // namespace

void Keyboard::note(KeyEvent event) {
  if (event.kind != KeyEvent::Kind::typed) {
    const auto down = down_.try_emplace(event.key, GLFW_KEY_UNKNOWN);
    if (down.second) down.first->second = meaning_of(event.key);
    const int place = std::exchange(event.key, down.first->second);
    if (event.kind == KeyEvent::Kind::released) down_.erase(place);
    if (event.key == GLFW_KEY_UNKNOWN) return;
  }
  events_.push_back(event);
}

bool Keyboard::held(int key) const {
  return tapped_.contains(key) ||
         std::any_of(down_.begin(), down_.end(), [&](const auto& down) { return down.second == key; });
}

bool Keyboard::apply(Trainer& trainer, ui::Screen& screen, double elapsed_s, double until_s) {
  ImGuiIO& io = ImGui::GetIO();
  tapped_.clear();
  io.KeyShift = held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT);
  io.KeyCtrl = held(GLFW_KEY_LEFT_CONTROL) || held(GLFW_KEY_RIGHT_CONTROL);
  dispatch(trainer, screen, until_s);
  if (!trainer.session() || screen.takes_keys(trainer)) return false;
  return move_probe(*trainer.session(), std::min(elapsed_s, kLongestFrame_s));
}

bool Keyboard::move_probe(Session& session, double elapsed_s) const {
  if (held(GLFW_KEY_LEFT_CONTROL) || held(GLFW_KEY_RIGHT_CONTROL)) return false;
  const bool fine = held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT);
  const double amount = elapsed_s * (fine ? kFine : 1.0);
  const auto axis = [&](int plus, int minus) { return double(held(plus)) - double(held(minus)); };
  // As the guide speaks, and on the front as the 3D view shows the patient: their left is on the right, their head up.
  const glm::dvec2 slide =
      glm::dvec2(axis(GLFW_KEY_RIGHT, GLFW_KEY_LEFT), axis(GLFW_KEY_UP, GLFW_KEY_DOWN)) * kSlide_mm_s * amount;
  const double press_mm =
      axis(GLFW_KEY_PAGE_DOWN, GLFW_KEY_PAGE_UP) * kPress_mm_s * elapsed_s * (fine ? kFinePress : 1.0);
  const double tilt = axis(GLFW_KEY_D, GLFW_KEY_A), rotation = axis(GLFW_KEY_E, GLFW_KEY_Q),
               rock = axis(GLFW_KEY_W, GLFW_KEY_S);
  const bool slides = slide.x != 0 || slide.y != 0, turns = tilt != 0 || rotation != 0 || rock != 0;
  if (!slides && !turns && press_mm == 0) return false;
  if (slides || press_mm != 0)
    session.move_probe([&](const ProbeHand& hand, const Pose& from) -> std::optional<Pose> {
      std::optional<Pose> pose = from;
      if (slides) pose = hand.slide(*pose, ProbeHand::slide_in_patient(*pose, slide));
      if (pose && press_mm != 0) pose = hand.press(*pose, press_mm);
      return pose;
    });
  const double turn = kTurn_deg_s * amount;
  if (turns) session.turn_probe(tilt * turn, rotation * turn, rock * turn);
  return true;
}

void Keyboard::dispatch(Trainer& trainer, ui::Screen& screen, double until_s) {
  field_is_busy_ = false;
  while (!events_.empty() && events_.front().time_s <= until_s && !screen.opens_text_field(trainer)) {
    const KeyEvent event = events_.front();
    if (screen.types_text(trainer)) {
      if (!type(event, trainer, screen)) return;
    } else if (event.kind == KeyEvent::Kind::released) {
      ImGui::GetIO().KeysDown[event.key] = false;  // of a field that has been closed since
    } else if (event.kind != KeyEvent::Kind::typed) {
      press(event, trainer, screen);
    }
    events_.pop_front();
  }
}

// Whether the field takes it in this frame: it sees keys as they are at the frame, and what was typed before them.
bool Keyboard::type(const KeyEvent& event, Trainer& trainer, ui::Screen& screen) {
  if (field_is_busy_) return false;
  ImGuiIO& io = ImGui::GetIO();
  const bool moves = event.key == GLFW_KEY_UP || event.key == GLFW_KEY_DOWN;
  if (moves && screen.overlay(trainer) == ui::Overlay::open && event.kind != KeyEvent::Kind::typed) {
    if (!io.InputQueueCharacters.empty()) return false;
    if (event.kind != KeyEvent::Kind::released) screen.open_dialog().move_choice(event.key == GLFW_KEY_UP ? -1 : +1);
    return true;
  }
  switch (event.kind) {
    case KeyEvent::Kind::typed:
      io.AddInputCharacter(event.character);
      break;
    case KeyEvent::Kind::released:
      field_is_busy_ = std::exchange(io.KeysDown[event.key], false);
      break;
    case KeyEvent::Kind::repeated:
      break;  // ImGui repeats by itself
    case KeyEvent::Kind::pressed:
      // Closed now, the field would never see what was typed before in this frame.
      if ((event.key == GLFW_KEY_ESCAPE || is_enter(event)) && !io.InputQueueCharacters.empty()) return false;
      if (open_page(event, trainer, screen)) {
        break;
      } else if (event.key == GLFW_KEY_ESCAPE) {
        screen.dismiss(trainer);
      } else if (is_enter(event)) {
        screen.confirm(trainer);
        field_is_busy_ = true;
      } else if (edits_text(event)) {
        io.KeysDown[event.key] = true;
        io.KeyShift = event.modifiers & GLFW_MOD_SHIFT;
        io.KeyCtrl = event.modifiers & GLFW_MOD_CONTROL;
        field_is_busy_ = true;
      }
      break;
  }
  return true;
}

void Keyboard::set_up(const KeyEvent& pressed, Trainer& trainer) {
  if (pressed.key == GLFW_KEY_SPACE || is_enter(pressed)) trainer.setup()->mark(pressed.time_s);
  if (pressed.key == GLFW_KEY_BACKSPACE) trainer.setup()->undo();
  if (pressed.key == GLFW_KEY_ESCAPE) trainer.end_setup();
}

/// Handles the keys that work on every page. Returns whether this was one.
bool Keyboard::open_page(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen) {
  using ui::Overlay;
  if (pressed.key == GLFW_KEY_Q && (pressed.modifiers & GLFW_MOD_CONTROL)) {
    if (pressed.kind == KeyEvent::Kind::pressed) screen.quit(trainer);
    return true;
  }
  const bool question = pressed.key == GLFW_KEY_SLASH && (pressed.modifiers & GLFW_MOD_SHIFT);
  const bool help = pressed.key == GLFW_KEY_F1 || (question && !screen.types_text(trainer));
  const bool settings = pressed.key == GLFW_KEY_F3, full_screen = pressed.key == GLFW_KEY_F11;
  if (!help && !settings && !full_screen) return false;
  if (pressed.kind != KeyEvent::Kind::pressed) return true;
  if (full_screen) full_screen_.toggle(window_);
  const Overlay shown = screen.overlay(trainer);
  const bool waits = shown == Overlay::problem || shown == Overlay::loading || shown == Overlay::leave;
  if (help && !waits) screen.toggle(Overlay::help);
  if (settings && !waits) screen.toggle(Overlay::settings);
  return true;
}

/// What the step lets choose from, by its number from 0 on.
void Keyboard::choose(int index, Trainer& trainer) {
  const auto which = std::size_t(index);
  if (Author* author = trainer.author()) return author->toggle(which);
  PictureTools& tools = trainer.picture_tools();
  if (const AnswerInput* question = trainer.step_controls().question()) {
    if (which < question->choices.size()) trainer.step_controls().draft(question->choices[which]);
  } else if (tools.labelling()) {
    if (which < tools.names().size()) tools.name_place(*trainer.session(), tools.names()[which]);
  } else {
    tools.choose_slot(index + 1);
  }
}

void Keyboard::start_page(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen) {
  StartPage& page = *trainer.start_page();
  if (pressed.key == GLFW_KEY_UP) page.move_choice(-1);
  if (pressed.key == GLFW_KEY_DOWN) page.move_choice(+1);
  if (pressed.key == GLFW_KEY_F2) page.task = Task::setup;
  if (pressed.key == GLFW_KEY_O && (pressed.modifiers & GLFW_MOD_CONTROL)) screen.ask_for_path();
  if (is_enter(pressed) && pressed.kind == KeyEvent::Kind::pressed) screen.confirm(trainer);
}

void Keyboard::learners_page(const KeyEvent& pressed, LearnersPage& page, Trainer& trainer, ui::Screen& screen) {
  if (pressed.key == GLFW_KEY_UP) page.move_choice(-1);
  if (pressed.key == GLFW_KEY_DOWN) page.move_choice(+1);
  if (is_enter(pressed) && pressed.kind == KeyEvent::Kind::pressed) screen.confirm(trainer);
}

void Keyboard::check_page(const KeyEvent& pressed, CheckPage& page, Trainer& trainer, ui::Screen& screen) {
  if (pressed.key == GLFW_KEY_UP) page.move_choice(-1);
  if (pressed.key == GLFW_KEY_DOWN) page.move_choice(+1);
  if (pressed.kind != KeyEvent::Kind::pressed) return;
  if (pressed.key == GLFW_KEY_F5) page.check_again();
  if (pressed.key == GLFW_KEY_O && (pressed.modifiers & GLFW_MOD_CONTROL)) screen.ask_for_path(Wanted::checked);
  if (is_enter(pressed)) screen.confirm(trainer);
}

/// Handles the keys of the views beside the ultrasound. Returns whether this was one.
bool Keyboard::change_views(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen) {
  if (pressed.modifiers & GLFW_MOD_CONTROL) return false;
  CtLook look = trainer.preferences().ct;
  switch (pressed.key) {
    case GLFW_KEY_F5:
    case GLFW_KEY_F6:
    case GLFW_KEY_F7:
      screen.choose(LayoutName(pressed.key - GLFW_KEY_F5), trainer);
      break;
    case GLFW_KEY_F8:
      screen.toggle_effects(trainer);
      break;
    case GLFW_KEY_O:
      if (trainer.loaded_case() && trainer.loaded_case()->subject.labels.empty())
        screen.show_note("This patient has no labels to outline");
      else
        look.outlines = !look.outlines;
      break;
    case GLFW_KEY_X:
      look.cross_hair = look.cross_hair == CrossHair::face ? CrossHair::fan : CrossHair::face;
      break;
    case GLFW_KEY_B:
      trainer.pictures().slices_to_cross_hair();
      break;
    case GLFW_KEY_K:
      screen.toggle_look(trainer);
      break;
    case GLFW_KEY_N:
      if (trainer.loaded_case() && trainer.loaded_case()->subject.landmarks.empty())
        screen.show_note("This patient has no landmarks to name");
      else if (trainer.may_name_landmarks())
        trainer.toggle_landmarks();
      else
        screen.show_note("Landmarks have no names in scored steps, unless the guide is shown");
      break;
    default:
      return false;
  }
  trainer.adjust_ct_look(look);
  trainer.keep_ct_look();
  return true;
}

void Keyboard::replay(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen) {
  Replay& replay = *trainer.replay();
  const bool repeated = pressed.kind == KeyEvent::Kind::repeated;
  if (!repeated && change_views(pressed, trainer, screen)) return;
  switch (pressed.key) {
    case GLFW_KEY_SPACE:
      if (!repeated) replay.toggle();
      break;
    case GLFW_KEY_LEFT:
      replay.step(-1);
      break;
    case GLFW_KEY_RIGHT:
      replay.step(+1);
      break;
    case GLFW_KEY_UP:
      replay.change_speed(+1);
      break;
    case GLFW_KEY_DOWN:
      replay.change_speed(-1);
      break;
    case GLFW_KEY_HOME:
      replay.seek(0);
      break;
    case GLFW_KEY_END:
      replay.seek(replay.run().duration_s());
      break;
    case GLFW_KEY_V:
      trainer.pictures().look_from_next();
      break;
    case GLFW_KEY_O:
      if (pressed.modifiers & GLFW_MOD_CONTROL) screen.ask_for_path();
      break;
    default:
      break;
  }
}

void Keyboard::volume_page(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen) {
  if (pressed.key == GLFW_KEY_UP) screen.volume_page().step(+1);
  if (pressed.key == GLFW_KEY_DOWN) screen.volume_page().step(-1);
  if (pressed.kind == KeyEvent::Kind::repeated) return;
  if (pressed.key == GLFW_KEY_HOME) screen.volume_page().reset();
  if (pressed.key == GLFW_KEY_C) screen.volume_page().switch_cut();
  if (pressed.key == GLFW_KEY_S) trainer.save_swept();
  if (pressed.key == GLFW_KEY_U) screen.toggle_volume(trainer);
}

void Keyboard::press(const KeyEvent& pressed, Trainer& trainer, ui::Screen& screen) {
  using ui::Overlay;
  if (open_page(pressed, trainer, screen)) return;
  const bool repeated = pressed.kind == KeyEvent::Kind::repeated;
  const Overlay overlay = screen.overlay(trainer);
  if (overlay == Overlay::setup) {
    if (!repeated) set_up(pressed, trainer);
    return;
  }
  if (pressed.key == GLFW_KEY_ESCAPE || (is_enter(pressed) && screen.takes_keys(trainer))) {
    if (!repeated) is_enter(pressed) ? screen.confirm(trainer) : screen.dismiss(trainer);
    return;
  }
  if (overlay == Overlay::volume) return volume_page(pressed, trainer, screen);
  const bool scans = trainer.session() && (overlay == Overlay::none || overlay == Overlay::score);
  if (pressed.key == GLFW_KEY_F4 && scans && !repeated) return screen.toggle_sheet(trainer);
  if (overlay != Overlay::none) return;
  if (pressed.key == GLFW_KEY_P && !repeated) return screen.save_picture(trainer);
  if (pressed.key == GLFW_KEY_L && !repeated) return screen.toggle_clip(trainer);
  if (trainer.start_page()) return start_page(pressed, trainer, screen);
  if (LearnersPage* page = trainer.learners_page()) return learners_page(pressed, *page, trainer, screen);
  if (CheckPage* page = trainer.check_page()) return check_page(pressed, *page, trainer, screen);
  if (trainer.replay()) return replay(pressed, trainer, screen);
  if (!(pressed.modifiers & GLFW_MOD_CONTROL)) tapped_.insert(pressed.key);
  if (pressed.key == GLFW_KEY_F2 && !repeated) return screen.begin_setup(trainer);
  const bool strict = trainer.session() && trainer.session()->strict();
  if (pressed.key == GLFW_KEY_O && (pressed.modifiers & GLFW_MOD_CONTROL) && !strict) return screen.ask_for_path();
  if (!trainer.session()) return;
  Session& session = *trainer.session();
  if (pressed.modifiers & GLFW_MOD_CONTROL) {
    const bool back = pressed.key == GLFW_KEY_Z && !(pressed.modifiers & GLFW_MOD_SHIFT);
    const bool forward = pressed.key == GLFW_KEY_Y || (pressed.key == GLFW_KEY_Z && !back);
    std::string why_not;
    if (back && trainer.picture_tools().did_last(session)) return trainer.picture_tools().undo(session);
    if (back) why_not = trainer.undo_history().undo(session);
    if (forward) why_not = trainer.undo_history().redo(session);
    if (!why_not.empty()) screen.show_note(why_not);
    return;
  }
  if (!repeated && change_views(pressed, trainer, screen)) return;
  const Machine& machine = session.machine();
  const auto turn = [&](ActionKind knob, double value) {
    if (const std::string why_not = session.why_not(knob); !why_not.empty()) return screen.show_note(why_not);
    session.set(knob, value);
  };
  if (!repeated && pressed.key >= GLFW_KEY_1 && pressed.key <= GLFW_KEY_9)
    return choose(pressed.key - GLFW_KEY_1, trainer);
  switch (pressed.key) {
    case GLFW_KEY_ENTER:
    case GLFW_KEY_KP_ENTER:
      if (!repeated && (trainer.author() || StepControls::active(session))) screen.go_on(trainer);
      break;
    case GLFW_KEY_BACKSPACE:
      trainer.picture_tools().undo(session);
      break;
    case GLFW_KEY_DELETE:
      trainer.picture_tools().clear(session);
      break;
    case GLFW_KEY_C:
      trainer.picture_tools().choose(trainer.picture_tools().tool() == PictureTools::Tool::distance
                                         ? PictureTools::Tool::ellipse
                                         : PictureTools::Tool::distance);
      break;
    case GLFW_KEY_TAB:
      if (repeated) break;
      if (trainer.demonstration() && session.result())
        screen.try_yourself(trainer);
      else
        screen.switch_holder(trainer);
      break;
    case GLFW_KEY_SPACE:
      if (!repeated) session.freeze(!machine.frozen);
      break;
    case GLFW_KEY_G:
      if (repeated) break;
      if (session.strict())
        screen.show_note(session.result() ? "The exam is over: practise it to see the guide"
                                          : "This exam counts: it has no guide");
      else if (!trainer.guide().can_lead(session))
        screen.show_note("The guide leads to views, and this step asks for none");
      else
        trainer.guide().next(session);
      break;
    case GLFW_KEY_V:
      trainer.pictures().look_from_next();
      break;
    case GLFW_KEY_HOME:
      trainer.pictures().reset_camera();
      break;
    case GLFW_KEY_M:
      if (!repeated) session.press(kEventMarkerButton);
      break;
    case GLFW_KEY_T:
      if (!repeated) trainer.toggle_sweep();
      break;
    case GLFW_KEY_U:
      if (!repeated) screen.toggle_volume(trainer);
      break;
    case GLFW_KEY_R:
      if (!repeated) trainer.recorder().running() ? trainer.stop_recording() : trainer.start_recording();
      break;
    case GLFW_KEY_EQUAL:
    case GLFW_KEY_KP_ADD:
      turn(ActionKind::gain, std::min(machine.gain_db + 1, Machine::kMaxGain_db));
      break;
    case GLFW_KEY_MINUS:
    case GLFW_KEY_KP_SUBTRACT:
      turn(ActionKind::gain, std::max(machine.gain_db - 1, -Machine::kMaxGain_db));
      break;
    case GLFW_KEY_LEFT_BRACKET:
      turn(ActionKind::depth, machine.depth_mm - 5);
      break;
    case GLFW_KEY_RIGHT_BRACKET:
      turn(ActionKind::depth, machine.depth_mm + 5);
      break;
    default:
      break;
  }
}

}  // namespace insonate
