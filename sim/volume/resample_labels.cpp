#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/volume/ct_reader.h"

namespace insonate {
namespace {

/// The weights of the four old voxels around a new one along an axis: the mean of linear interpolation's and the cubic
/// B-spline's.
struct Weights {
  int first = 0;  ///< old index of the first of the four
  std::array<float, 4> of{};
};

Weights weights_at(double position) {
  const double floor = std::floor(position), t = position - floor, s = 1 - t;
  return {int(floor) - 1,
          {float(s * s * s / 6), float(2.0 / 3 - t * t * (2 - t) / 2), float(2.0 / 3 - s * s * (2 - s) / 2),
           float(t * t * t / 6)}};
}

/// Returns for each old voxel whether it and the 63 others that a new voxel behind it depends on have one label. Most
/// do, and then nothing has to be counted.
std::vector<std::uint8_t> uniform_surroundings(const Volume<std::uint8_t>& labels) {
  const glm::ivec3 size = labels.grid.size;
  std::vector<std::uint8_t> uniform(labels.voxels.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, size.z), [&](const auto& slices) {
    for (int z = slices.begin(); z != slices.end(); ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
          const std::uint8_t label = labels.at({x, y, z});
          bool same = true;
          for (int k = std::max(z - 1, 0); same && k <= std::min(z + 2, size.z - 1); ++k)
            for (int j = std::max(y - 1, 0); same && j <= std::min(y + 2, size.y - 1); ++j)
              for (int i = std::max(x - 1, 0); same && i <= std::min(x + 2, size.x - 1); ++i)
                same = labels.at({i, j, k}) == label;
          uniform[labels.grid.offset({x, y, z})] = same;
        }
  });
  return uniform;
}

/// Returns the label with the largest sum of weights at a place in old indices; the lower label of two alike.
std::uint8_t label_at(const Volume<std::uint8_t>& labels, const glm::dvec3& place) {
  const glm::ivec3 size = labels.grid.size;
  std::array<Weights, 3> spline;
  std::array<std::array<float, 4>, 3> linear{};
  for (int axis = 0; axis < 3; ++axis) {
    spline[std::size_t(axis)] = weights_at(place[axis]);
    const float t = float(place[axis] - std::floor(place[axis]));
    linear[std::size_t(axis)] = {0, 1 - t, t, 0};
  }
  std::array<std::uint8_t, 64> found;
  std::array<float, 64> votes;
  std::size_t count = 0;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const glm::ivec3 at = glm::clamp(glm::ivec3(spline[0].first + i, spline[1].first + j, spline[2].first + k),
                                         glm::ivec3(0), size - 1);
        const std::size_t a = std::size_t(i), b = std::size_t(j), c = std::size_t(k);
        const float vote =
            spline[0].of[a] * spline[1].of[b] * spline[2].of[c] + linear[0][a] * linear[1][b] * linear[2][c];
        const std::uint8_t label = labels.at(at);
        const std::size_t known =
            std::size_t(std::find(found.begin(), found.begin() + std::ptrdiff_t(count), label) - found.begin());
        if (known == count) {
          found[count] = label;
          votes[count++] = 0;
        }
        votes[known] += vote;
      }
  std::size_t best = 0;
  for (std::size_t i = 1; i < count; ++i)
    if (votes[i] > votes[best] || (votes[i] == votes[best] && found[i] < found[best])) best = i;
  return found[best];
}

}  // namespace

Volume<std::uint8_t> resample_labels(const Volume<std::uint8_t>& labels, const Grid& onto) {
  const glm::dmat4 from_new = glm::inverse(labels.grid.matrix()) * onto.matrix();
  const std::vector<std::uint8_t> uniform = uniform_surroundings(labels);
  Volume<std::uint8_t> out{onto, std::vector<std::uint8_t>(onto.count())};
  tbb::parallel_for(tbb::blocked_range<int>(0, onto.size.z), [&](const auto& slices) {
    for (int z = slices.begin(); z != slices.end(); ++z)
      for (int y = 0; y < onto.size.y; ++y)
        for (int x = 0; x < onto.size.x; ++x) {
          const glm::dvec3 place(from_new * glm::dvec4(x, y, z, 1));
          if (!labels.grid.contains(glm::ivec3(glm::round(place))))
            continue;  // nothing is known beyond the outer voxels
          const glm::ivec3 before = glm::max(glm::ivec3(glm::floor(place)), glm::ivec3(0));
          out.at({x, y, z}) = uniform[labels.grid.offset(before)] ? labels.at(before) : label_at(labels, place);
        }
  });
  return out;
}

}  // namespace insonate
