#include "app/session/annotations.h"

namespace insonate {

void Annotations::apply(const Action& action, const std::optional<Pose>& frozen_picture) {
  if (action.kind == ActionKind::take_back) {
    if (action.slot() > 0)
      measured_.erase(action.slot());
    else if (action.text.empty())
      point_.reset();
    else
      labels_.erase(action.text);
    return;
  }
  if (!frozen_picture) return;
  const Annotation mark{action, *frozen_picture};
  if (action.kind == ActionKind::caliper || action.kind == ActionKind::ellipse)
    measured_.insert_or_assign(action.slot(), mark);
  else if (action.kind == ActionKind::point)
    point_ = mark;
  else if (action.kind == ActionKind::label)
    labels_.insert_or_assign(action.text, mark);
}

void Annotations::clear() {
  measured_.clear();
  point_.reset();
  labels_.clear();
}

const Annotation* Annotations::at_place_of(const Action& action) const {
  const Action place = take_back(action);
  if (place.slot() > 0) {
    const auto found = measured_.find(place.slot());
    return found == measured_.end() ? nullptr : &found->second;
  }
  if (place.text.empty()) return point_ ? &*point_ : nullptr;
  const auto found = labels_.find(place.text);
  return found == labels_.end() ? nullptr : &found->second;
}

Action take_back(const Action& placed) {
  if (placed.kind == ActionKind::take_back) return placed;
  Action taking{ActionKind::take_back};
  if (placed.kind == ActionKind::caliper || placed.kind == ActionKind::ellipse) taking.numbers[0] = placed.numbers[0];
  if (placed.kind == ActionKind::label) taking.text = placed.text;
  return taking;
}

}  // namespace insonate
