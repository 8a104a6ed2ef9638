// The search for an acoustic window, on bodies whose best window is known.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "scenarios/cases/acoustic_window.h"
#include "scenarios/cases/suggested_views.h"
#include "tests/scenarios/tiny_case.h"

using namespace insonate;

namespace {

constexpr double kSkin_mm = 70, kOrgan_mm = 20;

/// Degrees round the body from the front, rising to the patient's right.
double degrees_round(const glm::dvec3& p) {
  return glm::degrees(std::atan2(-p.x, -p.y));
}

// A trunk of 70 mm radius along z with an ellipsoid of 20 mm radius, longer along z, in its axis, and a shell of bone
// under the skin but for `half_gap_deg` to either side of `gap_deg`. The CT may end to the right.
Case trunk(double gap_deg, double half_gap_deg, double cut_right_mm = 200) {
  Case subject;
  subject.ct.grid.size = {80, 80, 80};
  subject.ct.grid.spacing = glm::dvec3(2.0);
  subject.ct.grid.origin = {std::max(-79.0, -cut_right_mm), -79, -79};
  subject.labels.grid = subject.ct.grid;
  const Grid& grid = subject.ct.grid;
  subject.ct.voxels.resize(grid.count());
  subject.labels.voxels.resize(grid.count());
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const glm::dvec3 p = grid.patient_from_index({i, j, k});
        const double r = std::hypot(p.x, p.y);
        const double away = std::remainder(degrees_round(p) - gap_deg, 360.0);
        const bool bone = r > 50 && r < 58 && std::abs(away) > half_gap_deg;
        const bool organ = glm::length(p * glm::dvec3(1, 1, 0.8)) <= kOrgan_mm;
        subject.ct.at({i, j, k}) = std::int16_t(r > kSkin_mm ? -1000 : bone ? 1200 : organ ? 60 : 40);
        subject.labels.at({i, j, k}) = std::uint8_t(organ);
      }
  subject.label_table = {{1, "gallbladder", "bile"}};
  return subject;
}

std::optional<Window> best_across(const Case& subject) {
  const BodyMask body = find_body(subject.ct);
  REQUIRE_FALSE(body.empty());
  return WindowSearch(subject, body, tiny_tissues(), *find_probe("curvilinear"))
      .best({glm::dvec3(0.0), {0, 0, 1}, false, {1}});
}

}  // namespace

TEST_CASE("the window is found in the gap of a shell of bone, the face on the skin and the marker on its side") {
  const double gap_deg = GENERATE(0.0, 40.0, 75.0, -60.0);
  INFO("gap at " << gap_deg);
  const auto window = best_across(trunk(gap_deg, 20));
  REQUIRE(window);
  const Pose& pose = window->patient_from_probe;
  // The lines to the organ's edges part 9.8 degrees from the middle one at the fan's apex, 118 mm away, and so pass the
  // shell's inner side, 50 mm away, 13 degrees from it: nothing is lost until 7 degrees beside the gap's middle, and
  // little just beyond.
  const glm::dvec3 face = pose.translation;
  CHECK(std::abs(std::remainder(degrees_round(face) - gap_deg, 360.0)) <= 10);
  // Pressed in by 12 mm at most where the skin is 70 mm away; a voxel's half for the skin between voxels.
  CHECK(std::hypot(face.x, face.y) >= kSkin_mm - 12 - 1);
  CHECK(std::hypot(face.x, face.y) <= kSkin_mm - 4 + 1);
  CHECK(std::abs(pose.inverse().point(glm::dvec3(0.0)).z) < 1e-6);  // the plane goes through the aim
  CHECK(std::abs(pose.rotation[2].z) >= std::cos(glm::radians(20.0)) - 1e-9);
  const glm::dvec3 marker = pose.rotation[0];
  CHECK(glm::distance(marker, marker_side(marker)) < 1e-12);
  CHECK(glm::determinant(pose.rotation) == Approx(1));
  CHECK(window->clear_share > 0.9);
  CHECK(window->section_share > 0.85);
  // The far side of the organ from the face.
  CHECK(window->depth_mm == Approx(glm::length(face) + kOrgan_mm).margin(4));
}

TEST_CASE("where the plane holds the axis, the beam comes from across it and the marker looks to the head") {
  const Case subject = trunk(20, 40);
  const BodyMask body = find_body(subject.ct);
  const auto window = WindowSearch(subject, body, tiny_tissues(), *find_probe("curvilinear"))
                          .best({glm::dvec3(0.0), {0, 0, 1}, true, {1}});
  REQUIRE(window);
  const Pose& pose = window->patient_from_probe;
  CHECK(std::abs(pose.rotation[2].z) < 1e-9);  // the axis lies in the plane
  CHECK(pose.rotation[0].z >= 0.5 - 1e-9);     // 40 degrees of lean and 20 of rock at most
  CHECK(window->clear_share > 0.9);
}

TEST_CASE("the window found does not depend on the number of threads") {
  const Case subject = trunk(30, 45);
  const auto window = best_across(subject);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto alone = best_across(subject);
  REQUIRE((window && alone));
  CHECK(window->patient_from_probe == alone->patient_from_probe);
  CHECK(window->clear_share == alone->clear_share);
}

TEST_CASE("a patient who lies on the back is not looked at from there, nor through a shell without a gap") {
  const auto closed = best_across(trunk(0, 0));
  const auto from_behind = best_across(trunk(180, 35));
  for (const auto& window : {closed, from_behind})
    if (window) CHECK(window->clear_share < kMinClear);
}

TEST_CASE("where the CT ends within the body there is no skin") {
  // The gap is to the right, where the CT ends 60 mm from the middle: half of it has no skin.
  const auto window = best_across(trunk(60, 60, 45));
  REQUIRE(window);
  const glm::dvec3 face = window->patient_from_probe.translation;
  CHECK(face.x > -45);
  CHECK(std::hypot(face.x, face.y) > kSkin_mm - 13);
}

TEST_CASE("suggested views pass the scorer's own checks, and one without a window is reported, not made") {
  const auto suggested_for = [](const Case& subject) {
    Case with_landmarks = subject;
    const auto shapes = structure_shapes(subject);
    const Anatomy anatomy = find_anatomy(subject, shapes);
    with_landmarks.landmarks = landmarks_of(anatomy);
    return suggest_views(with_landmarks, anatomy, find_body(subject.ct), tiny_tissues());
  };
  const SuggestedViews open = suggested_for(trunk(30, 45));
  REQUIRE(open.views.size() == 2);
  CHECK(open.views[0].name == "gallbladder_long");
  CHECK(open.views[1].name == "gallbladder_short");
  CHECK(open.views[1].title == "Gallbladder, short axis");
  CHECK(open.views[0].targets == std::vector<std::string>{"gallbladder"});
  // The organ's centre and both ends of its long axis are in the plane that holds that axis.
  CHECK(open.views[0].landmarks.size() == 3);

  const SuggestedViews closed = suggested_for(trunk(0, 0));
  CHECK(closed.views.empty());
  CHECK(closed.notes.size() == 2);
  for (const std::string& note : closed.notes) CHECK_THAT(note, Catch::StartsWith("No view 'gallbladder_"));
}
