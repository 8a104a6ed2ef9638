#include "devices/calibration/steps.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace insonate {
namespace {

/// Enough for a minute of the fastest tracker; keeps a forgotten step from filling the memory.
constexpr std::size_t kMostPoses = 60000;
constexpr double kLongestPivotS = 60;
constexpr double kPivotS = 10;

__attribute__((format(printf, 1, 2))) std::string words(const char* format, ...) {
  char text[300];
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

}  // namespace

// Axes

void AxesStep::mark(double) {
  if (!found_) waiting_ = true;
}

void AxesStep::take(const PoseSample& sample) {
  if (sample.status != PoseStatus::ok) return;
  newest_ = sample.patient_from_probe;
  if (!std::exchange(waiting_, false)) return;
  refusal_.clear();
  ends_.push_back(*newest_);
  const std::size_t count = ends_.size();
  if (count % 2 == 0 && glm::distance(ends_[count - 2].translation, ends_[count - 1].translation) < kLeastMoveMm) {
    refusal_ = "That was too short; begin this move again and move by 100 mm or more.";
    ends_.resize(count - 2);
  }
  if (count < 8) return;
  const auto move = [&](std::size_t i) { return StraightMove{ends_[2 * i], ends_[2 * i + 1]}; };
  const auto found = check_axes({move(0), move(1), move(2), move(3)});
  if (found) {
    found_ = *found;
  } else {
    refusal_ = found.refusal();
    ends_.clear();
  }
}

void AxesStep::undo() {
  refusal_.clear();
  waiting_ = false;
  if (found_) {
    found_.reset();
    ends_.clear();
  } else if (!ends_.empty()) {
    ends_.pop_back();
  }
}

SetupView AxesStep::view() const {
  static constexpr const char* kBegin[] = {
      "Hold the probe upright on the mannequin's belly, its marker to the patient's right. Mark.",
      "Hold it upright as before, marker to the right. Mark.",
      "Turn the probe, still upright, until its marker points to the head. Mark.",
      "Lay the probe over so that its marker points up, away from the table. Mark."};
  static constexpr const char* kEnd[] = {
      "Move it straight to the patient's right, a hand's length, without turning. Mark.",
      "Move it straight up, a hand's length, without turning. Mark.",
      "Move it straight to the head, a hand's length, without turning. Mark.",
      "Move it straight up, a hand's length, without turning. Mark."};
  SetupView view;
  view.title = "Which way is which";
  view.refusal = refusal_;
  view.done = found_.has_value();
  view.share = view.done ? 1 : double(ends_.size()) / 8;
  if (found_) {
    view.result = found_->signs.words() + words("; the moves agree to %.0f degrees", found_->misfit_deg);
    if (!found_->signs.none()) view.result += "; what is mirrored is put right from here on";
    return view;
  }
  const std::size_t move = ends_.size() / 2;
  view.reading = ends_.size() % 2 == 1;
  view.task = words("%zu of 4: ", move + 1) + (view.reading ? kEnd[move] : kBegin[move]);
  if (view.reading && newest_)
    view.feedback = words("%.0f mm from the beginning", glm::distance(ends_.back().translation, newest_->translation));
  return view;
}

void AxesStep::store(Calibration& calibration, std::int64_t now_s) const {
  const bool other = !calibration.axes || calibration.axes->value.signs.position != found_->signs.position ||
                     calibration.axes->value.signs.quaternion != found_->signs.quaternion;
  const bool had_signs = calibration.axes || !found_->signs.none();
  calibration.axes = Dated<AxesFinding>{*found_, now_s};
  if (!other || !had_signs) return;
  // What was measured with other axes is worth nothing.
  calibration.tip.reset();
  calibration.face.reset();
  calibration.mannequin.reset();
}

// Tip

void PivotStep::mark(double time_s) {
  if (found_) return;
  refusal_.clear();
  if (!reading_) {
    reading_ = true;
    poses_.clear();
    spread_deg_ = lasted_s_ = 0;
    began_s_ = told_s_ = time_s;
    return;
  }
  reading_ = false;
  if (const auto fit = fit_tip(poses_))
    found_ = *fit;
  else
    refusal_ = fit.refusal();
}

void PivotStep::take(const PoseSample& sample) {
  if (!reading_) return;
  lasted_s_ = std::max(0.0, sample.time_s - began_s_);
  if (sample.status == PoseStatus::ok) poses_.push_back(base_.tracker_from_sensor(sample.patient_from_probe));
  if (sample.time_s - told_s_ > 0.25) {
    told_s_ = sample.time_s;
    spread_deg_ = pivot_spread_deg(poses_);
  }
  const bool enough = lasted_s_ > kPivotS && spread_deg_ > 1.3 * kLeastPivotSpreadDeg;
  if (enough || poses_.size() >= kMostPoses || lasted_s_ > kLongestPivotS) mark(sample.time_s);
}

void PivotStep::undo() {
  reading_ = false;
  found_.reset();
  refusal_.clear();
}

SetupView PivotStep::view() const {
  SetupView view;
  view.title = "Probe tip";
  view.refusal = refusal_;
  view.reading = reading_;
  view.done = found_.has_value();
  if (found_) {
    view.share = 1;
    view.result = words("residual %.2f mm over %zu poses (%zu rejected); the tip is known to %.2f mm",
                        found_->residual_mm, found_->used, found_->rejected, found_->tip_sd_mm);
    return view;
  }
  view.task = reading_
                  ? "Keep the tip in the dimple. Tilt the probe by 30 degrees to all sides, and turn it about its "
                    "length."
                  : "Put the probe's pointed tip into a dimple that stands fast, away from metal. Mark, then pivot "
                    "for ten seconds.";
  if (!reading_) return view;
  view.share = std::min({1.0, lasted_s_ / kPivotS, spread_deg_ / (1.3 * kLeastPivotSpreadDeg)});
  view.feedback = words("%.0f s, %zu poses, turned by %.0f of %.0f degrees", lasted_s_, poses_.size(), spread_deg_,
                        1.3 * kLeastPivotSpreadDeg);
  return view;
}

void PivotStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.tip = Dated<TipFit>{*found_, now_s};
}

// Touching

void TouchingStep::mark(double time_s) {
  if (done_ || held_.reading()) return;
  refusal_.clear();
  held_.begin(time_s,
              [this, touch = points_.size()](const Pose& raw) { return point(touch, base_.tracker_from_sensor(raw)); });
}

void TouchingStep::take(const PoseSample& sample) {
  const auto read = held_.take(sample);
  if (!read) return;
  if (!*read) {
    refusal_ = read->refusal();
    return;
  }
  wander_mm_ = (*read)->wander_mm;
  points_.push_back((*read)->mean_mm);
  if (points_.size() < touches_) return;
  refusal_ = finish();
  done_ = refusal_.empty();
  if (!done_) points_.clear();
}

void TouchingStep::undo() {
  held_.stop();
  refusal_.clear();
  if (std::exchange(done_, false))
    points_.clear();
  else if (!points_.empty())
    points_.pop_back();
}

SetupView TouchingStep::view() const {
  SetupView view;
  view.title = title_;
  view.refusal = refusal_;
  view.reading = held_.reading();
  view.done = done_;
  view.share = double(points_.size()) / double(touches_);
  if (done_) {
    view.result = result();
    return view;
  }
  view.task = words("%zu of %zu: ", points_.size() + 1, touches_) + task(points_.size());
  if (view.reading)
    view.feedback = "Hold still.";
  else if (!points_.empty())
    view.feedback = words("Read; the hand and the tracker wandered by %.1f mm.", wander_mm_);
  return view;
}

std::string FaceStep::task(std::size_t touch) const {
  static constexpr const char* kTasks[] = {
      "Touch a sharp corner that stands fast with the probe's pointed tip. Mark, and hold still.",
      "Touch the same corner with the middle of the probe's face. Mark, and hold still.",
      "Touch it with the end of the face on the marker's side. Mark, and hold still.",
      "Touch it with the other end of the face. Mark, and hold still.",
      "Touch it with the probe's tail, where the cable leaves. Mark, and hold still."};
  return kTasks[touch];
}

glm::dvec3 FaceStep::point(std::size_t touch, const Pose& tracker_from_sensor) const {
  if (touch == 0) return tracker_from_sensor.point(base_.tip->value.tip_mm);
  return tracker_from_sensor.inverse().point(points_[0]);
}

std::string FaceStep::finish() {
  const auto fit = fit_face({points_[1], points_[2], points_[3], points_[4]});
  if (fit) found_ = *fit;
  return fit.refusal();
}

std::string FaceStep::result() const {
  return words("face and handle miss the right angle by %.1f degrees; the middle lies %.1f mm off the ends' middle",
               found_.skew_deg, found_.off_middle_mm);
}

void FaceStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.face = Dated<FaceSetup>{{found_, "touch", 0}, now_s};
}

std::string LandmarkStep::task(std::size_t touch) const {
  return "Touch " + pairs_[touch].name + " with the tip. Mark, and hold still.";
}

glm::dvec3 LandmarkStep::point(std::size_t, const Pose& tracker_from_sensor) const {
  return tracker_from_sensor.point(base_.tip->value.tip_mm);
}

std::string LandmarkStep::finish() {
  for (std::size_t i = 0; i < pairs_.size(); ++i) pairs_[i].touched_mm = points_[i];
  const auto found = register_landmarks(pairs_);
  if (found) found_ = *found;
  return found.refusal();
}

std::string LandmarkStep::result() const {
  return words(
      "accuracy %.1f mm, where the landmark that was held out should be; the others miss by %.1f mm, %s most "
      "(%.1f mm)",
      found_.accuracy_mm, found_.residual_mm, found_.worst.c_str(), found_.worst_mm);
}

void LandmarkStep::store(Calibration& calibration, std::int64_t now_s) const {
  MannequinSetup setup;
  if (moved_) {
    setup = base_.mannequin->value;
    setup.mannequin_from_tracker = found_.ct_from_touched;
  } else {
    setup.patient = patient_;
    setup.ct_from_mannequin = found_.ct_from_touched;
    setup.landmarks = pairs_;
  }
  setup.accuracy_mm = found_.accuracy_mm;
  setup.residual_mm = found_.residual_mm;
  setup.worst = found_.worst.empty() ? pairs_.front().name : found_.worst;
  setup.worst_mm = found_.worst_mm;
  calibration.mannequin = Dated<MannequinSetup>{setup, now_s};
}

DrawnFaceStep::DrawnFaceStep(const Calibration& base, const ProbeDrawing& drawing) : SetupStep(base) {
  const auto face = face_from_drawing(drawing, base.tip ? std::optional(base.tip->value) : std::nullopt);
  view_.title = "Probe face";
  view_.refusal = face.refusal();
  view_.done = bool(face);
  if (!face) return;
  found_ = *face;
  view_.share = 1;
  view_.result =
      "taken from the drawing of " + drawing.name +
      (found_.tip_off_mm > 0 ? words(", shifted by the %.1f mm that the tip lies elsewhere", found_.tip_off_mm)
                             : std::string());
}

void DrawnFaceStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.face = Dated<FaceSetup>{found_, now_s};
}

// Lag

void LagStep::mark(double time_s) {
  if (found_) return;
  refusal_.clear();
  blows_s_.push_back(time_s);
}

void LagStep::take(const PoseSample& sample) {
  if (found_) return;
  samples_.push_back(sample);
  const bool over = blows_s_.size() >= kBlows && sample.time_s > blows_s_.back() + kMostLagS + 0.5;
  if (!over && samples_.size() < kMostPoses) return;
  const auto found = knock_lag(samples_, blows_s_);
  if (found)
    found_ = *found;
  else
    refusal_ = found.refusal();
  samples_.clear();
  blows_s_.clear();
}

void LagStep::undo() {
  found_.reset();
  refusal_.clear();
  samples_.clear();
  blows_s_.clear();
}

SetupView LagStep::view() const {
  SetupView view;
  view.title = "Lag";
  view.refusal = refusal_;
  view.done = found_.has_value();
  view.share = found_ ? 1 : std::min(1.0, double(blows_s_.size()) / double(kBlows));
  if (found_) {
    view.result = words("the tracker lags by %.0f ms, single blows within %.0f ms of it", found_->lag_s * 1e3,
                        found_->spread_s * 1e3);
    return view;
  }
  view.task = words("Strike the key that marks with the probe itself, %zu times, with uneven pauses of a second or so.",
                    kBlows);
  view.feedback = words("%zu of %zu", blows_s_.size(), kBlows);
  return view;
}

void LagStep::store(Calibration& calibration, std::int64_t now_s) const {
  calibration.lag = Dated<KnockLag>{*found_, now_s};
}

}  // namespace insonate
