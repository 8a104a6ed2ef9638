#include "sim/alignment/registration.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace insonate {
namespace {

enum Stage { kScatter, kWide, kFine, kAffine };

constexpr int kWideWidth = 48, kWideHeight = 36;
constexpr double kWideLength_mm = 4;  // of a reflection, so that interfaces are as wide as a pixel
constexpr double kBasin_mm = 8;       // ends that are nearer to each other are one
constexpr double kMostStretch = 0.15;
constexpr std::size_t kBatch = 512;  // places per call, to bound memory

std::unique_ptr<Similarity> similarity_of(const AcousticVolume& volume, const TrackedSweep& sweep,
                                          const WeinSettings& wein, Measure measure) {
  return measure == Measure::lc2 ? lc2_similarity(volume, sweep, wein) : slice_similarity(measure, volume, sweep, wein);
}

// The search of one registration, with what its stages share.
struct Run {
  const AcousticVolume& volume;
  const TrackedSweep& sweep;
  const RegistrationSettings& settings;
  std::vector<glm::dvec3> targets;
  Registration& result;

  EvaluateAll evaluator(Similarity& similarity, Stage stage) {
    return [this, &similarity, stage](std::span<const Parameters> points) {
      std::vector<double> values;
      for (std::size_t first = 0; first < points.size(); first += kBatch) {
        std::vector<glm::dmat4> places;
        for (const Parameters& point : points.subspan(first, std::min(kBatch, points.size() - first)))
          places.push_back(result.motion.at(point));
        for (const double value : similarity.at(places)) {
          result.evaluations.push_back({stage, Parameters(points[values.size()]), value});
          values.push_back(value);
        }
      }
      return values;
    };
  }

  double apart(const Parameters& a, const Parameters& b) const {
    return target_error_mm(targets, result.motion.at(a), result.motion.at(b));
  }

  // Returns the best, of which no two lie in one basin.
  std::vector<Optimum> distinct(std::vector<Optimum> ends, std::size_t most) const {
    std::ranges::stable_sort(ends, std::ranges::greater{}, &Optimum::value);
    std::vector<Optimum> kept;
    for (Optimum& end : ends)
      if (kept.size() < most &&
          std::ranges::none_of(kept, [&](const Optimum& k) { return apart(k.at, end.at) < kBasin_mm; }))
        kept.push_back(std::move(end));
    return kept;
  }

  LocalSearch search(double first_step, double tolerance, int most) const {
    const double mm = settings.search_mm + 20,
                 turn = (glm::radians(settings.search_deg) * result.motion.radius_mm) + 20,
                 stretch = kMostStretch * result.motion.radius_mm;
    LocalSearch local;
    for (std::size_t i = 0; i < parameters_of(result.motion.freedom); ++i)
      local.high.push_back(i < 3 ? mm : i < 6 ? turn : stretch);
    for (const double bound : local.high) local.low.push_back(-bound);
    local.first_step = first_step;
    local.tolerance = tolerance;
    local.most_evaluations = most;
    return local;
  }
};

}  // namespace

Registration register_sweep(const AcousticVolume& volume, const TrackedSweep& sweep, const glm::dmat4& start,
                            const RegistrationSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  Registration result;
  Run run{volume, sweep, settings, target_points(sweep), result};
  result.motion = motion_about(run.targets, start, Freedom::rigid);
  const Parameters none(6, 0.0);

  // Wide: small images.
  WeinSettings wide = settings.wein;
  wide.samples = 48;
  wide.reflection_length_mm = std::max(settings.wein.reflection_length_mm, kWideLength_mm);
  TrackedSweep small = reduced(sweep, settings.wide_slices, kWideWidth, kWideHeight);
  small.probe.lines = kWideWidth;
  std::vector<Optimum> ends;
  {
    const auto similarity = similarity_of(volume, small, wide, settings.measure);
    std::vector<Parameters> starts{none};
    if (settings.search_mm > 0 || settings.search_deg > 0)
      for (Parameters& each : scattered_motions(std::size_t(settings.scattered), settings.search_mm,
                                                glm::radians(settings.search_deg) * result.motion.radius_mm))
        starts.push_back(std::move(each));
    const std::vector<double> values = run.evaluator(*similarity, kScatter)(starts);
    std::vector<Optimum> scattered;
    for (std::size_t i = 0; i < starts.size(); ++i) scattered.push_back({std::move(starts[i]), values[i], 1, true});
    std::vector<Parameters> followed;
    for (const Optimum& each : run.distinct(std::move(scattered), std::size_t(settings.followed)))
      followed.push_back(each.at);
    ends = run.distinct(maximise_from(followed, run.evaluator(*similarity, kWide), run.search(5, 0.5, 120)), 4);
    result.wide_best = ends.front().value;
    if (ends.size() > 1) result.runner_up = ends[1].value;
  }

  // Fine: the images as they are.
  const Image<float>& full = sweep.images.front().grey;
  const TrackedSweep chosen = reduced(sweep, settings.slices, full.width, full.height);
  const auto similarity = similarity_of(volume, chosen, settings.wein, settings.measure);
  std::vector<Parameters> starts;
  for (const Optimum& end : ends) starts.push_back(end.at);
  const EvaluateAll fine = run.evaluator(*similarity, kFine);
  result.similarity_before = fine({&none, 1}).front();
  std::vector<Optimum> rough = maximise_from(starts, fine, run.search(2, 0.5, 40));
  const Optimum& best = *std::ranges::max_element(rough, {}, &Optimum::value);
  const Optimum end = maximise_from({best.at}, fine, run.search(0.7, 0.01, 250)).front();
  result.at = end.at;
  result.similarity_after = end.value;
  result.ct_from_sweep = result.motion.at(result.at);
  if (!end.within_tolerance) result.doubts.emplace_back("the search used up its evaluations");
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace insonate
