// insonate-devices bench: measures the effect of the filters, lost samples, and the age of a frame's pose.

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/filter/filter_figures.h"
#include "devices/latency_histogram.h"
#include "devices/live/live_tracker.h"
#include "devices/live/paced_source.h"
#include "devices/live/steady_clock.h"
#include "devices/pose_history.h"
#include "sim/files/files.h"
#include "tools/devices/commands.h"

namespace insonate::devices {
namespace {

constexpr double kFrame_hz = 60;

/// Prints the figures while they are measured, and collects them as CSV.
class Figures {
public:
  void heading(const char* text) { std::printf("%s\n", text); }
  void add(const char* measure, const std::string& setting, const char* figure, double value, const char* unit) {
    const char* const format = value < 1e4 ? "  %-28s %-26s %10.4g %s\n" : "  %-28s %-26s %10.0f %s\n";
    std::printf(format, setting.c_str(), figure, value, unit);
    std::fflush(stdout);
    char number[40];
    std::snprintf(number, sizeof number, "%.6g", value);
    csv_ += std::string(measure) + "," + setting + "," + figure + "," + number + "," + unit + "\n";
  }
  const std::string& csv() const { return csv_; }

private:
  std::string csv_ = "measure,setting,figure,value,unit\n";
};

std::string hertz(double rate_hz) {
  return std::to_string(int(rate_hz)) + " Hz";
}

void bench_filters(Figures& figures) {
  FilterSettings smooth, reject;
  smooth.one_euro = true;
  reject.outlier = true;
  figures.heading("1-euro filter: a sensor with 0.10 mm of noise, at rest and swept at 100 mm/s");
  for (const double rate_hz : {60.0, 120.0, 240.0, 1000.0}) {
    const SmoothingFigures measured = measure_smoothing(smooth, rate_hz);
    figures.add("smoothing", hertz(rate_hz), "noise before", measured.rest_before_mm, "mm");
    figures.add("smoothing", hertz(rate_hz), "noise after", measured.rest_after_mm, "mm");
    figures.add("smoothing", hertz(rate_hz), "lag", measured.lag_s * 1e3, "ms");
  }
  figures.heading("Prediction: a hand at 90 mm/s, 0.10 mm of noise, samples at 60 Hz; capped at 30 ms");
  for (const double ahead_ms : {10.0, 20.0, 30.0, 50.0}) {
    const PredictionFigures measured = measure_prediction(60, ahead_ms * 1e-3);
    const std::string setting = std::to_string(int(ahead_ms)) + " ms ahead";
    figures.add("prediction", setting, "newest sample is off", measured.held_mm, "mm");
    figures.add("prediction", setting, "prediction is off", measured.predicted_mm, "mm");
  }
  figures.heading("Outliers: 2 % strays from 30 to 500 mm, 0.8 s of the other hemisphere every 5 s");
  for (const double rate_hz : {60.0, 240.0}) {
    const RejectionFigures measured = measure_rejection(reject, rate_hz);
    const auto percent = [](std::size_t part, std::size_t all) { return 100.0 * double(part) / double(all); };
    figures.add("rejection", hertz(rate_hz), "strays rejected", percent(measured.strays_rejected, measured.strays),
                "%");
    figures.add("rejection", hertz(rate_hz), "mirrored rejected",
                percent(measured.mirrored_rejected, measured.mirrored), "%");
    figures.add("rejection", hertz(rate_hz), "others rejected", percent(measured.good_rejected, measured.good), "%");
  }
  figures.heading(
      "Distortion: a hand that passes steel, which draws the readings by up to 100 mm; a grade a millimetre");
  for (const std::uint32_t limit : {50u, 20u, 5u}) {
    const DistortionFigures measured = measure_distortion(limit);
    const std::string setting = "limit " + std::to_string(limit);
    figures.add("distortion", setting, "worst before", measured.worst_before_mm, "mm");
    figures.add("distortion", setting, "worst after", measured.worst_after_mm, "mm");
    figures.add("distortion", setting, "RMS before", measured.rms_before_mm, "mm");
    figures.add("distortion", setting, "RMS after", measured.rms_after_mm, "mm");
    figures.add("distortion", setting, "rejected", 100 * measured.rejected, "%");
  }
}

std::unique_ptr<LiveTracker> paced_tracker(double rate_hz) {
  // The buttons carry the sample's number, so that a lost sample is detected.
  return std::make_unique<LiveTracker>(std::make_unique<PacedSource>(
      "bench",
      [](std::uint64_t index) {
        return ProbeSample{0, PoseStatus::ok, Pose{}, std::uint32_t(index)};
      },
      rate_hz));
}

/// Calls `frame` with the time at 60 Hz, for `seconds`.
template <typename Frame>
void run_frames(double seconds, const Frame& frame) {
  const double start_s = steady_now_s();
  for (long i = 0; i < seconds * kFrame_hz; ++i) {
    const double wait_s = start_s + double(i) / kFrame_hz - steady_now_s();
    if (wait_s > 0) std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    frame(steady_now_s());
  }
}

void bench_throughput(Figures& figures, double seconds) {
  constexpr int kSensors = 8;
  constexpr double kRate_hz = 1000;
  figures.heading("Eight live trackers at 1000 Hz, each on its own thread, polled at 60 Hz");
  std::vector<std::unique_ptr<LiveTracker>> trackers;
  for (int i = 0; i < kSensors; ++i) trackers.push_back(paced_tracker(kRate_hz));
  std::vector<std::uint64_t> expected(kSensors, 0);
  std::uint64_t delivered = 0, lost = 0;
  std::vector<ProbeSample> samples;
  run_frames(seconds, [&](double now_s) {
    for (std::size_t i = 0; i < trackers.size(); ++i) {
      samples.clear();
      trackers[i]->poll(now_s, samples);
      for (const ProbeSample& sample : samples) {
        if (sample.status != PoseStatus::ok) continue;  // a silent tracker delivers a sample without a pose
        lost += sample.buttons - expected[i];
        expected[i] = sample.buttons + 1;
        ++delivered;
      }
    }
  });
  figures.add("throughput", "8 x 1000 Hz", "samples delivered", double(delivered), "");
  figures.add("throughput", "8 x 1000 Hz", "samples lost", double(lost), "");
}

LatencyHistogram measure_latency(double rate_hz, double seconds) {
  const auto tracker = paced_tracker(rate_hz);
  PoseHistory history;
  LatencyHistogram ages;
  std::vector<ProbeSample> samples;
  run_frames(seconds, [&](double now_s) {
    samples.clear();
    tracker->poll(now_s, samples);
    for (const ProbeSample& sample : samples) history.add(sample);
    const PoseEstimate estimate = history.at(now_s);
    if (estimate.how != PoseAnswer::none) ages.add(estimate.age_s);
  });
  return ages;
}

std::string bench_latency(Figures& figures, double seconds) {
  std::vector<std::string> names;
  std::vector<LatencyHistogram> histograms;
  for (const double rate_hz : {60.0, 240.0, 1000.0}) {
    figures.heading(
        ("From a report to the frame that uses it, reports at " + hertz(rate_hz) + ", frames at 60 Hz").c_str());
    const LatencyHistogram ages = measure_latency(rate_hz, seconds);
    std::printf("%s", ages.text().c_str());
    for (const auto& [figure, share] : {std::pair{"median", 0.5}, {"95 % below", 0.95}, {"99 % below", 0.99}})
      figures.add("latency", hertz(rate_hz), figure, ages.quantile_s(share) * 1e3, "ms");
    names.push_back("reports_" + std::to_string(int(rate_hz)) + "_hz");
    histograms.push_back(ages);
  }
  return to_csv(names, histograms);
}

}  // namespace

Command bench_command(CLI::App& program) {
  struct Request {
    double seconds = 10;
    std::string csv, histogram;
  };
  const auto request = std::make_shared<Request>();
  CLI::App* parser = program.add_subcommand("bench", "Measure the effect of the filters, lost samples and latency");
  parser->add_option("--seconds", request->seconds, "Set the length of each measurement in real time, seconds")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
  parser->add_option("--csv", request->csv, "Write the figures to this file (CSV)")->type_name("FILE");
  parser->add_option("--histogram", request->histogram, "Write a histogram of the latency to this file (CSV)")
      ->type_name("FILE");
  return {parser, [request] {
            Figures figures;
            bench_filters(figures);
            bench_throughput(figures, request->seconds);
            const std::string histogram = bench_latency(figures, request->seconds);
            if (!request->csv.empty()) write_file(request->csv, figures.csv());
            if (!request->histogram.empty()) write_file(request->histogram, histogram);
            return 0;
          }};
}

}  // namespace insonate::devices
