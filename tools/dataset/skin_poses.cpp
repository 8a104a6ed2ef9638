#include "tools/dataset/skin_poses.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "sim/volume/open_case.h"

namespace insonate {
namespace {

constexpr double kBeside_mm = 10;       // the normal is that of the skin over twice this distance
constexpr double kLargestStep_mm = 60;  // between the points beside; more is a fold, an arm or the couch

}  // namespace

std::optional<Pose> pose_on_skin(const Volume<std::int16_t>& ct, double around_deg, double height_mm) {
  const glm::dvec3 centre = ct.grid.centre();
  const double reach = glm::length(ct.grid.spacing * glm::dvec3(ct.grid.size));
  const double angle = glm::radians(around_deg);
  const glm::dvec3 outwards(std::sin(angle), -std::cos(angle), 0);  // LPS: -y is in front, +x the patient's left
  const glm::dvec3 leftwards(std::cos(angle), std::sin(angle), 0), headwards(0, 0, 1);
  const glm::dvec3 axis(centre.x, centre.y, height_mm);
  const auto skin_beside = [&](double left_mm, double head_mm) {
    const glm::dvec3 from = axis + reach / 2 * outwards + left_mm * leftwards + head_mm * headwards;
    return skin_along(ct, from, -outwards, reach);
  };
  const auto skin = skin_beside(0, 0);
  const auto left = skin_beside(kBeside_mm, 0), right = skin_beside(-kBeside_mm, 0);
  const auto head = skin_beside(0, kBeside_mm), feet = skin_beside(0, -kBeside_mm);
  if (!skin || !left || !right || !head || !feet) return std::nullopt;
  const glm::dvec3 across = *left - *right, along = *head - *feet;
  if (glm::length(across) > kLargestStep_mm || glm::length(along) > kLargestStep_mm) return std::nullopt;
  const glm::dvec3 beam = glm::normalize(glm::cross(along, across));  // in front: head x left = back
  const glm::dvec3 marker = -glm::normalize(across - glm::dot(across, beam) * beam);
  return Pose{glm::dmat3(marker, beam, glm::cross(marker, beam)), *skin};
}

}  // namespace insonate
