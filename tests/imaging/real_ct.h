#pragma once

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <filesystem>

#include "sim/core/pose.h"
#include "sim/volume/open_case.h"

namespace insonate::test {

/// A patient's abdomen, on machines that have it.
inline const std::filesystem::path kRealCt = INSONATE_SCANS_FOLDER "/abdomen_ct/abdomen_ct.nii.gz";

/// Returns the pose on the skin towards `target` along `into`, with the face pressed in by 8 mm and the marker towards
/// the head.
inline Pose on_skin_of(const Case& subject, const glm::dvec3& target, const glm::dvec3& into) {
  double inside = 0;
  for (double s = -250; s < 250; s += 0.5) {
    const glm::dvec3 p = target + s * into;
    inside = sample_trilinear(subject.ct, subject.ct.grid.index_from_patient(p)) > -300 ? inside + 0.5 : 0;
    if (inside >= 20) {
      const glm::dvec3 marker(0, 0, 1);
      return {glm::dmat3(marker, into, glm::cross(marker, into)), p - (20.0 - 8.0) * into};
    }
  }
  FAIL("no skin along the line of sight");
  return {};
}

}  // namespace insonate::test
