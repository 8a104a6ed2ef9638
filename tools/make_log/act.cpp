#include "tools/make_log/act.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>

#include "scenarios/steps/plane_region.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr double kWindow_mm = 100;
constexpr double kPitch_mm = 0.5;

/// The words of one `do` text, with the case and pose that it refers to.
struct Doing {
  const std::string& text;
  const Case& subject;
  const Pose& patient_from_probe;
  std::vector<std::string> words{};

  [[noreturn]] void refuse(const std::string& problem) const {
    throw InputError(subject.name, "do = \"" + text + "\"", problem,
                     "correct the plan; tools/make_log/plan.h explains it");
  }
  double number(std::size_t word) const {
    double value = 0;
    const char* end = words[word].data() + words[word].size();
    if (std::from_chars(words[word].data(), end, value).ptr != end) refuse("'" + words[word] + "' is not a number");
    return value;
  }
  glm::dvec2 landmark(const std::string& name) const {
    const Landmark* found = subject.find_landmark(name);
    if (!found) refuse("the landmark '" + name + "' is not in the case");
    return glm::dvec2(patient_from_probe.inverse().point(found->position));
  }
  PlaneRegion region(const std::string& structures, const std::optional<glm::dvec2>& near) const {
    std::vector<std::string> names;
    std::istringstream parts(structures);
    for (std::string name; std::getline(parts, name, '+');) {
      if (!subject.find_label(name)) refuse("the structure '" + name + "' is not in the case");
      names.push_back(name);
    }
    const auto found =
        plane_region(StructureSet(LabelIndex(subject), names), patient_from_probe, near, kWindow_mm, kPitch_mm);
    if (!found) refuse("the picture does not show it");
    return *found;
  }
};

Action caliper_on(const Doing& doing) {
  std::optional<glm::dvec2> near;
  if (doing.words.size() == 6) near = doing.landmark(doing.words[5]);
  const PlaneRegion region = doing.region(doing.words[2], near);
  double angle = doing.words[3] == "depth" ? std::numbers::pi / 2 : 0;
  if (doing.words[3] == "longest")
    for (int i = 0; i < 90; ++i)
      if (const double other = std::numbers::pi * i / 90;
          region.extent_mm({std::cos(other), std::sin(other)}) > region.extent_mm({std::cos(angle), std::sin(angle)}))
        angle = other;
  const glm::dvec2 along(std::cos(angle), std::sin(angle));
  const glm::dvec2 half = along * ((region.extent_mm(along) + doing.number(4)) / 2);
  const glm::dvec2 from = region.middle() - half, to = region.middle() + half;
  return {ActionKind::caliper, {doing.number(1), from.x, from.y, to.x, to.y}};
}

Action label_at(const Doing& doing) {
  const PlaneRegion region = doing.region(doing.words[1], std::nullopt);
  const glm::dvec2 middle = region.middle();
  const glm::dvec2 place = *std::min_element(
      region.pixels.begin(), region.pixels.end(),
      [&](const glm::dvec2& a, const glm::dvec2& b) { return glm::distance(a, middle) < glm::distance(b, middle); });
  return {ActionKind::label, {place.x, place.y}, doing.words[1]};
}

}  // namespace

std::vector<Action> made_of(const std::string& text, const Case& subject, const Pose& patient_from_probe) {
  Doing doing{text, subject, patient_from_probe};
  std::istringstream words(text);
  for (std::string word; words >> word;) doing.words.push_back(word);
  const std::string first = doing.words.empty() ? "" : doing.words[0];
  const std::size_t count = doing.words.size();
  if (first == "caliper_on" && (count == 5 || count == 6)) return {caliper_on(doing)};
  if (first == "label_at" && count == 2) return {label_at(doing)};
  if (first == "point_at" && count == 3) {
    const glm::dvec2 place = doing.landmark(doing.words[1]);
    return {{ActionKind::point, {place.x + doing.number(2), place.y}}};
  }
  return parse_actions(text, subject.name, "do = \"" + text + "\"");
}

}  // namespace insonate
