#include "sim/reconstruction/sweep_quality.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sim/core/text.h"

namespace insonate {
namespace {

/// A hand that rests trembles by less, mm.
constexpr double kTremor_mm = 0.5;
/// Pictures are missing where the time between two is longer than this many of the median.
constexpr double kMissing = 1.5;

double median_duration_s(const std::vector<SweepStep>& steps) {
  std::vector<double> durations;
  for (const SweepStep& step : steps) durations.push_back(step.duration_s);
  const auto middle = durations.begin() + std::ptrdiff_t(durations.size() / 2);
  std::nth_element(durations.begin(), middle, durations.end());
  return *middle;
}

std::optional<SweepFlaw::Kind> spacing_flaw(const SweepStep& step, double usual_s, const SweepLimits& limits) {
  if (step.spacing_mm <= limits.spacing_mm) return std::nullopt;
  const bool missing = step.duration_s > kMissing * usual_s, unfilled = step.spacing_mm > 2 * limits.hole_radius_mm;
  return missing || unfilled ? SweepFlaw::Kind::gap : SweepFlaw::Kind::too_fast;
}

/// Joins neighbouring steps that are too fast. Each gap is a flaw of its own.
std::vector<SweepFlaw> spacing_flaws(const std::vector<SweepStep>& steps, double usual_s, const SweepLimits& limits) {
  std::vector<SweepFlaw> flaws;
  double at_mm = 0;
  bool goes_on = false;
  for (const SweepStep& step : steps) {
    const auto kind = spacing_flaw(step, usual_s, limits);
    if (kind && goes_on && *kind == SweepFlaw::Kind::too_fast) {
      flaws.back().end_s = step.time_s;
      flaws.back().size_mm = std::max(flaws.back().size_mm, step.spacing_mm);
    } else if (kind) {
      flaws.push_back({*kind, step.time_s - step.duration_s, step.time_s, at_mm, step.spacing_mm});
    }
    goes_on = kind == SweepFlaw::Kind::too_fast;
    at_mm += step.advance_mm;
  }
  return flaws;
}

/// Finds the parts in which the hand moved back: from the farthest place so far until it is reached again, or until the
/// end.
std::vector<SweepFlaw> turns(const std::vector<SweepStep>& steps) {
  std::vector<SweepFlaw> flaws;
  double at_mm = 0, farthest_mm = 0, farthest_s = 0;
  double deepest_mm = 0, deepest_s = 0;  // of the present way back
  const auto close = [&] {
    if (deepest_mm > kTremor_mm)
      flaws.push_back({SweepFlaw::Kind::turned_back, farthest_s, deepest_s, farthest_mm, deepest_mm});
    deepest_mm = 0;
  };
  for (const SweepStep& step : steps) {
    at_mm += step.advance_mm;
    if (at_mm >= farthest_mm) {
      close();
      farthest_mm = at_mm;
      farthest_s = step.time_s;
    } else if (farthest_mm - at_mm > deepest_mm) {
      deepest_mm = farthest_mm - at_mm;
      deepest_s = step.time_s;
    }
  }
  close();
  return flaws;
}

}  // namespace

std::string SweepFlaw::words() const {
  switch (kind) {
    case Kind::too_fast:
      if (formatted("%.1f", begin_s) == formatted("%.1f", end_s)) return formatted("too fast at %.1f s", begin_s);
      return formatted("too fast between %.1f s and %.1f s", begin_s, end_s);
    case Kind::gap:
      return formatted("gap of %.1f mm at %.0f mm", size_mm, std::round(at_mm) + 0.0);  // -0 as 0
    case Kind::turned_back:
      break;
  }
  return formatted("turned back by %.0f mm between %.1f s and %.1f s", size_mm, begin_s, end_s);
}

std::string SweepQuality::verdict() const {
  if (pictures < 2) return "No sweep: it has fewer than two pictures.";
  const std::string what = formatted("%zu pictures over %.0f mm in %.1f s", pictures, length_mm, duration_s);
  if (is_along()) return what + formatted(". They moved %.0f mm within their own plane: sweep across it.", slid_mm);
  if (flaws.empty()) return "Even: " + what + formatted(", at most %.1f mm apart.", largest_spacing_mm);
  return "Uneven: " + what + formatted(", up to %.1f mm apart.", largest_spacing_mm);
}

void SweepMeter::add(const TrackedPicture& picture) {
  if (pictures_++ == 0) {
    begin_s_ = picture.time_s;
  } else {
    const Pose last_from_patient = plane_of(last_from_pixel_).inverse();
    SweepStep step;
    step.time_s = picture.time_s - begin_s_;
    step.duration_s = picture.time_s - last_s_;
    glm::dvec2 low(std::numeric_limits<double>::max()), high = -low;
    for (const glm::dvec2& pixel : picture.region->outline) {
      const double off_mm = last_from_patient.point(glm::dvec3(picture.patient_from_pixel * glm::dvec4(pixel, 0, 1))).z;
      step.spacing_mm = std::max(step.spacing_mm, std::abs(off_mm));
      low = glm::min(low, pixel);
      high = glm::max(high, pixel);
    }
    const glm::dvec2 middle = (low + high) / 2.0;
    const glm::dvec3 now(picture.patient_from_pixel * glm::dvec4(middle, 0, 1));
    step.advance_mm = last_from_patient.point(now).z;
    if (picture.region == first_region_) {
      const glm::dvec3 first(first_from_pixel_ * glm::dvec4(middle, 0, 1));
      const Pose first_from_patient = plane_of(first_from_pixel_).inverse();
      const glm::dvec3 way = first_from_patient.point(now) - first_from_patient.point(first);
      slid_mm_ = std::max(slid_mm_, glm::length(glm::dvec2(way)));
    }
    steps_.push_back(step);
  }
  if (picture.region != first_region_) {
    first_region_ = picture.region;
    first_from_pixel_ = picture.patient_from_pixel;
  }
  last_s_ = picture.time_s;
  last_from_pixel_ = picture.patient_from_pixel;
}

SweepQuality SweepMeter::quality() const {
  SweepQuality quality;
  quality.pictures = pictures_;
  quality.duration_s = last_s_ - begin_s_;
  quality.steps = steps_;
  quality.slid_mm = slid_mm_;
  if (steps_.empty()) return quality;
  double way_mm = 0;
  for (const SweepStep& step : steps_) way_mm += step.advance_mm;
  for (SweepStep& step : quality.steps) {
    if (way_mm < 0) step.advance_mm = -step.advance_mm;
    quality.length_mm += std::max(step.advance_mm, 0.0);
    quality.largest_spacing_mm = std::max(quality.largest_spacing_mm, step.spacing_mm);
    quality.fastest_mm_s = std::max(quality.fastest_mm_s, step.speed_mm_s());
  }
  const double usual_s = median_duration_s(steps_);
  quality.picture_hz = usual_s > 0 ? 1 / usual_s : 0;
  quality.flaws = spacing_flaws(quality.steps, usual_s, limits_);
  for (const SweepFlaw& turn : turns(quality.steps)) quality.flaws.push_back(turn);
  std::stable_sort(quality.flaws.begin(), quality.flaws.end(),
                   [](const SweepFlaw& a, const SweepFlaw& b) { return a.begin_s < b.begin_s; });
  return quality;
}

SweepQuality sweep_quality(std::span<const TrackedPicture> pictures, const SweepLimits& limits) {
  SweepMeter meter(limits);
  for (const TrackedPicture& picture : pictures) meter.add(picture);
  return meter.quality();
}

}  // namespace insonate
