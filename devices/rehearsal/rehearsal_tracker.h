#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/calibration/steps/setup_step.h"
#include "devices/live/placement.h"
#include "devices/synthetic/synthetic_tracker.h"
#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A made-up lab in which a person rehearses the set-up without a tracker: a tracker's base, a probe with a sensor and
/// a pointed tip, a dimple, a corner, and a mannequin that is a copy of the patient. A made-up hand holds the probe. It
/// does what each step of the set-up asks for; the person sets the marks. It touches a landmark to within 1.5 mm along
/// each axis, the corner to within 0.2 mm, and the tracker's noise is within 0.15 mm.
///
/// Until a set-up is followed, the hand scans as that of a SyntheticTracker, at 60 Hz in real time.
class RehearsalTracker : public Tracker {
public:
  static constexpr double kRate_hz = 60;
  /// Time that the hand takes from one place to the next.
  static constexpr double kReach_s = 1.2;
  /// Time that the probe takes to fall on the key, in the step lag. The lag that is found is longer by the time from
  /// the mark to the sample after the next follow().
  static constexpr double kFall_s = 0.08;

  /// @param raw  true: return the sensor's pose in the tracker's frame; false: place the probe by its first pose
  RehearsalTracker(const TrackerContext& body, bool raw);

  RehearsalTracker* rehearsed() override { return this; }
  bool live() const override { return true; }
  double clock_s(double now_s) const override { return start_s_ ? now_s - *start_s_ : 0.0; }

  /// Tells the hand what the set-up asks for now. Call it during a set-up whenever the step has taken the samples of a
  /// poll. What the hand does about it shows from the next sample on.
  /// @param step  of kSetupSteps
  void follow(std::string_view step, const SetupView& view);
  /// Returns whether the hand holds still where the step wants it.
  bool is_there() const;
  /// Returns what the hand does, in a sentence for the person who marks; empty before a set-up is followed.
  std::string doing() const;

  /// Returns the pose that a set-up should find for a sensor's pose in the tracker's frame. For tests.
  static Pose patient_from_probe(const Pose& tracker_from_sensor);

protected:
  void collect(double now_s, std::vector<ProbeSample>& samples) override;

private:
  /// What the step asks for: a place to hold the probe, pivoting, or a blow.
  struct Task {
    std::string step;
    std::size_t part = 0;
    bool reading = false, done = false;
    std::optional<glm::dvec3> landmark_mm;
    bool operator==(const Task&) const = default;
  };

  Pose wanted() const;                ///< where the task wants the probe: patient_from_probe
  Pose pose_at(double time_s) const;  ///< patient_from_probe, as the hand holds it
  double time_s() const { return double(next_) / kRate_hz; }

  TrackerContext body_;
  Placement placement_;
  SyntheticTracker scanning_;
  std::optional<Task> task_;
  Pose last_seen_;                  ///< where the scanning hand was when a set-up began
  Pose from_, to_;                  ///< of the hand's last move
  double moved_s_ = 0;              ///< when that move began
  double began_s_ = 0;              ///< when the task came
  double from_height_mm_ = 0;       ///< of the probe above the key when it began to fall
  std::optional<double> struck_s_;  ///< when the last blow was asked for
  std::uint32_t next_ = 0;          ///< index of the next sample
  std::optional<double> start_s_;
  std::vector<ProbeSample> polled_;  ///< kept to reuse its memory
};

/// Opens rehearsal:[?raw=1]. Throws InputError.
std::unique_ptr<Tracker> open_rehearsal(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
