// What the filters do to samples, in numbers.
#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "devices/filter/filter_figures.h"
#include "devices/pose_history.h"
#include "sim/core/input_error.h"

using namespace insonate;

namespace {

std::vector<ProbeSample> filtered(std::vector<ProbeSample> samples, const FilterSettings& settings) {
  SampleFilters filters(settings);
  for (ProbeSample& sample : samples) filters.apply(sample, glm::dvec3(0));
  return samples;
}

FilterSettings only(bool FilterSettings::*filter) {
  FilterSettings settings;
  settings.*filter = true;
  return settings;
}

ProbeSample at(double time_s, const glm::dvec3& mm, const glm::dmat3& rotation = glm::dmat3(1)) {
  return {time_s, PoseStatus::ok, Pose{rotation, mm}};
}

glm::dmat3 turned(double deg) {
  return glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(deg), glm::dvec3(0, 0, 1)));
}

/// A hand that goes at 200 mm/s, at 100 Hz for a second, far from the tracker's origin.
std::vector<ProbeSample> straight() {
  std::vector<ProbeSample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back(at(i / 100.0, {300 + 2 * i, 50, -80}));
  return samples;
}

std::vector<int> rejected(const std::vector<ProbeSample>& samples, const FilterSettings& settings) {
  std::vector<int> indices;
  const auto out = filtered(samples, settings);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (samples[i].status == PoseStatus::ok && out[i].status != PoseStatus::ok) indices.push_back(int(i));
  return indices;
}

}  // namespace

TEST_CASE("the 1-euro filter calms a probe at rest and lags one that moves by a few milliseconds") {
  struct Expected {
    double rate_hz, left_mm, lag_s;
  };
  // The RMS of half a minute of noise is known to a few per cent. The lag is one of a motion whose speed changes, and
  // read off in steps of a quarter of a millisecond.
  for (const Expected& expected : {Expected{60, 0.031, 0.011}, Expected{240, 0.018, 0.007}}) {
    const SmoothingFigures raw = measure_smoothing(FilterSettings(), expected.rate_hz);
    const SmoothingFigures smoothed = measure_smoothing(only(&FilterSettings::one_euro), expected.rate_hz);
    CAPTURE(expected.rate_hz, smoothed.rest_after_mm, smoothed.lag_s);
    CHECK(raw.rest_before_mm == Approx(0.1).epsilon(0.03));
    CHECK(raw.rest_after_mm == raw.rest_before_mm);
    CHECK(raw.lag_s == 0);
    CHECK(smoothed.rest_after_mm == Approx(expected.left_mm).epsilon(0.06));
    CHECK(smoothed.lag_s == Approx(expected.lag_s).margin(0.001));
  }
}

TEST_CASE("a prediction is nearer to the probe than the newest sample, up to its cap") {
  // What the fit of 13 samples leaves at 60 Hz, with as much again for another hand's way.
  for (const auto& [ahead_s, left_mm] : {std::pair{0.010, 0.3}, {0.020, 0.5}, {0.030, 0.9}}) {
    const PredictionFigures figures = measure_prediction(60, ahead_s);
    CAPTURE(ahead_s, figures.held_mm, figures.predicted_mm);
    CHECK(figures.held_mm == Approx(90 * ahead_s).epsilon(0.15));
    CHECK(figures.predicted_mm < left_mm);
  }
  const PredictionFigures capped = measure_prediction(60, 0.2);
  CHECK(capped.predicted_mm > measure_prediction(60, 0.2 - PoseHistory::kPredict_s).held_mm * 0.8);
}

TEST_CASE("of a hand's samples nearly none are rejected, of strays and mirrored ones nearly all") {
  for (const double rate_hz : {60.0, 240.0}) {
    const RejectionFigures figures = measure_rejection(only(&FilterSettings::outlier), rate_hz);
    CAPTURE(rate_hz, figures.good, figures.good_rejected, figures.strays, figures.strays_rejected, figures.mirrored,
            figures.mirrored_rejected);
    CHECK(figures.strays > 10);
    CHECK(figures.mirrored > 200);
    CHECK(figures.good_rejected == 0);
    // At 60 Hz a stray of 30 mm may be no farther than 1 m/s takes a hand behind another rejected one.
    CHECK(figures.strays_rejected >= figures.strays * 95 / 100);
    CHECK(figures.mirrored_rejected == figures.mirrored);
  }
  const RejectionFigures off = measure_rejection(FilterSettings(), 60);
  CHECK(off.strays_rejected + off.mirrored_rejected + off.good_rejected == 0);
}

TEST_CASE("the 1-euro filter calms and follows turns too, through half a turn and more") {
  std::mt19937 generator(2);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<ProbeSample> samples;
  for (int i = 0; i < 2000; ++i) samples.push_back(at(i / 100.0, {}, turned(noise(generator))));
  double before = 0, after = 0;
  const auto calmed = filtered(samples, only(&FilterSettings::one_euro));
  for (std::size_t i = 100; i < samples.size(); ++i) {
    before += std::pow(angle_between_deg(samples[i].patient_from_probe, Pose{}), 2);
    after += std::pow(angle_between_deg(calmed[i].patient_from_probe, Pose{}), 2);
  }
  // A low pass at 1.5 Hz leaves about sqrt(pi 1.5 / 100) = 0.22 of white noise at 100 Hz, one at twice that 0.31: the
  // noise is a motion too, which raises the cut-off a little.
  CHECK(std::sqrt(after / before) > 0.20);
  CHECK(std::sqrt(after / before) < 0.31);

  samples.clear();
  for (int i = 0; i < 800; ++i) samples.push_back(at(i / 100.0, {}, turned(90 * i / 100.0)));
  const auto followed = filtered(samples, only(&FilterSettings::one_euro));
  // Steady at v = 90 degrees/s the way d from the last output to the next sample settles where d = v dt + (1 - a) d
  // with the share a of a cut-off of 1.5 + 10 d/dt Hz; (1 - a) d = 0.538 degrees are left.
  for (std::size_t i = 200; i < samples.size(); ++i)
    CHECK(angle_between_deg(followed[i].patient_from_probe, samples[i].patient_from_probe) ==
          Approx(0.538).epsilon(0.005));
}

TEST_CASE("the 1-euro filter begins anew behind a gap") {
  OneEuroFilter filter;
  filter.smooth(0, {});
  const Pose there{turned(30), {200, 0, 0}};
  CHECK(filter.smooth(0.05, there).translation.x < 200);
  const Pose later{turned(60), {-100, 5, 0}};
  CHECK(filter.smooth(0.05 + OneEuroFilter::kRestart_s + 0.001, later) == later);
}

TEST_CASE("samples that no hand has made are rejected, and those around them kept") {
  const auto settings = only(&FilterSettings::outlier);
  CHECK(rejected(straight(), settings).empty());
  auto samples = straight();
  samples[20].patient_from_probe.translation.y += 25;
  samples[50].patient_from_probe.translation = {};
  samples[51].patient_from_probe.translation = {0, 900, 0};
  samples[70].patient_from_probe.rotation = turned(40);
  CHECK(rejected(samples, settings) == std::vector<int>{20, 50, 51, 70});
  CHECK(rejected(samples, FilterSettings()).empty());

  const auto out = filtered(samples, settings);
  CHECK(out[20].status == PoseStatus::invalid);
  CHECK(out[20].patient_from_probe == Pose{});
  CHECK(out[21].patient_from_probe == samples[21].patient_from_probe);
}

TEST_CASE("noise at a high rate, a quick hand and a dropout are not outliers") {
  const auto settings = only(&FilterSettings::outlier);
  CHECK(measure_rejection(settings, 1000).good_rejected == 0);
  // 800 mm/s there and back within a second: more than a scanning hand does.
  std::vector<ProbeSample> quick;
  for (int i = 0; i < 300; ++i) quick.push_back(at(i / 60.0, {127 * std::sin(6.28 * i / 60), 0, 0}));
  CHECK(rejected(quick, settings).empty());
  auto lost = straight();
  for (int i = 30; i < 60; ++i) lost[std::size_t(i)].status = PoseStatus::missing;
  CHECK(rejected(lost, settings).empty());
}

TEST_CASE("a probe that is elsewhere for good is believed after a tenth of a second") {
  auto samples = straight();
  for (std::size_t i = 40; i < samples.size(); ++i) samples[i].patient_from_probe.translation += glm::dvec3(0, 150, 0);
  const std::vector<int> first = rejected(samples, only(&FilterSettings::outlier));
  REQUIRE(!first.empty());
  CHECK(first.front() == 40);
  // The tenth of a second is over with sample 50, or with the next where rounding leaves a trifle.
  CHECK(first.back() == 50);
  CHECK(first.size() == 11);
}

TEST_CASE("a jump to the mirrored hemisphere is rejected for as long as it lasts") {
  const auto mirrored = [](std::vector<ProbeSample> samples, std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) samples[i].patient_from_probe.translation *= -1;
    return samples;
  };
  const auto settings = only(&FilterSettings::outlier);
  std::vector<int> lasting = rejected(mirrored(straight(), 40, 90), settings);
  CHECK(lasting.size() == 50);
  CHECK(lasting.front() == 40);
  CHECK(lasting.back() == 89);

  INFO("also when it comes out of a dropout");
  auto lost = mirrored(straight(), 30, 100);
  for (std::size_t i = 30; i < 45; ++i) lost[i].status = PoseStatus::out_of_volume;
  CHECK(rejected(lost, settings).size() == 55);

  INFO("and a probe that passes close by the origin is nothing of the kind");
  std::vector<ProbeSample> passing;
  for (int i = 0; i < 100; ++i) passing.push_back(at(i / 100.0, {-100 + 2 * i, 0.5, 0}));
  CHECK(rejected(passing, settings).empty());
}

TEST_CASE("the mirror image is one through the tracker's origin, wherever that lies") {
  const glm::dvec3 origin(40, -500, 900);
  OutlierGate gate, elsewhere, not_magnetic;
  int kept = 0, believed = 0, believed_without = 0;
  for (const ProbeSample& sample : straight()) {
    Pose pose = sample.patient_from_probe;
    if (sample.time_s > 0.3) pose.translation = 2.0 * origin - pose.translation;
    kept += gate.accepts(sample.time_s, pose, origin);
    believed += elsewhere.accepts(sample.time_s, pose, glm::dvec3(0));
    believed_without += not_magnetic.accepts(sample.time_s, pose);
  }
  CHECK(kept == 31);
  CHECK(believed > 80);
  CHECK(believed_without == believed);
}

TEST_CASE("a rejected sample says why, and those that pass say nothing") {
  SampleFilters filters(FilterSettings::usual());
  const glm::dvec3 origin(0);
  for (const ProbeSample& sample : straight()) {
    ProbeSample seen = sample;
    if (sample.time_s > 0.50 && sample.time_s < 0.55) seen.patient_from_probe.translation.y += 80;
    if (sample.time_s > 0.75) seen.patient_from_probe.translation *= -1.0;
    const bool jumps = seen.patient_from_probe.translation.y > 60, mirrored = sample.time_s > 0.75;
    filters.apply(seen, origin);
    CAPTURE(sample.time_s);
    CHECK(seen.rejected == (mirrored ? Rejection::mirror : jumps ? Rejection::jump : Rejection::none));
    CHECK((seen.status == PoseStatus::invalid) == (seen.rejected != Rejection::none));
  }
}

TEST_CASE("samples that were read in one go are not quicker for it") {
  OutlierGate gate;
  for (int i = 0; i < 200; ++i) {
    const double time_s = i / 2 / 50.0 + (i % 2) * 1e-9;
    CHECK(gate.accepts(time_s, Pose{glm::dmat3(1), {i * 1.0 + (i % 3), 0, 300}}));
  }
}

TEST_CASE("a live tracker's filters are chosen by its option: all, none, or as named") {
  const auto taken = [](const std::string& text) {
    TrackerUri uri = parse_tracker_uri(text);
    const FilterSettings settings = take_filter_options(uri);
    CHECK_FALSE(uri.options.contains("filter"));
    CHECK(uri.options.size() == (text.find("rate") != text.npos ? 1 : 0));
    return to_string(settings);
  };
  CHECK(taken("hydra:") == "1euro,outlier");
  CHECK(taken("hydra:?filter=off") == "off");
  for (const auto& [text, names] : {std::pair{"hydra:?raw=1", "off"}, {"hydra:?raw=0", "1euro,outlier"}}) {
    TrackerUri uri = parse_tracker_uri(text);
    CHECK(to_string(take_filter_options(uri)) == names);
  }
  CHECK(taken("hydra:?filter=outlier,1euro&rate=3") == "1euro,outlier");
  CHECK(taken("hydra:?distortion=20") == "1euro,outlier,distortion");
  CHECK(taken("hydra:?distortion=20&filter=1euro") == "1euro");
  CHECK(taken("hydra:?distortion=20&filter=distortion") == "distortion");
  for (const char* wrong : {"a:?filter=1eurp", "a:?filter=off,1euro", "a:?filter=1euro,", "a:?filter=distortion",
                            "a:?distortion=2.5", "a:?distortion=-1", "a:?distortion=x"}) {
    CAPTURE(wrong);
    TrackerUri uri = parse_tracker_uri(wrong);
    CHECK_THROWS_AS(take_filter_options(uri), InputError);
  }
  TrackerUri typo = parse_tracker_uri("a:?filter=outlyer");
  CHECK_THROWS_WITH(take_filter_options(typo), Catch::Contains("did you mean 'outlier'?"));
}

TEST_CASE(
    "what the tracker grades worse than the limit is rejected with its grade kept, and what it does not grade passes") {
  SampleFilters filters({.distortion = true, .most_distortion = 20});
  ProbeSample sample{1, PoseStatus::ok, Pose{glm::dmat3(1), {1, 2, 3}}, 5, 20};
  filters.apply(sample);
  CHECK(sample.status == PoseStatus::ok);
  sample.distortion = 21;
  filters.apply(sample);
  CHECK(sample.status == PoseStatus::invalid);
  CHECK(sample.patient_from_probe == Pose{});
  CHECK(sample.rejected == Rejection::distortion);
  CHECK(sample.distortion == 21u);
  CHECK(sample.buttons == 5);
  ProbeSample ungraded{2, PoseStatus::ok, Pose{glm::dmat3(1), {1, 2, 3}}, 0, {}};
  filters.apply(ungraded);
  CHECK(ungraded.status == PoseStatus::ok);
  ProbeSample bent{3, PoseStatus::ok, Pose{}, 0, 200};
  SampleFilters(FilterSettings::usual()).apply(bent);
  CHECK(bent.status == PoseStatus::ok);
}

TEST_CASE("beside steel the distortion gate leaves out what is far off, and the more the lower its limit") {
  const DistortionFigures none = measure_distortion(1000), wide = measure_distortion(20),
                          narrow = measure_distortion(5);
  CHECK(none.rejected == 0);
  CHECK(none.worst_after_mm == none.worst_before_mm);
  CHECK(none.worst_before_mm > 50);
  // A grade is the error times 0.75 to 1.25, cut to a whole number.
  CHECK(wide.worst_after_mm < 21 / 0.75);
  CHECK(narrow.worst_after_mm < 6 / 0.75);
  CHECK(narrow.rms_after_mm < wide.rms_after_mm);
  CHECK(wide.rms_after_mm < none.rms_after_mm);
  CHECK(wide.rejected > 0);
  CHECK(narrow.rejected > wide.rejected);
  CHECK(narrow.rejected < 0.5);
}
