#include "devices/calibration/lag.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

namespace insonate {
namespace {

constexpr double kStep_s = 0.005;
constexpr double kSmooth_s = 0.015;
/// Two peaks this far apart are two different explanations.
constexpr double kOtherPeak_s = 0.06;
constexpr double kOtherPeakShare = 0.8;
/// Length of a set-up session. It limits the memory if a clock is wrong.
constexpr double kLongest_s = 600;

/// Correlates late[i + shift] with early[i] over their overlap. Returns 0 if that is less than half of the shorter one,
/// or if a signal is constant.
double correlation_at(const Signal& late, const Signal& early, long shift) {
  const long begin = std::max(0L, -shift), end = std::min(long(early.values.size()), long(late.values.size()) - shift);
  const double count = double(end - begin);
  if (2 * count < double(std::min(late.values.size(), early.values.size()))) return 0;
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (long i = begin; i < end; ++i) {
    const double x = late.values[std::size_t(i + shift)], y = early.values[std::size_t(i)];
    a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double power = (aa - a * a / count) * (bb - b * b / count);
  return power > 1e-12 * aa * bb ? (ab - a * b / count) / std::sqrt(power) : 0;
}

/// Returns the vertex of the parabola through three values, relative to the middle one, in steps from -0.5 to 0.5.
double vertex(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

std::vector<double> smoothed(const std::vector<double>& values, double step_s) {
  const int radius = int(std::ceil(3 * kSmooth_s / step_s));
  std::vector<double> out(values.size());
  for (int i = 0; i < int(values.size()); ++i) {
    double sum = 0, weights = 0;
    for (int k = std::max(0, i - radius); k <= std::min(int(values.size()) - 1, i + radius); ++k) {
      const double weight = std::exp(-0.5 * std::pow((k - i) * step_s / kSmooth_s, 2));
      sum += weight * values[std::size_t(k)];
      weights += weight;
    }
    out[std::size_t(i)] = sum / weights;
  }
  return out;
}

/// Returns the signal that stopping_of() would give for short knocks at these times.
Signal blows_at(std::span<const double> times_s, const Signal& like) {
  Signal signal{like.begin_s, like.step_s, std::vector<double>(like.values.size())};
  for (const double time_s : times_s)
    for (std::size_t i = 0; i < signal.values.size(); ++i) {
      const double off = (signal.begin_s + double(i) * signal.step_s - time_s) / kSmooth_s;
      if (std::abs(off) < 4) signal.values[i] += std::exp(-0.5 * off * off);
    }
  return signal;
}

}  // namespace

Outcome<LagFit> lag_between(const Signal& late, const Signal& early) {
  if (late.step_s != early.step_s || !(late.step_s > 0)) throw std::invalid_argument("the signals' steps differ");
  if (late.values.empty() || early.values.empty()) return Refusal{"There is no motion to compare; begin again."};
  // The signals begin at different times: shift s compares early[i] with late[i + s].
  const double offset = (early.begin_s - late.begin_s) / late.step_s;
  const auto first = long(std::ceil(kMinLag_s / late.step_s + offset)),
             last = long(std::floor(kMaxLag_s / late.step_s + offset));
  std::vector<double> correlation;
  for (long shift = first; shift <= last; ++shift) correlation.push_back(correlation_at(late, early, shift));
  const auto peak = std::max_element(correlation.begin(), correlation.end()) - correlation.begin();
  const double best = correlation[std::size_t(peak)];
  if (best < kMinCorrelation)
    return Refusal{
        "The blows do not show in the tracker's motion. Strike the key with the probe itself, and begin again."};
  for (std::size_t i = 1; i + 1 < correlation.size(); ++i) {
    const bool is_peak = correlation[i] >= correlation[i - 1] && correlation[i] >= correlation[i + 1];
    const double apart_s = std::abs(double(i) - double(peak)) * late.step_s;
    if (is_peak && apart_s > kOtherPeak_s && correlation[i] > kOtherPeakShare * best)
      return Refusal{"The rhythm is too steady to tell which beat is which; begin again with uneven pauses."};
  }
  double fine = 0;
  if (peak > 0 && peak + 1 < std::ptrdiff_t(correlation.size()))
    fine = vertex(correlation[std::size_t(peak) - 1], best, correlation[std::size_t(peak) + 1]);
  return LagFit{(double(first + peak) + fine - offset) * late.step_s, best};
}

Signal stopping_of(std::span<const SensorSample> samples) {
  std::vector<std::pair<double, glm::dvec3>> places;
  for (const SensorSample& sample : samples)
    if (sample.status == PoseStatus::ok) places.emplace_back(sample.time_s, sample.tracker_from_sensor.translation);
  if (places.size() < 2) return {};
  const double begin_s = places.front().first, duration_s = std::min(places.back().first - begin_s, kLongest_s);
  Signal signal{begin_s, kStep_s, {}};
  const auto count = std::size_t(duration_s / kStep_s) + 1;
  std::vector<double> along[3];
  for (std::size_t i = 0, at = 0; i < count; ++i) {
    const double time_s = begin_s + double(i) * kStep_s;
    while (at + 2 < places.size() && places[at + 1].first < time_s) ++at;
    const auto& [t0, p0] = places[at];
    const auto& [t1, p1] = places[at + 1];
    const glm::dvec3 place = p0 + (p1 - p0) * std::clamp((time_s - t0) / (t1 - t0), 0.0, 1.0);
    for (int axis = 0; axis < 3; ++axis) along[axis].push_back(place[axis]);
  }
  for (std::vector<double>& axis : along) axis = smoothed(axis, kStep_s);
  const auto speed = [&](std::size_t i) {
    double squares = 0;
    for (const std::vector<double>& axis : along) squares += std::pow((axis[i + 1] - axis[i]) / kStep_s, 2);
    return std::sqrt(squares);
  };
  // Speeds lie between the steps, their differences on the steps again.
  signal.values.assign(count, 0);
  for (std::size_t i = 1; i + 1 < count; ++i) signal.values[i] = std::max(0.0, (speed(i - 1) - speed(i)) / kStep_s);
  return signal;
}

Outcome<KnockLag> knock_lag(std::span<const SensorSample> samples, std::span<const double> key_times_s) {
  if (key_times_s.size() < kMinKnocks)
    return Refusal{"There were " + std::to_string(key_times_s.size()) + " blows; strike the key at least " +
                   std::to_string(kMinKnocks) + " times."};
  // Motion before and after the knocks is ignored.
  std::vector<SensorSample> about;
  for (const SensorSample& sample : samples)
    if (sample.time_s > key_times_s.front() - 0.5 && sample.time_s < key_times_s.back() + kMaxLag_s + 0.3)
      about.push_back(sample);
  const Signal stopping = stopping_of(about);
  if (stopping.values.empty()) return Refusal{"The tracker was not seen; begin again where it is."};
  const Outcome<LagFit> fit = lag_between(stopping, blows_at(key_times_s, stopping));
  if (!fit) return Refusal{fit.refusal()};

  KnockLag found{fit->lag_s, 0, 0};
  double squares = 0;
  for (const double time_s : key_times_s) {
    const auto index = [&](double s) { return long(std::lround((s - stopping.begin_s) / stopping.step_s)); };
    const long begin = index(time_s + fit->lag_s - kOtherPeak_s), end = index(time_s + fit->lag_s + kOtherPeak_s);
    if (begin < 1 || end + 1 >= long(stopping.values.size())) continue;
    const auto peak = std::max_element(stopping.values.begin() + begin, stopping.values.begin() + end + 1);
    const double at_s = stopping.begin_s + stopping.step_s * (double(peak - stopping.values.begin()) +
                                                              vertex(*(peak - 1), *peak, *(peak + 1)));
    squares += std::pow(at_s - time_s - fit->lag_s, 2);
    ++found.knocks;
  }
  if (found.knocks < kMinKnocks) return Refusal{"The tracker was lost while the key was struck; begin again."};
  found.spread_s = std::sqrt(squares / double(found.knocks));
  return found;
}

}  // namespace insonate
