#include "sim/view/body/transfer_function.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace insonate::view {
namespace {

double position_of(double hu) {
  return std::clamp(hu - kFirstTransfer_hu, 0.0, double(TransferTable::kEntries - 1));
}

glm::dvec4 interpolated(const std::vector<glm::vec4>& entries, double position) {
  const int below = std::min(int(position), TransferTable::kEntries - 2);
  return glm::mix(glm::dvec4(entries[std::size_t(below)]), glm::dvec4(entries[std::size_t(below) + 1]),
                  position - below);
}

}  // namespace

TransferPoint TransferFunction::at(double hu) const {
  if (points.empty()) return {hu, glm::dvec3(1.0), 0.0};
  const auto above = std::find_if(points.begin(), points.end(), [&](const TransferPoint& p) { return p.hu > hu; });
  if (above == points.begin()) return {hu, points.front().colour, points.front().opacity};
  const TransferPoint& a = *(above - 1);
  if (above == points.end()) return {hu, a.colour, a.opacity};
  const double share = (hu - a.hu) / (above->hu - a.hu);
  // Sums of two weighted values, as in glm::mix(), may be larger than both by rounding.
  const auto between = [&](double from, double to) { return std::lerp(from, to, share); };
  const glm::dvec3 colour(between(a.colour.r, above->colour.r), between(a.colour.g, above->colour.g),
                          between(a.colour.b, above->colour.b));
  return {hu, colour, between(a.opacity, above->opacity)};
}

TransferFunction TransferFunction::moved(double shift_hu, double scale) const {
  TransferFunction moved = *this;
  if (points.empty()) return moved;
  const double centre = (points.front().hu + points.back().hu) / 2;
  for (TransferPoint& point : moved.points)
    point.hu = std::clamp(centre + (point.hu - centre) * scale + shift_hu, double(kFirstTransfer_hu),
                          double(kLastTransfer_hu));
  return moved;
}

TransferTable::TransferTable(const TransferFunction& function) {
  values.reserve(kEntries);
  integrals.reserve(kEntries);
  glm::dvec4 sum(0.0);
  for (int entry = 0; entry < kEntries; ++entry) {
    const TransferPoint point = function.at(kFirstTransfer_hu + entry);
    const double extinction = -std::log1p(-std::clamp(point.opacity, 0.0, kMaxOpacity));
    const glm::vec4 value(glm::dvec4(point.colour, 1.0) * extinction);
    if (entry > 0) sum += 0.5 * (glm::dvec4(values.back()) + glm::dvec4(value));
    values.push_back(value);
    integrals.push_back(glm::vec4(sum));
  }
}

glm::dvec4 TransferTable::value(double hu) const {
  return interpolated(values, position_of(hu));
}

glm::dvec4 TransferTable::mean(double front_hu, double back_hu) const {
  const double front = position_of(front_hu), back = position_of(back_hu);
  if (front == back) return value(front_hu);
  return (interpolated(integrals, back) - interpolated(integrals, front)) / (back - front);
}

VisibleRanges::VisibleRanges(const TransferTable& table) {
  visible_below_.reserve(std::size_t(TransferTable::kEntries) + 1);
  visible_below_.push_back(0);
  for (const glm::vec4& value : table.values) visible_below_.push_back(visible_below_.back() + (value.a > 0 ? 1 : 0));
}

bool VisibleRanges::shows(int low, int high) const {
  const auto entry = [](int hu) { return std::clamp(hu - kFirstTransfer_hu, 0, TransferTable::kEntries - 1); };
  return visible_below_[std::size_t(entry(high + 1)) + 1] > visible_below_[std::size_t(entry(low - 1))];
}

}  // namespace insonate::view
