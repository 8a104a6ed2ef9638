#include "app/session/picture_tools.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

#include "scenarios/caliper.h"

namespace insonate {
namespace {

glm::dvec2 place_of(const Action& point_or_label) {
  return point_or_label.point(0);
}

Action with_place(Action point_or_label, const glm::dvec2& at) {
  point_or_label.numbers[0] = at.x;
  point_or_label.numbers[1] = at.y;
  return point_or_label;
}

bool is_measured(const Action& action) {
  return action.kind == ActionKind::caliper || action.kind == ActionKind::ellipse;
}

bool is_exam_of_log(const Session& session) {
  return session.runner() && !session.result() && session.source().recording();
}

bool ends_step(const Action& action) {
  return action.kind == ActionKind::go_on || action.kind == ActionKind::go_to || action.kind == ActionKind::answer;
}

}  // namespace

bool PictureTools::ready(const Session& session) {
  return session.frozen_picture() && !is_exam_of_log(session);
}

void PictureTools::see(const Session& session) {
  const Runner* runner = session.runner();
  const auto step = runner && !session.result() ? std::optional(runner->live().step) : std::nullopt;
  const bool another = session.attempt() != attempt_ || step != step_;
  attempt_ = session.attempt();
  step_ = step;
  const auto picture = session.frozen_picture();
  if (picture != picture_) drop();
  if (picture != picture_ && free_choice()) {
    annotations_.clear();
    done_.clear();
  }
  picture_ = picture;
  if (another) begin_step(session);
  if (!std::as_const(session).source().recording()) return;  // those placed here are added already
  for (const auto& [time_s, actions] : session.latest_actions())
    for (const Action& action : actions) {
      if (another && ends_step(action)) annotations_.clear();
      annotations_.apply(action, picture);
    }
}

void PictureTools::begin_step(const Session& session) {
  drop();
  annotations_.clear();
  done_.clear();
  chosen_slot_.reset();
  names_.clear();
  input_ = {};
  tool_ = Tool::distance;
  if (!step_) return;
  input_ = session.runner()->scenario().steps[*step_].task->input();
  if (measuring() && measuring()->places == ActionKind::ellipse) tool_ = Tool::ellipse;
  if (std::holds_alternative<PointInput>(input_)) tool_ = Tool::point;
  if (!labelling()) return;
  tool_ = Tool::label;
  names_ = std::get<LabelInput>(input_).names;
  std::sort(names_.begin(), names_.end());
}

void PictureTools::choose(Tool tool) {
  if (!free_choice() || (tool != Tool::distance && tool != Tool::ellipse)) return;
  drop();
  tool_ = tool;
}

bool PictureTools::has_all() const {
  if (in_hand_ || place_ || chosen_slot_) return false;
  if (measuring()) return annotations_.measured().size() >= measuring()->slots.size();
  if (labelling()) return annotations_.labels().size() >= names_.size();
  return tool_ == Tool::point && annotations_.point();
}

int PictureTools::slot() const {
  if (chosen_slot_) return *chosen_slot_;
  const int last = measuring() ? int(measuring()->slots.size()) : Action::kMaxSlots;
  for (int slot = 1; slot <= last; ++slot)
    if (!annotations_.measured().contains(slot)) return slot;
  return last;
}

void PictureTools::choose_slot(int slot) {
  if (!measuring() || slot < 1 || slot > int(measuring()->slots.size())) return;
  drop();
  chosen_slot_ = slot;
}

std::string PictureTools::slot_name(int slot) const {
  // A log may have placed more than the step asks for.
  if (measuring() && slot <= int(measuring()->slots.size())) return measuring()->slots[std::size_t(slot - 1)];
  const auto found = annotations_.measured().find(slot);
  const bool ellipse = found == annotations_.measured().end() ? tool_ == Tool::ellipse
                                                              : found->second.action.kind == ActionKind::ellipse;
  return ellipse ? "Area" : "Distance";
}

std::string PictureTools::total_text() const {
  if (!measuring() || measuring()->result.empty()) return "";
  std::vector<Action> placed;
  for (const auto& [slot, annotation] : annotations_.measured()) placed.push_back(annotation.action);
  if (placed.size() != measuring()->slots.size()) return "";
  return measuring()->result + " " + measuring()->result_text(placed);
}

void PictureTools::name_place(Session& session, const std::string& name) {
  if (!place_ || !labelling() || !ready(session)) return;
  Action label{ActionKind::label, {}, name};
  commit(session, with_place(std::move(label), *std::exchange(place_, std::nullopt)));
}

/// Grabs the nearest handle within `reach_mm` among the annotations of this picture.
bool PictureTools::grab(const Pose& picture, const glm::dvec2& at, double reach_mm) {
  double nearest = reach_mm;
  const auto look = [&](const Annotation& annotation, std::size_t handle, const glm::dvec2& place) {
    const double distance = glm::distance(at, place);
    if (annotation.patient_from_probe != picture || distance > nearest) return;
    nearest = distance;
    in_hand_ = annotation.action;
    handle_ = handle;
  };
  if (tool_ == Tool::point) {
    if (annotations_.point()) look(*annotations_.point(), 0, place_of(annotations_.point()->action));
  } else if (tool_ == Tool::label) {
    for (const auto& [name, annotation] : annotations_.labels()) look(annotation, 0, place_of(annotation.action));
  } else {
    for (const auto& [slot, annotation] : annotations_.measured()) {
      const std::vector<glm::dvec2> places = handles(annotation.action);
      for (std::size_t i = 0; i < places.size(); ++i) look(annotation, i, places[i]);
    }
  }
  return handle_.has_value();
}

void PictureTools::begin(const glm::dvec2& at) {
  if (tool_ == Tool::label) {
    place_ = at;
  } else if (tool_ == Tool::point) {
    in_hand_ = with_place({ActionKind::point}, at);
    handle_ = 0;
  } else {
    in_hand_ = Action{tool_ == Tool::ellipse ? ActionKind::ellipse : ActionKind::caliper,
                      {double(slot()), at.x, at.y, at.x, at.y}};
    drawing_ = first_press_ = true;
    has_axis_ = false;
  }
}

void PictureTools::press(Session& session, const glm::dvec2& at, double reach_mm) {
  if (!ready(session)) return;
  const auto picture = session.frozen_picture();
  picture_ = picture;
  if (drawing_) return move(at);
  if (!grab(*picture, at, reach_mm)) begin(at);
}

void PictureTools::move(const glm::dvec2& at) {
  if (!in_hand_) return;
  if (drawing_)
    in_hand_ = with_handle_at(*in_hand_, has_axis_ ? 2 : 1, at);
  else if (handle_)
    in_hand_ = is_measured(*in_hand_) ? with_handle_at(*in_hand_, *handle_, at) : with_place(*in_hand_, at);
}

void PictureTools::release(Session& session, const glm::dvec2& at, double reach_mm) {
  if (!in_hand_) return;
  move(at);
  if (!drawing_) {
    if (handle_) commit(session, *in_hand_);
    return;
  }
  // A click sets the first end. A drag sets both.
  if (std::exchange(first_press_, false) && caliper_length_mm(*in_hand_) <= reach_mm) return;
  if (caliper_length_mm(*in_hand_) < kMin_mm) return drop();
  if (in_hand_->kind == ActionKind::ellipse && !std::exchange(has_axis_, true)) return;
  if (in_hand_->kind == ActionKind::ellipse && in_hand_->numbers[5] < kMin_mm / 2) return;
  commit(session, *in_hand_);
}

// `action` is a copy, because drop() clears what is in hand.
void PictureTools::commit(Session& session, Action action) {
  drop();
  const auto picture = session.frozen_picture();
  if (!picture) return;
  const Annotation* before = annotations_.at_place_of(action);
  if (before && before->action == action && before->patient_from_probe == *picture) return;
  // What lay in another picture cannot be restored in this one.
  const bool again = before && before->patient_from_probe == *picture;
  done_.push_back({again ? before->action : take_back(action), *picture, session.machine()});
  session.act(action);
  annotations_.apply(action, picture);
  chosen_slot_.reset();
}

void PictureTools::drop() {
  in_hand_.reset();
  drawing_ = first_press_ = has_axis_ = false;
  handle_.reset();
  place_.reset();
}

bool PictureTools::cancel() {
  const bool any = in_hand_ || place_;
  drop();
  return any;
}

bool PictureTools::did_last(const Session& session) const {
  if (!ready(session)) return false;
  if (drawing_ || place_) return true;
  return !done_.empty() && session.frozen_picture() == done_.back().picture &&
         session.machine() == done_.back().machine;
}

void PictureTools::undo(Session& session) {
  if (is_exam_of_log(session) || cancel() || done_.empty()) return;
  const Undo last = done_.back();
  done_.pop_back();
  const auto picture = session.frozen_picture();
  // Nothing can be restored in a picture that is gone.
  const Action action = picture == last.picture ? last.action : take_back(last.action);
  session.act(action);
  annotations_.apply(action, picture);
}

void PictureTools::clear(Session& session) {
  if (is_exam_of_log(session)) return;
  drop();
  const auto remove = [&](const Action& placed) {
    session.act(take_back(placed));
    annotations_.apply(take_back(placed), std::nullopt);
  };
  const Annotations all = annotations_;
  for (const auto& [slot, annotation] : all.measured()) remove(annotation.action);
  if (all.point()) remove(all.point()->action);
  for (const auto& [name, annotation] : all.labels()) remove(annotation.action);
  done_.clear();
  chosen_slot_.reset();
}

}  // namespace insonate
