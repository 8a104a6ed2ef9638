#pragma once

#include <bitset>
#include <span>
#include <vector>

#include "scenarios/metrics/metric.h"
#include "sim/probe/probe.h"
#include "sim/tissue/tissue.h"
#include "sim/tissue/transmission.h"
#include "sim/volume/case.h"

namespace insonate {

/// Distance of the samples along a scan line: model S's default reflection length, so that an interface attenuates the
/// sound as much as in the picture.
inline constexpr double kSampleDistance_mm = 0.6;

/// The values of one picture, compared with a reference view.
///
/// The target point represents what the view shows. It is the mean of the view's landmarks, else the centroid of its
/// targets in the reference picture, else the middle of the central beam.
///
/// The rotation from the reference to the probe, in the reference probe's frame, is decomposed as
///   rotation matrix = Rx(tilt) Rz(rock) Ry(rotation).
/// Tilt (about the lateral axis, out of the plane) and rock (in the plane) give the direction of the beam. Rotation is
/// the angle about the beam. Right-hand rule, -180 to 180 degrees, rock -90 to 90. GuidingMove has angles of the same
/// names for the way back, from the probe to the reference, in the order in which a hand turns the probe.
struct ViewValues {
  double plane_distance_mm = 0;   ///< distance of the target point along the picture's normal, signed
  double in_plane_offset_mm = 0;  ///< between the target point's position in the picture and its intended position
  double plane_angle_deg = 0;     ///< between the planes' normals, 0 to 180; 180 for a mirrored picture
  double tilt_deg = 0;
  double rock_deg = 0;
  double rotation_deg = 0;
  double off_centre_percent =
      100;  ///< of the targets' centroid: 0 on the central line, 100 at the fan's edge or unseen
  double target_in_view_percent = 0;     ///< target area in the fan, relative to the reference; may exceed 100
  double target_insonated_percent = 0;   ///< the same for the area that the sound reaches; see ViewMeter
  double landmarks_in_view_percent = 0;  ///< share within kLandmarkDistance_mm of the plane and in the fan
  double depth_use_percent = 0;          ///< extent of the targets along the lines, relative to the learner's depth

  /// A field and the metric of the same name that judges it.
  struct Field {
    Metric metric;
    double ViewValues::*value;
  };
  static std::span<const Field> fields();

  /// Returns the absolute value of a metric, as criteria use it.
  double of(Metric picture_metric) const;
};

/// Measures pictures against one reference view of a case. Keeps references to the case and the view. Samples the fan
/// on kLines lines at about the reflection length, on the CPU in double precision, so that the values do not depend on
/// a graphics card. Compared with 16 times as many lines, the errors of the area shares are below kLineError_percent of
/// the reference's area.
///
/// The sound counts as arriving where its one-way transmission is above -20 dB of the mean transmission over the
/// targets in the reference picture.
class ViewMeter {
public:
  static constexpr int kLines = 48;
  static constexpr double kLineError_percent = 2;
  static constexpr double kLandmarkDistance_mm = 5;
  static constexpr double kArrives = 0.01;  ///< -20 dB of intensity

  /// Throws InputError naming the case if the view's probe is unknown, if its targets or landmarks do not exist, or if
  /// its targets do not appear in its own picture.
  ViewMeter(const Case& subject, const ReferenceView& view, const TissueTable& tissues, int lines = kLines);

  /// Compares the picture at a pose with the reference view.
  /// @param depth_mm  depth of the learner's picture, for depth_use_percent only. All other values use the reference
  ///                  view's own fan, so that no setting changes the value of a pose.
  ViewValues measure(const Pose& patient_from_probe, double depth_mm) const;
  /// Measures at the view's own depth.
  ViewValues measure(const Pose& patient_from_probe) const { return measure(patient_from_probe, view_->depth_mm); }

  const ReferenceView& view() const { return *view_; }
  const glm::dvec3& target_point() const { return target_point_; }  ///< patient, mm

private:
  struct TargetArea {
    double seen_mm2 = 0;
    double insonated_mm2 = 0;
    double transmission_mm2 = 0;  ///< integral of the transmission over the seen area
    double off_centre_mm2 = 0;    ///< integral of the signed position across the fan, -1 to 1
    glm::dvec2 moment_mm3{0.0};   ///< integral of the position in the plane
    double nearest_mm = 0;        ///< start and end of the targets along the lines; 0 without any
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
  std::vector<double> cell_mm2_;  ///< area of the fan that each sample of each line represents
  std::vector<glm::dvec3> landmarks_;
  glm::dvec3 target_point_{0.0};
  glm::dvec2 target_in_reference_{0.0};  ///< the target point in the reference picture, mm
  double least_transmission_ = 0;
  TargetArea reference_;
};

}  // namespace insonate
