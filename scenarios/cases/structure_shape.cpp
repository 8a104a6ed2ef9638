#include "scenarios/cases/structure_shape.h"

#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

namespace insonate {
namespace {

constexpr double kPoleShare = 0.05;  // of the length

/// Sums over a label's voxels of their indices and of the indices' products.
struct Moments {
  std::int64_t count = 0;
  std::array<std::int64_t, 3> first{};
  std::array<std::int64_t, 6> second{};  ///< xx, yy, zz, xy, xz, yz
  glm::ivec3 low{std::numeric_limits<int>::max()}, high{-1};

  void add(int i, int j, int k) {
    const std::int64_t x = i, y = j, z = k;
    ++count;
    first[0] += x;
    first[1] += y;
    first[2] += z;
    second[0] += x * x;
    second[1] += y * y;
    second[2] += z * z;
    second[3] += x * y;
    second[4] += x * z;
    second[5] += y * z;
    low = {std::min(low.x, i), std::min(low.y, j), std::min(low.z, k)};
    high = {std::max(high.x, i), std::max(high.y, j), std::max(high.z, k)};
  }
  void add(const Moments& other) {
    count += other.count;
    for (std::size_t a = 0; a < first.size(); ++a) first[a] += other.first[a];
    for (std::size_t a = 0; a < second.size(); ++a) second[a] += other.second[a];
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
  }
  glm::dvec3 mean_index() const {
    return glm::dvec3(double(first[0]), double(first[1]), double(first[2])) / double(count);
  }
};

std::vector<Moments> moments_of(const Volume<std::uint8_t>& labels) {
  std::vector<Moments> all(256);
  std::mutex mutex;
  tbb::parallel_for(tbb::blocked_range<int>(0, labels.grid.size.z), [&](const auto& slices) {
    std::vector<Moments> here(256);
    for (int k = slices.begin(); k != slices.end(); ++k)
      for (int j = 0; j < labels.grid.size.y; ++j)
        for (int i = 0; i < labels.grid.size.x; ++i)
          if (const std::uint8_t value = labels.at({i, j, k})) here[value].add(i, j, k);
    const std::lock_guard lock(mutex);
    for (std::size_t value = 0; value < all.size(); ++value)
      if (here[value].count) all[value].add(here[value]);
  });
  return all;
}

/// Calls `use` with the index of each of a structure's voxels, in memory order.
template <typename Use>
void for_each_voxel(const Case& subject, const StructureShape& shape, Use use) {
  for (int k = shape.low.z; k <= shape.high.z; ++k)
    for (int j = shape.low.y; j <= shape.high.y; ++j)
      for (int i = shape.low.x; i <= shape.high.x; ++i)
        if (subject.labels.at({i, j, k}) == shape.label.value) use(glm::ivec3(i, j, k));
}

void set_axes(const Grid& grid, const Moments& m, StructureShape& shape) {
  // The covariance is computed in index space, then transformed to the patient. Each voxel is a box, whose own variance
  // is 1/12.
  const glm::dvec3 mean = m.mean_index();
  const auto central = [&](std::size_t sum, int a, int b) {
    return double(m.second[sum]) / double(m.count) - mean[a] * mean[b];
  };
  Eigen::Matrix3d index;
  index << central(0, 0, 0), central(3, 0, 1), central(4, 0, 2),  //
      central(3, 0, 1), central(1, 1, 1), central(5, 1, 2),       //
      central(4, 0, 2), central(5, 1, 2), central(2, 2, 2);
  index.diagonal().array() += 1.0 / 12;
  Eigen::Matrix3d to_patient;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) to_patient(r, c) = grid.direction[c][r] * grid.spacing[c];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(to_patient * index * to_patient.transpose());
  for (int a = 0; a < 3; ++a) {
    const int from = 2 - a;  // Eigen sorts eigenvalues in ascending order
    shape.deviation_mm[a] = std::sqrt(std::max(0.0, solved.eigenvalues()[from]));
    shape.axes[a] =
        marker_side({solved.eigenvectors()(0, from), solved.eigenvectors()(1, from), solved.eigenvectors()(2, from)});
  }
}

void set_poles(const Case& subject, StructureShape& shape) {
  const Grid& grid = subject.labels.grid;
  const glm::dvec3 zero = grid.origin;
  const auto along = [&](const glm::ivec3& i) {
    return glm::dot(grid.patient_from_index(glm::dvec3(i)) - zero, shape.axes[0]);
  };
  double least = std::numeric_limits<double>::max(), most = std::numeric_limits<double>::lowest();
  for_each_voxel(subject, shape, [&](const glm::ivec3& i) {
    const double s = along(i);
    least = std::min(least, s);
    most = std::max(most, s);
  });
  const double depth = kPoleShare * (most - least);
  Moments first, second;
  for_each_voxel(subject, shape, [&](const glm::ivec3& i) {
    const double s = along(i);
    if (s >= most - depth) first.add(i.x, i.y, i.z);
    if (s <= least + depth) second.add(i.x, i.y, i.z);
  });
  shape.first_pole = grid.patient_from_index(first.mean_index());
  shape.second_pole = grid.patient_from_index(second.mean_index());
}

void set_centre(const Case& subject, StructureShape& shape) {
  const Grid& grid = subject.labels.grid;
  shape.centre = shape.centroid;
  if (sample_nearest(subject.labels, grid.index_from_patient(shape.centroid)) == shape.label.value) return;
  double nearest = std::numeric_limits<double>::max();
  for_each_voxel(subject, shape, [&](const glm::ivec3& i) {
    const glm::dvec3 p = grid.patient_from_index(glm::dvec3(i));
    const double distance = glm::distance(p, shape.centroid);
    if (distance < nearest) {
      nearest = distance;
      shape.centre = p;
    }
  });
}

int largest_component(const glm::dvec3& axis) {
  int most = 2;
  for (const int other : {0, 1})
    if (std::abs(axis[other]) > std::abs(axis[most])) most = other;
  return most;
}

}  // namespace

glm::dvec3 marker_side(const glm::dvec3& axis) {
  const glm::dvec3 right_front_head(-axis.x, -axis.y, axis.z);
  return right_front_head[largest_component(axis)] < 0 ? -axis : axis;
}

std::string end_of_axis(const glm::dvec3& axis) {
  static const char* const words[2][3] = {{"left", "back", "upper"}, {"right", "front", "lower"}};
  const int most = largest_component(axis);
  return words[axis[most] < 0][most];
}

std::vector<StructureShape> structure_shapes(const Case& subject) {
  const Grid& grid = subject.labels.grid;
  const std::vector<Moments> moments = moments_of(subject.labels);
  std::vector<StructureShape> shapes;
  for (const Label& label : subject.label_table) {
    const Moments& m = moments[label.value];
    if (m.count == 0) continue;
    StructureShape shape;
    shape.label = label;
    shape.voxels = std::size_t(m.count);
    shape.low = m.low;
    shape.high = m.high;
    for (int a = 0; a < 3; ++a) shape.cut |= m.low[a] == 0 || m.high[a] == grid.size[a] - 1;
    shape.centroid = grid.patient_from_index(m.mean_index());
    set_axes(grid, m, shape);
    shapes.push_back(shape);
  }
  tbb::parallel_for(std::size_t(0), shapes.size(), [&](std::size_t s) {
    set_poles(subject, shapes[s]);
    set_centre(subject, shapes[s]);
  });
  return shapes;
}

const StructureShape* find_shape(const std::vector<StructureShape>& shapes, std::string_view name) {
  const auto found = std::ranges::find_if(shapes, [&](const StructureShape& one) { return one.label.name == name; });
  return found == shapes.end() ? nullptr : &*found;
}

std::optional<glm::dvec3> centre_at_height(const Case& subject, const StructureShape& shape, double z_mm,
                                           double half_mm) {
  const Grid& grid = subject.labels.grid;
  Moments slab;
  for_each_voxel(subject, shape, [&](const glm::ivec3& i) {
    if (std::abs(grid.patient_from_index(glm::dvec3(i)).z - z_mm) <= half_mm) slab.add(i.x, i.y, i.z);
  });
  if (slab.count == 0) return std::nullopt;
  return grid.patient_from_index(slab.mean_index());
}

std::optional<Contact> contact_between(const Case& subject, const StructureShape& a, const StructureShape& b,
                                       double most_mm) {
  constexpr double kAsClose_mm = 3;  // above the smallest gap: about one voxel of a coarse CT
  const Grid& grid = subject.labels.grid;
  // The search compares all pairs. It uses only surface voxels in the other structure's neighbourhood, and every second
  // one of `a`.
  const auto surface_near = [&](const StructureShape& shape, const StructureShape& other, bool thinned) {
    std::vector<glm::dvec3> points;
    for_each_voxel(subject, shape, [&](const glm::ivec3& i) {
      if (thinned && (i.x + i.y + i.z) % 2) return;
      for (int axis = 0; axis < 3; ++axis) {
        const double reach = most_mm / grid.spacing[axis];
        if (i[axis] < other.low[axis] - reach || i[axis] > other.high[axis] + reach) return;
      }
      for (int axis = 0; axis < 3; ++axis)
        for (const int step : {-1, 1}) {
          glm::ivec3 next = i;
          next[axis] += step;
          if (!grid.contains(next) || subject.labels.at(next) == shape.label.value) continue;
          points.push_back(grid.patient_from_index(glm::dvec3(i)));
          return;
        }
    });
    return points;
  };
  const std::vector<glm::dvec3> from = surface_near(a, b, true), to = surface_near(b, a, false);
  struct Nearest {
    double gap_mm = std::numeric_limits<double>::max();
    glm::dvec3 middle{0.0};
  };
  std::vector<Nearest> pairs(from.size());
  tbb::parallel_for(std::size_t(0), from.size(), [&](std::size_t p) {
    for (const glm::dvec3& q : to)
      if (const double gap = glm::distance(from[p], q); gap < pairs[p].gap_mm) pairs[p] = {gap, (from[p] + q) / 2.0};
  });
  double least = most_mm;
  for (const Nearest& pair : pairs) least = std::min(least, pair.gap_mm);
  glm::dvec3 sum(0.0);
  std::size_t count = 0;
  for (const Nearest& pair : pairs)
    if (pair.gap_mm <= least + kAsClose_mm && pair.gap_mm < most_mm) {
      sum += pair.middle;
      ++count;
    }
  if (count == 0) return std::nullopt;
  // The mean of a curved surface does not lie on it: take the pair nearest to the mean.
  const glm::dvec3 mean = sum / double(count);
  Contact contact{{}, least};
  double nearest = std::numeric_limits<double>::max();
  for (const Nearest& pair : pairs)
    if (pair.gap_mm <= least + kAsClose_mm && glm::distance(pair.middle, mean) < nearest) {
      nearest = glm::distance(pair.middle, mean);
      contact.point = pair.middle;
    }
  return contact;
}

}  // namespace insonate
