#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <span>

#include "app/panels/widgets/widgets.h"
#include "app/session/session.h"
#include "sim/core/pose.h"
#include "sim/view/body/orbit_camera.h"

namespace insonate::ui {

/// Draws lines and planes of the patient's space over the 3D view of a panel. Nothing hides them.
class SpaceDrawing {
public:
  SpaceDrawing(const Rect& panel, const view::OrbitCamera& camera);
  ~SpaceDrawing();
  SpaceDrawing(const SpaceDrawing&) = delete;
  SpaceDrawing& operator=(const SpaceDrawing&) = delete;

  /// Draws a line through points of the patient, mm. It is interrupted where a point lies behind the camera.
  void path(std::span<const glm::dvec3> points, ImU32 colour, float thickness) const;
  /// Draws the edge of the sector that a probe shows from a pose.
  void fan_edge(const Pose& patient_from_probe, const Probe& probe, double depth_mm, ImU32 colour,
                float thickness) const;
  /// Returns where a point of the patient, mm, is on the screen; empty for points behind the camera or out of the
  /// panel.
  std::optional<ImVec2> seen(const glm::dvec3& patient_mm) const;
  /// Draws the sector that a probe shows from a pose, as a translucent sheet with an edge.
  void fan(const Pose& patient_from_probe, const Probe& probe, double depth_mm, ImU32 edge, ImU32 glass) const;

private:
  bool in_front(const glm::dvec3& patient_mm) const;
  ImVec2 at(const glm::dvec3& patient_mm) const;

  Rect panel_;
  view::OrbitCamera camera_;
  Pose camera_from_patient_;
};

}  // namespace insonate::ui
