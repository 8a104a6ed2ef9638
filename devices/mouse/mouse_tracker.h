#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <optional>

#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A probe that the user moves with the mouse and the keyboard. The window pushes motions in the probe's own frame (+x
/// towards the marker, +y along the beam, +z elevation; it rotates about the middle of its face). Samples come at a
/// steady 60 Hz from the first poll on, as from a device.
///
/// Motions since the last poll are spread evenly over the samples that the poll returns. So the motion stays smooth if
/// the window draws at another rate.
class MouseTracker : public Tracker {
public:
  static constexpr double kRate_hz = 60.0;

  explicit MouseTracker(const Pose& patient_from_probe);

  /// Moves the probe by `mm` and rotates it by the rotation vector `rad` (axis times angle). Calls add up until the
  /// next poll.
  void move(const glm::dvec3& mm, const glm::dvec3& rad);

  /// Moves the probe at these rates until others are set.
  void move_steadily(const glm::dvec3& mm_per_s, const glm::dvec3& rad_per_s);

  /// Puts the probe at a pose and discards pending motions, to continue from another tracker or to return to a view.
  void place(const Pose& patient_from_probe);

  /// Bit b is set while button b is held.
  void hold_buttons(std::uint32_t buttons) { buttons_ = buttons; }

  Pose pose() const;
  MouseTracker* steered() override { return this; }

  double clock_s(double now_s) const override { return start_s_ ? now_s - *start_s_ : 0.0; }

protected:
  void collect(double now_s, std::vector<ProbeSample>& samples) override;

private:
  glm::dquat rotation_;  ///< a quaternion, because a matrix would drift from orthonormal over many small rotations
  glm::dvec3 translation_;
  glm::dvec3 pending_mm_{0}, pending_rad_{0};
  glm::dvec3 mm_per_s_{0}, rad_per_s_{0};
  std::uint32_t buttons_ = 0;
  std::uint64_t next_ = 0;  ///< index of the next sample
  std::optional<double> start_s_;
};

/// Opens mouse:, which takes no options and begins at the context's start. Throws InputError.
std::unique_ptr<Tracker> open_mouse(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
