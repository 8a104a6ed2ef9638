#include "app/replay/shown_annotations.h"

#include "scenarios/caliper.h"

namespace insonate {
namespace {

std::vector<ShownAnnotations::Placed> placed_in(const std::optional<Pose>& picture, const PictureTools& tools) {
  std::vector<ShownAnnotations::Placed> placed;
  const auto& hand = tools.in_hand();
  const auto add = [&](const Annotation& annotation) {
    if (annotation.patient_from_probe != picture) return;
    if (hand && take_back(*hand) == take_back(annotation.action)) return;
    placed.push_back({annotation.action});
  };
  for (const auto& [slot, annotation] : tools.annotations().measured()) add(annotation);
  if (tools.annotations().point()) add(*tools.annotations().point());
  for (const auto& [name, annotation] : tools.annotations().labels()) add(annotation);
  if (hand) placed.push_back({*hand, true});
  return placed;
}

std::vector<ShownAnnotations::Value> values_of(const std::optional<Pose>& picture, const PictureTools& tools) {
  using Of = ShownAnnotations::Value::Of;
  std::vector<ShownAnnotations::Value> values;
  const auto& hand = tools.in_hand();
  const bool numbered = tools.free_choice() || (tools.measuring() && tools.measuring()->slots.size() > 1);
  const auto add = [&](const Action& action, Of of) {
    const std::string number = numbered ? std::to_string(action.slot()) + "   " : "";
    values.push_back({number + tools.slot_name(action.slot()), value_text(action), of});
  };
  for (const auto& [slot, annotation] : tools.annotations().measured())
    if (!hand || hand->slot() != slot)
      add(annotation.action, picture == annotation.patient_from_probe ? Of::picture : Of::other_picture);
  // An ellipse without a width has no area yet.
  if (hand && (hand->kind == ActionKind::caliper || (hand->kind == ActionKind::ellipse && hand->numbers[5] > 0)))
    add(*hand, Of::in_hand);
  if (const std::string total = tools.total_text(); !total.empty()) {
    const std::size_t blank = total.find(' ');
    values.push_back({total.substr(0, blank), total.substr(blank + 1), Of::picture});
  }
  return values;
}

}  // namespace

ShownAnnotations shown_annotations(const Session& session, const PictureTools& tools) {
  const auto picture = session.frozen_picture();
  return {placed_in(picture, tools), tools.unnamed_place(), values_of(picture, tools)};
}

}  // namespace insonate
