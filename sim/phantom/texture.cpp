#include "sim/phantom/texture.h"

#include <utility>

#include "sim/core/smooth_noise.h"
#include "sim/phantom/shapes.h"

namespace insonate {

float Texture::at(const glm::vec3& position_mm) const {
  const glm::vec3 p = position_mm * per_mm_;
  float value = 0;
  smooth_noise(seed_, &p.x, &p.y, &p.z, 1, &value);
  return value;
}

std::vector<float> Texture::at(const Points& points, const std::vector<std::size_t>& which) const {
  std::vector<float> x(which.size()), y(which.size()), z(which.size());
  for (std::size_t n = 0; n < which.size(); ++n) {
    x[n] = points.x[which[n]];
    y[n] = points.y[which[n]];
    z[n] = points.z[which[n]];
  }
  return at(std::move(x), std::move(y), std::move(z));
}

std::vector<float> Texture::at(std::vector<float> x_mm, std::vector<float> y_mm, std::vector<float> z_mm) const {
  for (std::vector<float>* along : {&x_mm, &y_mm, &z_mm})
    for (float& coordinate : *along) coordinate *= per_mm_;
  std::vector<float> values(x_mm.size());
  smooth_noise(seed_, x_mm.data(), y_mm.data(), z_mm.data(), values.size(), values.data());
  return values;
}

}  // namespace insonate
