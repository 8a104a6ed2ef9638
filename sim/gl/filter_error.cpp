#include "sim/gl/filter_error.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/core/hash.h"

namespace insonate::gl {
namespace {

constexpr int kSide = 8;  // few enough voxels that single precision positions a sample to 5e-7 of a voxel
constexpr std::uint32_t kPlaces = 16384;

// Returns the exact trilinear value between voxels that alternate between 0 and 1 along all axes.
double exact_value(const glm::vec4& place) {
  double product = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double position = double(place[axis]) * kSide - 0.5, below = std::floor(position);
    product *= (std::fmod(below, 2) == 0 ? 1 : -1) * (1 - 2 * (position - below));
  }
  return (1 - product) / 2;
}

}  // namespace

FilterError measure_filter(const ShaderSources& sources) {
  std::vector<std::int16_t> voxels;
  for (int i = 0; i < kSide * kSide * kSide; ++i)
    voxels.push_back((i + i / kSide + i / (kSide * kSide)) % 2 ? 32767 : 0);
  Texture texture = Texture::make_3d(GL_R16_SNORM, kSide, kSide, kSide, Filter::linear, Wrap::edge);
  texture.write(GL_RED, GL_SHORT, voxels.data());

  std::vector<glm::vec4> places;
  for (std::uint32_t i = 0; i < kPlaces; ++i) {
    const auto inside = [&](std::uint32_t axis) { return glm::mix(0.5f, kSide - 0.5f, unit_float(hash(axis, i))); };
    places.push_back(glm::vec4(inside(0), inside(1), inside(2), 0) / float(kSide));
  }
  const Buffer place_buffer(places.size() * sizeof(glm::vec4), places.data());
  const Buffer value_buffer(places.size() * sizeof(float), nullptr);
  texture.bind(0);
  place_buffer.bind_storage(0);
  value_buffer.bind_storage(1);
  Program(sources, {"filter_error.comp"}).dispatch(int(places.size()), 1);
  std::vector<float> values(places.size());
  value_buffer.read(values.data(), values.size() * sizeof(float));

  FilterError error;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double off = std::abs(double(values[i]) - exact_value(places[i]));
    error.largest = std::max(error.largest, off);
    error.rms += off * off / kPlaces;
  }
  error.rms = std::sqrt(error.rms);
  return error;
}

}  // namespace insonate::gl
