#include "tests/tools/render/lattice.h"

#include <cmath>

#include "tests/tools/render/recomputation.h"

namespace outsider {

Lattice::Lattice(const nlohmann::json& about) {
  const auto& scatterers = about.at("scatterers");
  first_ = scatterers.at("hash").at("first");
  second_ = scatterers.at("hash").at("second");
  next_ = scatterers.at("hash").at("next");
  side_ = scatterers.at("side");
  scale_ = scatterers.at("scale");
  tail_ = scatterers.at("tail");
  variance_ = scatterers.at("variance");
  turn_rad_ = scatterers.at("turn_rad");
  axis_ = vec3(scatterers.at("turn_axis"));
  axis_ = 1 / length(axis_) * axis_;
  seed_ = about.at("settings").at("speckle_seed");
  cell_mm_ = about.at("settings").at("speckle_cell_mm");
}

std::uint32_t Lattice::hash(std::uint32_t h) const {
  h = (h ^ (h >> 16)) * first_;
  h = (h ^ (h >> 13)) * second_;
  return h ^ (h >> 16);
}

double Lattice::amplitude(std::uint32_t number) const {
  const std::uint32_t key = hash(seed_, number);
  double sum = 0;
  for (std::uint32_t i = 0; i < 4; ++i) sum += (hash(key, i) >> 8) / 16777216.0;
  const double x = (sum - 2) * std::sqrt(3.0), y = (x + tail_ * (std::pow(x, 3) - 3 * x)) / std::sqrt(variance_);
  return std::round(y / scale_ * 32767) / 32767 * scale_;
}

std::array<double, 2> Lattice::at(const Vec3& p) const {
  // Rodrigues' formula.
  const Vec3 turned = std::cos(turn_rad_) * p + std::sin(turn_rad_) * cross(axis_, p) +
                      (1 - std::cos(turn_rad_)) * dot(axis_, p) * axis_;
  double f[3];
  int low[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double cell = turned[a] / cell_mm_ - 0.5;
    low[a] = int(std::floor(cell));
    f[a] = cell - low[a];
  }
  std::array<double, 2> sum{};
  double squares = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::uint32_t number = 0, stride = 1;
    for (int a = 0; a < 3; ++a) {
      const int up = corner >> a & 1;
      weight *= up ? f[a] : 1 - f[a];
      number += stride * std::uint32_t(((low[a] + up) % side_ + side_) % side_);
      stride *= std::uint32_t(side_);
    }
    for (std::uint32_t part = 0; part < 2; ++part) sum[part] += weight * amplitude(2 * number + part);
    squares += weight * weight;
  }
  return {sum[0] / std::sqrt(squares), sum[1] / std::sqrt(squares)};
}

}  // namespace outsider
