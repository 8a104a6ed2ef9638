#include "sim/registration/registration.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sim/registration/coarse_volume.h"
#include "sim/registration/uncertainty.h"

namespace insonate {
namespace {

enum Stage { kScatter, kWide, kFine, kLook, kAffine, kElsewhere };

// The widest stage. Voxels are joined up to this size, because places that are scattered over a whole CT wait for its
// memory. Reflections are longer, so that interfaces are as wide as a pixel.
constexpr int kWideWidth = 64, kWideHeight = 48, kWidePatch = 8;  // pixels
constexpr double kWideVoxel_mm = 2, kWideLength_mm = 4;

// A few of its images, of those that vary at least kTelling times as much as the one that varies most, sort out most of
// the scattered places: one in kSift is looked at with all images, but at least kLeastSifted for each that is followed.
constexpr int kScatterSlices = 4;
constexpr double kTelling = 0.1;
constexpr std::size_t kSift = 4, kLeastSifted = 4;

constexpr std::size_t kFineStarts = 4;
constexpr double kBasin_mm = 8;  // ends that are nearer to each other are one, or half the search range if less
constexpr double kBasin_deg = 8;
constexpr double kAmbiguous = 0.9;  // of the similarity
constexpr int kClimbs = 3;          // most repetitions of the last search

// The looks around the best place, each at other places: two at least, and then while the similarity still rises by the
// share kRise. Half of the images is enough for one, if these are kLeastLooking or more. The same half each time led
// astray by 4 mm. Fewer places and looks are faster, but a live registration then converged up to 3.7 mm off.
constexpr std::size_t kMaxLooks = 5, kAround = 128, kAroundFollowed = 8;
constexpr double kAround_mm = 6, kAround_deg = 6, kApart_mm = 1.5, kRise = 0.002;
constexpr std::size_t kLeastLooking = 10;

constexpr double kMaxStretch = 0.15;
constexpr std::size_t kPlacesElsewhere = 48;
constexpr double kElsewhere_mm = 40, kElsewhere_deg = 30, kMinElsewhere_mm = 20;
// Images of noise end 1.3 times above elsewhere, sweeps at their place 2 to 3.5 times.
constexpr double kStandsOut = 1.5;

std::unique_ptr<Similarity> similarity_of(const AcousticVolume& volume, const TrackedSweep& sweep,
                                          const WeinSettings& wein, Measure measure) {
  return measure == Measure::lc2 ? lc2_similarity(volume, sweep, wein) : slice_similarity(measure, volume, sweep, wein);
}

// Returns the few images by which scattered places are sorted out.
TrackedSweep scatter_images(const TrackedSweep& wide) {
  double most = 0;
  for (const SweepImage& image : wide.images) most = std::max(most, variation_in_depth(image.grey));
  TrackedSweep telling{Probe(wide.probe), wide.depth_mm, {}};
  for (const SweepImage& image : wide.images)
    if (variation_in_depth(image.grey) >= kTelling * most) telling.images.push_back(image);
  return reduced(telling, kScatterSlices, kWideWidth, kWideHeight);
}

// Returns the fine stage's images. Every second one comes first, so that either half is spread as all are.
TrackedSweep fine_images(const TrackedSweep& sweep, int most) {
  const Image<float>& full = sweep.images.front().grey;
  TrackedSweep in_order = reduced(sweep, most, full.width, full.height);
  TrackedSweep fine{Probe(sweep.probe), sweep.depth_mm, {}};
  for (const std::size_t first : {0, 1})
    for (std::size_t i = first; i < in_order.images.size(); i += 2)
      fine.images.push_back(std::move(in_order.images[i]));
  return fine;
}

// Returns which of the fine stage's images look around the best place, the one time and the other.
std::array<ImageRange, 2> looking_images(const TrackedSweep& fine) {
  const std::size_t half = fine.images.size() / 2;
  if (half < kLeastLooking) return {};
  return {ImageRange{0, fine.images.size() - half}, ImageRange{fine.images.size() - half, half}};
}

// The search of one registration, with what its stages share.
struct Run {
  const RegistrationSettings& settings;
  const std::vector<glm::dvec3>& targets;
  const glm::dmat4 moments;  // of the targets
  SweepRegistration& result;
  bool confirmed = false;  // two rounds have found the best place

  EvaluateAll evaluator(Similarity& similarity, Stage stage, ImageRange used = {}) {
    return [this, &similarity, stage, used](std::span<const Parameters> points) {
      std::vector<double> values;
      const auto batch = std::size_t(settings.batch);
      for (std::size_t first = 0; first < points.size(); first += batch) {
        if (settings.between_calls) settings.between_calls();
        std::vector<glm::dmat4> places;
        for (const Parameters& point : points.subspan(first, std::min(batch, points.size() - first)))
          places.push_back(result.motion.at(point));
        for (const double value : similarity.at(places, used)) {
          result.evaluations.push_back({stage, Parameters(points[values.size()]), value});
          values.push_back(value);
        }
      }
      return values;
    };
  }

  double apart(const Parameters& a, const Parameters& b) const {
    return target_error_mm(moments, result.motion.at(a), result.motion.at(b));
  }

  double basin_mm() const { return settings.search_mm > 0 ? std::min(kBasin_mm, settings.search_mm / 2) : kBasin_mm; }

  static std::vector<Optimum> evaluated(std::vector<Parameters> places, const EvaluateAll& evaluate) {
    const std::vector<double> values = evaluate(places);
    std::vector<Optimum> all;
    for (std::size_t i = 0; i < places.size(); ++i) all.push_back({std::move(places[i]), values[i], 1, true});
    return all;
  }

  // Returns what all images make of the places that a few images find promising, or of all places if they are not many
  // more than that.
  std::vector<Optimum> sifted(std::vector<Parameters> places, const EvaluateAll& by_few,
                              const EvaluateAll& by_all) const {
    const std::size_t kept = std::max(places.size() / kSift, kLeastSifted * std::size_t(settings.followed));
    if (places.size() <= 2 * kept) return evaluated(std::move(places), by_all);
    std::vector<Optimum> all = evaluated(std::move(places), by_few);
    std::ranges::stable_sort(all, std::ranges::greater{}, &Optimum::value);
    std::vector<Parameters> promising;
    for (std::size_t i = 0; i < kept; ++i) promising.push_back(std::move(all[i].at));
    return evaluated(std::move(promising), by_all);
  }

  // Returns the best, of which no two lie in one basin, or nearer to each other than `least_mm`.
  std::vector<Optimum> distinct(std::vector<Optimum> ends, std::size_t most,
                                std::optional<double> least_mm = std::nullopt) const {
    std::ranges::stable_sort(ends, std::ranges::greater{}, &Optimum::value);
    std::vector<Optimum> kept;
    for (Optimum& end : ends)
      if (kept.size() < most && std::ranges::none_of(kept, [&](const Optimum& k) {
            return apart(k.at, end.at) < least_mm.value_or(basin_mm());
          }))
        kept.push_back(std::move(end));
    return kept;
  }

  // Returns the highest similarity of the ends that are another place than `best`; 0 if there is none. Ends that lie
  // closer together are maxima of one basin, though a narrow search follows each of them. So are ends from which a way
  // leads up to the best one, which is tried where it matters. Mutual information is not a share: none is tried.
  double rival_of(const Optimum& best, std::vector<Optimum> ends, const EvaluateAll& evaluate) const {
    std::ranges::stable_sort(ends, std::ranges::greater{}, &Optimum::value);
    for (const Optimum& end : ends) {
      if (apart(end.at, best.at) < kBasin_mm) continue;
      if (end.value <= kAmbiguous * best.value || settings.measure == Measure::mutual_information ||
          !leads_up(end, best, evaluate))
        return end.value;
    }
    return 0;
  }

  // Looks for a higher maximum beside the best place. There may be several within one basin, of which the searches so
  // far have found any. One half of the images looks, then the other, and all of them go on from the highest place
  // that it finds.
  Optimum look_around(Optimum best, const std::array<EvaluateAll, 2>& by_halves, const EvaluateAll& by_all) const {
    for (std::size_t round = 0; round < kMaxLooks; ++round) {
      const EvaluateAll& by_half = by_halves[round % 2];
      std::vector<Parameters> around =
          scattered_motions(round * kAround, kAround, kAround_mm, glm::radians(kAround_deg) * result.motion.radius_mm);
      for (Parameters& each : around)
        for (std::size_t i = 0; i < each.size(); ++i) each[i] += best.at[i];
      std::vector<Parameters> followed{best.at};
      for (const Optimum& each : distinct(evaluated(std::move(around), by_half), kAroundFollowed, kApart_mm))
        followed.push_back(each.at);
      const Optimum found = distinct(maximise_from(followed, by_half, search(1, 0.5, 80)), 1).front();
      const double before = best.value;
      best = distinct(maximise_from({best.at, found.at}, by_all, search(0.5, 0.2, 80)), 1).front();
      if (round > 0 && best.value - before < kRise * std::abs(before)) break;
    }
    return best;
  }

  // Goes on from an end that is not a maximum: small steps may stop on the unevenness of a slope. Returns the
  // uncertainty at the end; none for mutual information, which is not a share of variance.
  Uncertainty climb_on(Optimum& end, const EvaluateAll& evaluate, const TrackedSweep& compared) const {
    if (settings.measure == Measure::mutual_information || end.value <= 0) return {};
    const double pixels = independent_pixels(compared);
    Uncertainty found = uncertainty_at(end.at, result.motion, evaluate, pixels, targets);
    for (int i = 0; i < kClimbs && !found.is_maximum; ++i) {
      Optimum higher = maximise_from({end.at}, evaluate, search(2, 0.01, 250, end.at.size())).front();
      if (higher.value <= end.value) break;
      end = std::move(higher);
      found = uncertainty_at(end.at, result.motion, evaluate, pixels, targets);
    }
    return found;
  }

  // Returns the similarity that a tenth of the places far from the end exceed: so much is similar by chance.
  double elsewhere(const Optimum& end, const EvaluateAll& evaluate) const {
    std::vector<Parameters> places;
    for (Parameters& place : scattered_motions(0, kPlacesElsewhere, kElsewhere_mm,
                                               glm::radians(kElsewhere_deg) * result.motion.radius_mm)) {
      place.resize(end.at.size());
      for (std::size_t i = 0; i < place.size(); ++i) place[i] += end.at[i];
      if (apart(place, end.at) >= kMinElsewhere_mm) places.push_back(std::move(place));
    }
    std::vector<double> values = evaluate(places);
    std::ranges::sort(values);
    return values.empty() ? 0 : values[values.size() * 9 / 10];
  }

  // Finds out how far the result can be trusted.
  void judge(const Optimum& end, const Uncertainty& found, const TrackedSweep& compared) {
    const auto doubt = [&](const char* why) { result.doubts.emplace_back(why); };
    if (end.value <= 0) return doubt("the images show nothing of the CT");
    if (spread_mm(compared) < kMinSpread_mm) doubt(kTooClose);
    if (compared.images.size() < kMinImages) doubt(kTooFew);
    if (!end.within_tolerance) doubt("the search used up its evaluations");
    const double mm = glm::length(glm::dvec3(end.at[0], end.at[1], end.at[2])),
                 deg = glm::degrees(glm::length(glm::dvec3(end.at[3], end.at[4], end.at[5])) / result.motion.radius_mm);
    if (mm > settings.search_mm + kBasin_mm || deg > settings.search_deg + kBasin_deg)
      doubt("the search left its range around the start");
    if (settings.search_mm == 0 && settings.search_deg == 0)
      doubt(kNotSearched);
    else if (!confirmed)
      doubt("no second search found the same place");
    if (result.runner_up > kAmbiguous * result.similarity_after) doubt("another place is nearly as similar");
    if (end.value < kStandsOut * result.elsewhere) doubt("places far away are nearly as similar");
    if (settings.measure == Measure::mutual_information) return;
    if (!found.is_maximum) return doubt("the similarity has no maximum there");
    result.deviation = found.deviation;
    result.expected_error_mm = found.expected_error_mm;
  }

  LocalSearch search(double first_step, double tolerance, int most, std::size_t parameters = 6) const {
    const double mm = settings.search_mm + 20,
                 turn = (glm::radians(settings.search_deg) * result.motion.radius_mm) + 20,
                 stretch = kMaxStretch * result.motion.radius_mm;
    LocalSearch local;
    for (std::size_t i = 0; i < parameters; ++i) local.high.push_back(i < 3 ? mm : i < 6 ? turn : stretch);
    for (const double bound : local.high) local.low.push_back(-bound);
    local.first_step = first_step;
    local.tolerance = tolerance;
    local.most_evaluations = most;
    return local;
  }
};

}  // namespace

SweepRegistrar::SweepRegistrar(const AcousticVolume& volume, const TrackedSweep& sweep,
                               const RegistrationSettings& settings)
    : settings_(settings), targets_(target_points(sweep)) {
  const auto begin = std::chrono::steady_clock::now();
  wide_volume_ = coarse_volume(volume, kWideVoxel_mm);
  WeinSettings wide = settings.wein;
  wide.samples = kWideWidth;
  if (wide.similarity_patch > 0) wide.similarity_patch = kWidePatch;
  wide.reflection_length_mm = std::max(settings.wein.reflection_length_mm, kWideLength_mm);
  TrackedSweep small = reduced(sweep, settings.wide_slices, kWideWidth, kWideHeight);
  small.probe.lines = kWideWidth;
  wide_ = similarity_of(wide_volume_, small, wide, settings.measure);
  scatter_ = similarity_of(wide_volume_, scatter_images(small), wide, settings.measure);
  compared_ = fine_images(sweep, settings.slices);
  fine_ = similarity_of(volume, compared_, settings.wein, settings.measure);
  seconds_to_prepare_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void SweepRegistrar::set_images(std::span<const SweepImage> images) {
  const TrackedSweep sweep{Probe(compared_.probe), compared_.depth_mm, {images.begin(), images.end()}};
  TrackedSweep compared = fine_images(sweep, settings_.slices);
  const TrackedSweep small = reduced(sweep, settings_.wide_slices, kWideWidth, kWideHeight);
  wide_->set_images(small.images);
  scatter_->set_images(scatter_images(small).images);
  fine_->set_images(compared.images);
  compared_ = std::move(compared);
  targets_ = target_points(sweep);
}

void SweepRegistrar::set_range(double search_mm, double search_deg, int scattered) {
  settings_.search_mm = search_mm;
  settings_.search_deg = search_deg;
  settings_.scattered = scattered;
}

SweepRegistration SweepRegistrar::from(const glm::dmat4& start) {
  const auto begin = std::chrono::steady_clock::now();
  const RegistrationSettings& settings = settings_;
  SweepRegistration result;
  Run run{settings, targets_, moments_of(targets_), result, false};
  result.motion = motion_about(targets_, start);
  const Parameters none(6, 0.0);
  const EvaluateAll sift = run.evaluator(*scatter_, kScatter), scatter = run.evaluator(*wide_, kScatter),
                    follow = run.evaluator(*wide_, kWide), fine = run.evaluator(*fine_, kFine);
  result.similarity_before = fine({&none, 1}).front();

  // A single round may miss the basin of the truth. So rounds go on until one end stands out and two rounds have found
  // it.
  std::vector<Optimum> rough, ends;  // the best of all rounds' ends, and all of them
  std::vector<Parameters> found;     // the best end of each round
  const bool wanders = settings.search_mm > 0 || settings.search_deg > 0;
  for (int round = 0; round < settings.rounds; ++round) {
    std::vector<Parameters> starts;
    if (round == 0) starts.push_back(none);
    if (wanders)
      for (Parameters& each :
           scattered_motions(std::size_t(round * settings.scattered), std::size_t(settings.scattered),
                             settings.search_mm, glm::radians(settings.search_deg) * result.motion.radius_mm))
        starts.push_back(std::move(each));
    std::vector<Parameters> followed;
    for (const Optimum& each :
         run.distinct(run.sifted(std::move(starts), sift, scatter), std::size_t(settings.followed)))
      followed.push_back(each.at);
    std::vector<Parameters> promising;
    for (const Optimum& each : run.distinct(maximise_from(followed, follow, run.search(5, 0.5, 120)), kFineStarts))
      promising.push_back(each.at);
    // The small images of the stage before may lead away from a start that is right already.
    if (round == 0) promising.push_back(none);
    std::vector<Optimum> of_round = maximise_from(promising, fine, run.search(2, 0.5, 40));
    ends.insert(ends.end(), of_round.begin(), of_round.end());
    of_round = run.distinct(std::move(of_round), kFineStarts);
    found.push_back(of_round.front().at);
    for (Optimum& each : of_round) rough.push_back(std::move(each));
    rough = run.distinct(std::move(rough), kFineStarts);
    run.confirmed = std::ranges::count_if(found, [&](const Parameters& each) {
                      return run.apart(each, rough.front().at) < kBasin_mm;
                    }) >= 2;
    if (!wanders) break;
    if (run.confirmed && run.rival_of(rough.front(), ends, fine) < kAmbiguous * rough.front().value) break;
  }
  // A narrower search has looked there already.
  const bool is_wide = std::max(settings.search_mm, settings.search_deg) > kAround_mm;
  Optimum best = rough.front();
  if (is_wide) {
    const auto [half, other_half] = looking_images(compared_);
    best = run.look_around(best, {run.evaluator(*fine_, kLook, half), run.evaluator(*fine_, kLook, other_half)}, fine);
  }
  Optimum end = maximise_from({best.at}, fine, run.search(0.7, 0.01, 250)).front();
  EvaluateAll last = fine;
  const Optimum rigid_end = end;
  if (settings.freedom == Freedom::affine) {
    end.at.resize(parameters_of(Freedom::affine));
    last = run.evaluator(*fine_, kAffine);
    end = maximise_from({end.at}, last, run.search(0.7, 0.01, 600, end.at.size())).front();
  }
  const Uncertainty uncertainty = run.climb_on(end, last, compared_);
  // All ends are of rigid motions, so they are compared with one.
  result.runner_up = run.rival_of(settings.freedom == Freedom::rigid ? end : rigid_end, ends, fine);
  if (settings.measure == Measure::lc2) result.elsewhere = run.elsewhere(end, run.evaluator(*fine_, kElsewhere));
  result.at = end.at;
  result.similarity_after = end.value;
  result.ct_from_sweep = result.motion.at(result.at);
  run.judge(end, uncertainty, compared_);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace insonate
