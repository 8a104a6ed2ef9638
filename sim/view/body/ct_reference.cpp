#include "sim/view/body/ct_reference.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/view/body/tissue_classes.h"

namespace insonate::view {
namespace {

// As in view/ct_march.glsl and view/volume_ray.glsl.
constexpr double kGradientReach = 1;
constexpr double kUnlit_hu_mm = 4, kLit_hu_mm = 20, kHighlight = 0.18;
constexpr glm::dvec2 kLightWithin(0.8, 0.0);

double smoothstep(double from, double to, double value) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Returns the smoothed CT that the shader takes gradients of.
Volume<std::int16_t> smoothed(const Volume<std::int16_t>& ct) {
  const TissueClasses classes = classify_tissue(ct, {}, {});
  Volume<std::int16_t> smooth;
  smooth.grid = ct.grid;
  smooth.grid.size = classes.size;
  smooth.grid.spacing = ct.grid.spacing * glm::dvec3(classes.step);
  smooth.grid.origin = ct.grid.patient_from_index(glm::dvec3(classes.step - 1) / 2.0);
  for (const auto& [hu] : classes.hu) smooth.voxels.push_back(hu);
  return smooth;
}

}  // namespace

CtReference::CtReference(const Volume<std::int16_t>& ct, const CtVolumeStyle& style, const OrbitCamera& camera,
                         int width, int height, double step_mm)
    : ct_(ct),
      smooth_(style.shaded ? smoothed(ct) : Volume<std::int16_t>()),
      style_(style),
      table_(style.function),
      step_mm_(step_mm),
      width_(width),
      height_(height) {
  const Pose pose = camera.patient_from_camera();
  const double slope = std::tan(glm::radians(camera.field_of_view_deg / 2));
  eye_ = pose.translation;
  right_ = pose.rotation[0] * (slope * width / height);
  down_ = pose.rotation[1] * slope;
  into_ = pose.rotation[2];
}

glm::dvec3 CtReference::direction(double x, double y) const {
  return glm::normalize(into_ + (2 * x / width_ - 1) * right_ + (2 * y / height_ - 1) * down_);
}

double CtReference::hounsfield(const glm::dvec3& patient) const {
  return sample_trilinear(ct_, ct_.grid.index_from_patient(patient));
}

glm::dvec3 CtReference::gradient(const glm::dvec3& patient) const {
  const glm::dvec3 index = smooth_.grid.index_from_patient(patient);
  glm::dvec3 per_voxel(0.0);
  for (const glm::dvec3 corner : {glm::dvec3(1, -1, -1), glm::dvec3(-1, -1, 1), glm::dvec3(-1, 1, -1), glm::dvec3(1)}) {
    const glm::dvec3 at =
        glm::clamp(index + kGradientReach * corner, glm::dvec3(0.0), glm::dvec3(smooth_.grid.size - 1));
    per_voxel += corner * sample_trilinear(smooth_, at) / (4 * kGradientReach);
  }
  return smooth_.grid.direction * (per_voxel / smooth_.grid.spacing);
}

glm::dvec2 CtReference::light(const glm::dvec3& patient, const glm::dvec3& view) const {
  const glm::dvec3 slope = gradient(patient);
  const double size = glm::length(slope);
  const double lit = smoothstep(kUnlit_hu_mm, kLit_hu_mm, size);
  if (lit == 0) return kLightWithin;
  glm::dvec3 normal = slope / size;
  if (glm::dot(normal, view) > 0) normal = -normal;
  const glm::dvec3 right = glm::normalize(right_), down = glm::normalize(down_);
  const glm::dvec3 lamp = glm::normalize(-into_ - 0.45 * right - 0.6 * down);
  const double diffuse = std::max(glm::dot(normal, lamp), 0.0);
  const double from_above = 0.5 - 0.5 * glm::dot(normal, down);
  const double highlight = std::pow(std::max(glm::dot(normal, glm::normalize(lamp - view)), 0.0), 28.0);
  return glm::mix(kLightWithin, glm::dvec2(0.22 + 0.12 * from_above + 0.72 * diffuse, highlight), lit);
}

glm::dvec4 CtReference::layer(double x, double y, double begin_mm, double end_mm) const {
  const glm::dvec3 ray = direction(x, y);
  // The CT ends at the outer faces of its voxels.
  const glm::dvec3 eye = ct_.grid.index_from_patient(eye_) + 0.5;
  const glm::dvec3 along = ct_.grid.index_from_patient(eye_ + ray) + 0.5 - eye;
  double t = begin_mm, end = end_mm;
  for (int axis = 0; axis < 3; ++axis) {
    const double per_mm = std::abs(along[axis]) < 1e-12 ? 1e-12 : along[axis];
    const double a = -eye[axis] / per_mm, b = (ct_.grid.size[axis] - eye[axis]) / per_mm;
    t = std::max(t, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  glm::dvec4 sum(0.0);
  if (t >= end) return sum;
  double before = hounsfield(eye_ + t * ray);
  while (t < end) {
    const double next = std::min(t + step_mm_, end), segment_mm = next - t;
    const double hu = hounsfield(eye_ + next * ray);
    const glm::dvec4 seen =
        style_.classification == Classification::pre_integrated ? table_.mean(before, hu) : table_.value(hu);
    if (seen.a > 0) {
      const glm::dvec3 middle = eye_ + (t + segment_mm / 2) * ray;
      const double opacity = 1 - std::exp(-seen.a * segment_mm);
      const glm::dvec2 lit = style_.shaded ? light(middle, ray) : glm::dvec2(1.0, 0.0);
      sum += (1 - sum.a) * opacity * glm::dvec4(glm::dvec3(seen) / seen.a * lit.x + kHighlight * lit.y, 1.0);
    }
    before = hu;
    t = next;
  }
  return sum;
}

glm::dvec3 CtReference::background(double x, double y) const {
  const double away = glm::length(glm::dvec2(2 * x / width_ - 1, 2 * y / height_ - 1));
  return glm::mix(glm::dvec3(0.085, 0.095, 0.115), glm::dvec3(0.045, 0.050, 0.062), smoothstep(0.2, 1.5, away));
}

glm::dvec3 CtReference::colour(double x, double y) const {
  const glm::dvec4 sum = layer(x, y, 0, std::numeric_limits<double>::max());
  return glm::dvec3(sum) + (1 - sum.a) * background(x, y);
}

}  // namespace insonate::view
