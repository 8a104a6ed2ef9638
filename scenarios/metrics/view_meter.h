#pragma once

#include <bitset>
#include <span>
#include <vector>

#include "scenarios/metrics/metric.h"
#include "sim/model/tissue.h"
#include "sim/model/transmission.h"
#include "sim/probe/probe.h"
#include "sim/volume/case.h"

namespace insonate {

/// One picture against a reference view.
///
/// The target point stands for what the view shows: the mean of its landmarks, else the centroid of its targets in the
/// reference picture, else the middle of the central beam.
///
/// The turn from the reference to the probe, in the reference probe's frame, is taken apart as
///   rotation matrix = Rx(tilt) Rz(rock) Ry(rotation),
/// so that tilt (about the lateral axis, out of the plane) and rock (in the plane) say where the beam points and
/// rotation how the probe is turned about it. Right-hand rule, -180 to 180 degrees, rock -90 to 90.
struct ViewValues {
  double plane_distance_mm = 0;   ///< of the target point along the picture's normal, signed
  double in_plane_offset_mm = 0;  ///< between where the target point lies in the picture and where it should
  double plane_angle_deg = 0;     ///< between the planes' normals, 0 to 180: a mirrored picture is 180 off
  double tilt_deg = 0;
  double rock_deg = 0;
  double rotation_deg = 0;
  double off_centre_percent =
      100;  ///< of the targets' centroid: 0 on the central line, 100 at the fan's edge or unseen
  double target_in_view_percent = 0;     ///< area of the targets in the fan over that in the reference; may exceed 100
  double target_insonated_percent = 0;   ///< the same, only where the sound arrives; see ViewMeter
  double landmarks_in_view_percent = 0;  ///< within kLandmarkDistance_mm of the plane and in the fan
  double depth_use_percent = 0;          ///< extent of the targets along the lines over the depth that the learner set

  /// A field and the metric that it is judged by, which has the same name.
  struct Field {
    Metric metric;
    double ViewValues::*value;
  };
  static std::span<const Field> fields();

  /// As a criterion takes it: signed values lose their sign.
  double of(Metric picture_metric) const;
};

/// Measures pictures against one reference view of a case. Keeps a reference to the case. Samples the fan on
/// kLines lines at about the reflection length, on the CPU and in double precision, so that the values do not depend
/// on any graphics card. Against sixteen times as many lines the shares of area are off by less than kLineError_percent
/// of the reference's area.
///
/// The sound is said to arrive where its one-way transmission is above -20 dB of the mean transmission over the
/// targets in the reference picture.
class ViewMeter {
public:
  static constexpr int kLines = 48;
  static constexpr double kLineError_percent = 2;
  static constexpr double kLandmarkDistance_mm = 5;
  static constexpr double kArrives = 0.01;  ///< -20 dB of intensity

  /// Throws InputError naming the case when the view's probe is unknown, or its targets or landmarks do not exist or
  /// do not appear in its own picture.
  ViewMeter(const Case& subject, const ReferenceView& view, const TissueTable& tissues, int lines = kLines);

  /// @param depth_mm  of the learner's picture, for depth_use_percent alone: all else is measured in the reference
  ///                  view's own fan, so that no knob changes what a pose is worth
  ViewValues measure(const Pose& patient_from_probe, double depth_mm) const;
  /// At the view's own depth.
  ViewValues measure(const Pose& patient_from_probe) const { return measure(patient_from_probe, view_->depth_mm); }

  const ReferenceView& view() const { return *view_; }
  const glm::dvec3& target_point() const { return target_point_; }  ///< patient, mm

private:
  struct TargetArea {
    double seen_mm2 = 0;
    double insonated_mm2 = 0;
    double transmission_mm2 = 0;  ///< integral of the transmission over the area seen
    double off_centre_mm2 = 0;    ///< integral of the signed position across the fan, -1 to 1
    glm::dvec2 moment_mm3{0.0};   ///< integral of the position in the plane
    double nearest_mm = 0;        ///< where along the lines the targets begin and end; 0 without any
    double furthest_mm = 0;
  };
  TargetArea target_area(const Pose& patient_from_probe, double least_transmission) const;
  glm::dvec3 find_target_point(const TargetArea& reference) const;
  double landmarks_in_view_percent(const Pose& probe_from_patient) const;

  const Case* case_;
  const ReferenceView* view_;
  Probe probe_;
  ScanLines lines_;
  Transmission transmission_;
  std::bitset<256> is_target_;
  std::vector<double> cell_mm2_;  ///< per line and sample, the area of the fan it stands for
  std::vector<glm::dvec3> landmarks_;
  glm::dvec3 target_point_{0.0};
  glm::dvec2 target_in_reference_{0.0};  ///< the target point in the reference picture, mm
  double least_transmission_ = 0;
  TargetArea reference_;
};

}  // namespace insonate
