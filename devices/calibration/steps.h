#pragma once

#include <vector>

#include "devices/calibration/held_point.h"
#include "devices/calibration/setup_step.h"

// The steps that begin_setup_step() makes.

namespace insonate {

/// Four straight moves, each between two marks.
class AxesStep : public SetupStep {
public:
  explicit AxesStep(const Calibration& base) : SetupStep(base) {}
  void mark(double time_s) override;
  void undo() override;
  SetupView view() const override;
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void take(const PoseSample& sample) override;

private:
  std::vector<Pose> ends_;  ///< two a move, raw
  std::optional<Pose> newest_;
  bool waiting_ = false;  ///< for the pose of the last mark
  std::optional<AxesFinding> found_;
  std::string refusal_;
};

/// Pivoting between two marks.
class PivotStep : public SetupStep {
public:
  explicit PivotStep(const Calibration& base) : SetupStep(base) {}
  void mark(double time_s) override;
  void undo() override;
  SetupView view() const override;
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void take(const PoseSample& sample) override;

private:
  std::vector<Pose> poses_;
  double spread_deg_ = 0, began_s_ = 0, lasted_s_ = 0, told_s_ = 0;
  bool reading_ = false;
  std::optional<TipFit> found_;
  std::string refusal_;
};

/// A row of touches, each after a mark.
class TouchingStep : public SetupStep {
public:
  void mark(double time_s) override;
  void undo() override;
  SetupView view() const override;

protected:
  TouchingStep(const Calibration& base, std::string title, std::size_t touches)
      : SetupStep(base), title_(std::move(title)), touches_(touches) {}
  void take(const PoseSample& sample) override;

  /// What to touch, as a task.
  virtual std::string task(std::size_t touch) const = 0;
  /// The point that a pose says of a touch, mm.
  virtual glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const = 0;
  /// Why the touches cannot be used, or nothing when result() has what they say.
  virtual std::string finish() = 0;
  virtual std::string result() const = 0;

  std::vector<glm::dvec3> points_;

private:
  std::string title_;
  std::size_t touches_;
  HeldPoint held_;
  double wander_mm_ = 0;
  bool done_ = false;
  std::string refusal_;
};

/// A sharp corner that stands fast, touched with the tip and then with four places of the probe.
class FaceStep : public TouchingStep {
public:
  explicit FaceStep(const Calibration& base) : TouchingStep(base, "Probe face", 5) {}
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  std::string task(std::size_t touch) const override;
  glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const override;
  std::string finish() override;
  std::string result() const override;

private:
  FaceFit found_;
};

/// The mannequin's landmarks, touched with the tip.
class LandmarkStep : public TouchingStep {
public:
  LandmarkStep(const Calibration& base, const LandmarkList& list)
      : TouchingStep(base, "Landmarks", list.landmarks.size()), patient_(list.patient), pairs_(list.landmarks) {}
  /// The landmarks of the last time again: the base or the mannequin was moved.
  explicit LandmarkStep(const Calibration& base)
      : TouchingStep(base, "Landmarks, moved", base.mannequin->value.landmarks.size()),
        patient_(base.mannequin->value.patient),
        pairs_(base.mannequin->value.landmarks),
        moved_(true) {
    for (LandmarkPair& pair : pairs_) pair.ct_mm = pair.touched_mm;
  }
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  std::string task(std::size_t touch) const override;
  glm::dvec3 point(std::size_t touch, const Pose& tracker_from_sensor) const override;
  std::string finish() override;
  std::string result() const override;

private:
  std::string patient_;
  std::vector<LandmarkPair> pairs_;  ///< ct_mm holds what is fitted to: when moved, places in the mannequin's frame
  bool moved_ = false;
  Registration found_;
};

/// The face from its drawing: nothing to do.
class DrawnFaceStep : public SetupStep {
public:
  DrawnFaceStep(const Calibration& base, const ProbeDrawing& drawing);
  void mark(double) override {}
  void undo() override {}
  SetupView view() const override { return view_; }
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void take(const PoseSample&) override {}

private:
  FaceSetup found_;
  SetupView view_;
};

/// Blows on a key.
class LagStep : public SetupStep {
public:
  static constexpr std::size_t kBlows = 10;

  explicit LagStep(const Calibration& base) : SetupStep(base) {}
  void mark(double time_s) override;
  void undo() override;
  SetupView view() const override;
  void store(Calibration& calibration, std::int64_t now_s) const override;

protected:
  void take(const PoseSample& sample) override;

private:
  std::vector<PoseSample> samples_;
  std::vector<double> blows_s_;
  std::optional<KnockLag> found_;
  std::string refusal_;
};

}  // namespace insonate
