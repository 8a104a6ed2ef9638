#include "devices/filter/filter_figures.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "devices/pose_history.h"
#include "sim/core/hash.h"

namespace insonate {
namespace {

constexpr double kNoise_mm = 0.1, kSeconds = 30, kPi = glm::pi<double>();
/// The start-up of the filters is excluded.
constexpr double kFrom_s = 1;

/// Uniform in 0 to 1, never 0.
double uniform(std::uint32_t index, std::uint32_t purpose) {
  return (hash(index, purpose) + 1.0) / 4294967296.0;
}

/// Normally distributed, by the Box-Muller method.
double normal(std::uint32_t index, std::uint32_t purpose) {
  return std::sqrt(-2 * std::log(uniform(index, 2 * purpose))) * std::cos(2 * kPi * uniform(index, 2 * purpose + 1));
}

using Way = std::function<glm::dvec3(double time_s)>;

glm::dvec3 resting(double) {
  return {300, 50, -80};
}

/// Sinusoidal sweep with 100 mm/s at its middle and a period of 2 s.
glm::dvec3 sweeping(double time_s) {
  return {300 + 100 / kPi * std::sin(kPi * time_s), 50, -80};
}

/// Smooth, never repeats, 90 mm/s RMS.
glm::dvec3 scanning(double time_s) {
  return {300 + 34 * std::sin(2.1 * time_s) + 12 * std::sin(5.3 * time_s), 50 + 27 * std::sin(2.7 * time_s + 1),
          -80 + 11 * std::sin(4.1 * time_s + 2)};
}

std::vector<ProbeSample> noisy(const Way& way, double rate_hz) {
  std::vector<ProbeSample> samples;
  for (std::uint32_t i = 0; i < kSeconds * rate_hz; ++i) {
    const glm::dvec3 noise(normal(i, 1), normal(i, 2), normal(i, 3));
    const double time_s = i / rate_hz;
    samples.push_back({time_s, PoseStatus::ok, Pose{glm::dmat3(1), way(time_s) + kNoise_mm * noise}, 0});
  }
  return samples;
}

std::vector<ProbeSample> filtered(std::vector<ProbeSample> samples, const FilterSettings& settings) {
  SampleFilters filters(settings);
  for (ProbeSample& sample : samples) filters.apply(sample, glm::dvec3(0));
  return samples;
}

/// Returns the RMS deviation along the first axis from `way` delayed by `lag_s`.
double off_mm(const std::vector<ProbeSample>& samples, const Way& way, double lag_s) {
  double squares = 0;
  std::size_t count = 0;
  for (const ProbeSample& sample : samples) {
    if (sample.time_s < kFrom_s || sample.status != PoseStatus::ok) continue;
    const double off = sample.patient_from_probe.translation.x - way(sample.time_s - lag_s).x;
    squares += off * off;
    ++count;
  }
  return std::sqrt(squares / double(count));
}

}  // namespace

SmoothingFigures measure_smoothing(const FilterSettings& settings, double rate_hz) {
  SmoothingFigures figures;
  const std::vector<ProbeSample> rest = noisy(resting, rate_hz);
  figures.rest_before_mm = off_mm(rest, resting, 0);
  figures.rest_after_mm = off_mm(filtered(rest, settings), resting, 0);
  const std::vector<ProbeSample> moved = filtered(noisy(sweeping, rate_hz), settings);
  double least = HUGE_VAL;
  for (int quarter_ms = 0; quarter_ms < 400; ++quarter_ms) {
    const double lag_s = quarter_ms * 0.00025, off = off_mm(moved, sweeping, lag_s);
    if (off >= least) continue;
    least = off;
    figures.lag_s = lag_s;
  }
  return figures;
}

PredictionFigures measure_prediction(double rate_hz, double ahead_s) {
  PoseHistory history;
  PredictionFigures figures;
  std::size_t count = 0;
  for (const ProbeSample& sample : noisy(scanning, rate_hz)) {
    history.add(sample);
    if (sample.time_s < kFrom_s) continue;
    const glm::dvec3 there = scanning(sample.time_s + ahead_s);
    const glm::dvec3 held = sample.patient_from_probe.translation - there;
    const glm::dvec3 predicted = history.at(sample.time_s + ahead_s).patient_from_probe.translation - there;
    figures.held_mm += glm::dot(held, held);
    figures.predicted_mm += glm::dot(predicted, predicted);
    ++count;
  }
  figures.held_mm = std::sqrt(figures.held_mm / double(count));
  figures.predicted_mm = std::sqrt(figures.predicted_mm / double(count));
  return figures;
}

RejectionFigures measure_rejection(const FilterSettings& settings, double rate_hz) {
  enum class Made { good, stray, mirrored };
  std::vector<ProbeSample> samples = noisy(scanning, rate_hz);
  std::vector<Made> made(samples.size(), Made::good);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    glm::dvec3& mm = samples[i].patient_from_probe.translation;
    if (std::fmod(samples[i].time_s, 5) > 4.2) {
      mm = -mm;
      made[i] = Made::mirrored;
    } else if (uniform(i, 40) < 0.02) {
      // 30 to 500 mm away, in any direction.
      const glm::dvec3 to = glm::normalize(glm::dvec3(normal(i, 5), normal(i, 6), normal(i, 7)));
      mm += to * (30 + 470 * uniform(i, 41));
      made[i] = Made::stray;
    }
  }
  RejectionFigures figures;
  const std::vector<ProbeSample> out = filtered(samples, settings);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool gone = out[i].status != PoseStatus::ok;
    ++(made[i] == Made::good ? figures.good : made[i] == Made::stray ? figures.strays : figures.mirrored);
    if (!gone) continue;
    ++(made[i] == Made::good    ? figures.good_rejected
       : made[i] == Made::stray ? figures.strays_rejected
                                : figures.mirrored_rejected);
  }
  return figures;
}

DistortionFigures measure_distortion(std::uint32_t most_distortion) {
  // Steel near the sensor causes errors up to 100 mm. It is beside the hand's path, and has an effect within a few
  // centimetres.
  const glm::dvec3 steel(345, 50, -80);
  constexpr double kMax_mm = 100, kReach_mm = 12;
  const std::vector<ProbeSample> there = noisy(scanning, 60);
  std::vector<ProbeSample> disturbed = there;
  for (std::uint32_t i = 0; i < disturbed.size(); ++i) {
    glm::dvec3& mm = disturbed[i].patient_from_probe.translation;
    const glm::dvec3 to_steel = steel - mm;
    const double off_mm = kMax_mm * std::exp(-glm::length(to_steel) / kReach_mm);
    mm += off_mm * glm::normalize(to_steel);
    // The grade only approximates the error.
    disturbed[i].distortion = std::uint32_t(std::max(0.0, off_mm * (0.75 + 0.5 * uniform(i, 50))));
  }
  const std::vector<ProbeSample> kept = filtered(disturbed, {.distortion = true, .most_distortion = most_distortion});
  DistortionFigures figures;
  double squares_before = 0, squares_after = 0;
  std::size_t passed = 0;
  for (std::size_t i = 0; i < disturbed.size(); ++i) {
    const double off_mm =
        glm::distance(disturbed[i].patient_from_probe.translation, there[i].patient_from_probe.translation);
    figures.worst_before_mm = std::max(figures.worst_before_mm, off_mm);
    squares_before += off_mm * off_mm;
    if (kept[i].status != PoseStatus::ok) continue;
    ++passed;
    figures.worst_after_mm = std::max(figures.worst_after_mm, off_mm);
    squares_after += off_mm * off_mm;
  }
  figures.rms_before_mm = std::sqrt(squares_before / double(disturbed.size()));
  figures.rms_after_mm = passed > 0 ? std::sqrt(squares_after / double(passed)) : 0;
  figures.rejected = 1 - double(passed) / double(disturbed.size());
  return figures;
}

}  // namespace insonate
