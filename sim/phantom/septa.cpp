#include "sim/phantom/septa.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace insonate {
namespace {

// The mean slope of the noise at its zeros, per grain: of two layers of gradient noise, measured over 10^6 points.
constexpr float kSlope = 2.6f;

}  // namespace

Septa::Septa(const SeptaForm& form) : form_(form), noise_(form.seed, 1.0f) {
  float length = 0;
  for (std::size_t n = 0; n < form_.along.size(); ++n) {
    if (n > 0) length += glm::length(form_.along[n].position - form_.along[n - 1].position);
    way_.push_back(length);
  }
}

std::vector<float> Septa::at(Points& points, const std::vector<std::size_t>& which) const {
  std::vector<float> x(which.size()), y(which.size()), z(which.size());
  const float per_apart = 1 / form_.apart_mm, per_along = 1 / form_.along_mm;
  if (form_.layers_of) {
    const std::vector<float>& d = points.distances_to(*form_.layers_of);
    // Any fixed direction serves: along it the noise changes quickly with the depth, and slowly with the place.
    const glm::vec3 deep = glm::normalize(glm::vec3(0.6f, 0.5f, 0.62f));
    for (std::size_t n = 0; n < which.size(); ++n) {
      const std::size_t at = which[n];
      const glm::vec3 q = glm::vec3(points.x[at], points.y[at], points.z[at]) * per_along + deep * (d[at] * per_apart);
      x[n] = q.x;
      y[n] = q.y;
      z[n] = q.z;
    }
  } else {
    const float side = form_.along.front().position.x < 0 ? -1.0f : 1.0f;
    for (std::size_t n = 0; n < which.size(); ++n) {
      glm::vec3 p(points.x[which[n]], points.y[which[n]], points.z[which[n]]);
      if (form_.mirrored && p.x * side < 0) p.x = -p.x;
      float least = std::numeric_limits<float>::max(), way = 0;
      glm::vec3 off(0.0f);
      for (std::size_t i = 0; i + 1 < form_.along.size(); ++i) {
        const glm::vec3 from = form_.along[i].position, ahead = form_.along[i + 1].position - from;
        const float t = std::clamp(glm::dot(p - from, ahead) / std::max(glm::dot(ahead, ahead), 1e-9f), 0.0f, 1.0f);
        const glm::vec3 here = p - from - t * ahead;
        const float squared = glm::dot(here, here);
        if (squared >= least) continue;
        least = squared;
        off = here;
        way = glm::mix(way_[i], way_[i + 1], t);
      }
      const glm::vec3 q = off * per_apart + glm::vec3(0.6f, 0.5f, 0.62f) * (way * per_along);
      x[n] = q.x;
      y[n] = q.y;
      z[n] = q.z;
    }
  }
  std::vector<float> added = noise_.at(x, y, z);
  // |n| = kSlope * distance / apart near a zero; at half of `hu` the distance is half the thickness.
  const float width = kSlope * form_.thick_mm * per_apart;
  for (float& value : added) value = form_.hu * std::max(0.0f, 1.0f - std::abs(value) / width);
  return added;
}

}  // namespace insonate
