#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>

#include "tests/tools/render/vec3.h"

namespace outsider {

/// The scatterers that fill space, built from their description in scanlines.json.
class Lattice {
public:
  explicit Lattice(const nlohmann::json& about);
  /// Returns the complex amplitude at a place of the patient, with variance 1 in both parts.
  std::array<double, 2> at(const Vec3& patient_mm) const;

private:
  std::uint32_t hash(std::uint32_t h) const;
  std::uint32_t hash(std::uint32_t a, std::uint32_t b) const { return hash(hash(a) + next_ + b); }
  double amplitude(std::uint32_t number) const;

  std::uint32_t first_, second_, next_, seed_;
  int side_;
  double scale_, tail_, variance_, cell_mm_, turn_rad_;
  Vec3 axis_;
};

}  // namespace outsider
