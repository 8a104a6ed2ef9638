#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <string>
#include <vector>

#include "sim/core/probe_sample.h"
#include "sim/tissue/tissue.h"
#include "sim/volume/case.h"

namespace insonate {

// A case whose scores can be computed by hand. It has a block of tissue behind the plane y = 0, air before it, a ball
// of 20 mm radius at (0, 60, 0) mm as the target, and beside it a rib over z = 25 to 50 mm. The reference probe stands
// at the origin, its axes along the patient's, and points at the ball.
inline constexpr double kBallRadius_mm = 20;
inline const glm::dvec3 kBall{0, 60, 0};

inline Case tiny_case() {
  Case subject;
  subject.name = "Ball in a block";
  subject.ct.grid.size = {81, 71, 81};
  subject.ct.grid.spacing = glm::dvec3(2.0);
  subject.ct.grid.origin = {-80, -20, -80};
  subject.labels.grid = subject.ct.grid;
  const Grid& grid = subject.ct.grid;
  subject.ct.voxels.resize(grid.count());
  subject.labels.voxels.resize(grid.count());
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const glm::dvec3 p = grid.patient_from_index({i, j, k});
        const bool rib = p.y >= 10 && p.y <= 22 && p.z >= 25 && p.z <= 50;
        const bool ball = glm::distance(p, kBall) <= kBallRadius_mm;
        subject.ct.at({i, j, k}) = std::int16_t(p.y < 0 ? -1000 : rib ? 1500 : ball ? 60 : 40);
        subject.labels.at({i, j, k}) = std::uint8_t(ball ? 1 : rib ? 2 : 0);
      }
  subject.label_table = {{1, "ball", "liver"}, {2, "rib", "bone"}};
  subject.landmarks = {{"centre", kBall}, {"top", kBall - glm::dvec3(0, 15, 0)}};
  subject.views = {{"ball", "The ball", "curvilinear", 140, {"centre", "top"}, {"ball"}, Pose{}},
                   {"bare", "No landmarks and no targets", "curvilinear", 140, {}, {}, Pose{}}};
  return subject;
}

/// Air, water, soft tissue and bone, approximately. The scores here depend only on bone and air blocking the sound.
inline TissueTable tiny_tissues() {
  TissueTable table;
  table.knots = {
      {-1000, 0.0004, 12, -60}, {-400, 1.3, 2, -60}, {0, 1.48, 0.002, -60}, {60, 1.65, 0.5, 0}, {1500, 7.8, 10, 0}};
  return table;
}

inline Pose turned(double degrees, const glm::dvec3& axis, const glm::dvec3& translation = glm::dvec3(0.0)) {
  return {glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::normalize(axis))), translation};
}

/// Returns the same patient moved by a rigid transform.
inline Case moved_case(Case subject, const Pose& moved) {
  for (Grid* grid : {&subject.ct.grid, &subject.labels.grid}) {
    grid->origin = moved.point(grid->origin);
    grid->direction = moved.rotation * grid->direction;
  }
  for (Landmark& landmark : subject.landmarks) landmark.position = moved.point(landmark.position);
  for (ReferenceView& view : subject.views) view.patient_from_probe = moved * view.patient_from_probe;
  return subject;
}

inline ProbeSample sample_at(double time_s, const Pose& pose, PoseStatus status = PoseStatus::ok) {
  ProbeSample sample;
  sample.time_s = time_s;
  sample.status = status;
  sample.patient_from_probe = pose;
  return sample;
}

/// Returns samples at a rate over a time. The pose is a function of the time.
template <typename PoseAt>
std::vector<ProbeSample> samples_of(double duration_s, double rate_hz, PoseAt&& pose_at) {
  std::vector<ProbeSample> samples;
  for (int i = 0; i <= int(std::lround(duration_s * rate_hz)); ++i)
    samples.push_back(sample_at(i / rate_hz, pose_at(i / rate_hz)));
  return samples;
}

inline const char* const kTinyScenario = R"(
format = 1
title = "Find the ball"
case = "tiny"
pass_mark_percent = 60
time_limit_s = 30

[[step]]
kind = "find_view"
title = "Ball"
instruction = "Show the ball."
view = "ball"
hold_s = 1.0
time_limit_s = 10

[step.tolerance]
plane_distance_mm = 8
plane_angle_deg = 20

[[step.criterion]]
metric = "plane_distance_mm"
full = 2
zero = 10
weight = 4

[[step.criterion]]
metric = "target_insonated_percent"
full = 80
zero = 20
weight = 2
critical = true

[[step]]
kind = "find_view"
title = "Ball again"
instruction = "Show the ball once more."
view = "ball"
hold_s = 0.5
time_limit_s = 10

[step.tolerance]
plane_distance_mm = 8

[[step.criterion]]
metric = "longest_hold_s"
full = 0.5
zero = 0

[[criterion]]
metric = "path_length_mm"
full = 50
zero = 150
weight = 3
)";

}  // namespace insonate
