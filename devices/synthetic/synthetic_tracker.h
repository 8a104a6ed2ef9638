#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A synthetic hand that scans the front of the abdomen. It glides over the skin and fans on the spot in smooth moves
/// with pauses between, trembles, and loses the tracker now and then.
///
/// Sample i depends on seed, rate, body and i alone, so the rhythm of polling does not change the samples. The skin is
/// approximated by the ellipse that fits the body's bounding box.
class SyntheticTracker : public Tracker {
public:
  /// Throws std::invalid_argument if the body's bounding box is empty.
  SyntheticTracker(std::uint32_t seed, double rate_hz, const TrackerContext& body);

  double clock_s(double now_s) const override { return start_s_ ? now_s - *start_s_ : 0.0; }

protected:
  void collect(double now_s, std::vector<ProbeSample>& samples) override;

private:
  /// How the probe is held to the skin.
  struct Contact {
    double around = 0;  ///< rad about the body's long axis; 0 is the middle of the front, positive to the left
    double along = 0;   ///< from 0 at the feet's end of the body to 1 at the head's
    double roll = 0;    ///< rad about the beam; 0 is transverse with the marker to the patient's right
    double tilt = 0;    ///< rad about the lateral axis (fanning)
    double rock = 0;    ///< rad about the elevation axis
  };
  struct Move {
    std::uint32_t number = 0;
    double begin_s = 0;
    double duration_s = 1;
    double pause_s = 0;  ///< after the move
    Contact from, to;
  };

  double random(std::uint32_t purpose, std::uint32_t number) const;  ///< from 0 to 1
  Move move_after(const Move& before) const;
  Contact contact_at(double time_s);
  Pose pose_at(const Contact& contact) const;
  Pose trembling(const Pose& pose, std::uint32_t index, double time_s) const;
  PoseStatus status_at(double time_s) const;

  std::uint32_t seed_;
  double rate_hz_;
  TrackerContext body_;
  Move move_;
  std::uint32_t next_ = 0;  ///< index of the next sample
  std::optional<double> start_s_;
};

/// Opens synthetic:[SEED][?rate=60&live=1]. The seed is a whole number (1 by default), the rate is 1 to 1000 Hz. With
/// live=1 it returns a LiveTracker that delivers the same samples in real time, stamped as they come. Throws
/// InputError.
std::unique_ptr<Tracker> open_synthetic(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
