// Resamples one axis at a time, which is an order of magnitude faster than 64 coefficients per voxel. The user waits
// for it between choosing a patient and seeing one.

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sim/volume/ct_reader.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

constexpr double kSpacingTolerance = 0.2;
constexpr std::size_t kLanes = 64;  // neighbouring lines are filtered together, so that strides cost nothing

// A new sample nearer to an old sample than this counts as on it, in old indices. Spacings that headers hold in single
// precision add up to 6e-5 over a thousand samples. A CT's steepest edges change by less than half a unit over 1e-4.
constexpr double kOnSample = 1e-4;

/// Places the new samples of an axis among the old ones, in old indices.
struct AxisPlan {
  int before = 0, after = 0;  ///< samples
  double first = 0, step = 0;

  double position(int sample) const {
    const double exact = first + step * sample, whole = std::round(exact);
    return std::abs(exact - whole) < kOnSample ? whole : exact;
  }
  /// Each returns the old sample on one side. Both return the same one where a new sample is on an old one: the samples
  /// beyond do not contribute to the spline's value there, and rounding would otherwise decide which side counts.
  int below(int sample) const { return std::clamp(int(std::floor(position(sample))), 0, before - 1); }
  int above(int sample) const { return std::clamp(int(std::ceil(position(sample))), 0, before - 1); }
};

/// Returns an index mirrored at the ends of 0 .. n - 1, as the spline continues there.
std::size_t mirrored(int i, int n) {
  const int period = 2 * (n - 1);
  i = ((i % period) + period) % period;
  return std::size_t(i < n ? i : period - i);
}

/// Converts samples to the coefficients of the cubic B-spline through them, in place, for `lanes` lines side by side.
/// This is the recursive filter of M. Unser, Splines: a perfect fit for signal and image processing, IEEE Signal
/// Processing Magazine 16(6), 1999, box 2, with mirrored ends.
void to_coefficients(float* samples, int n, std::size_t lanes) {
  static const float pole = float(std::sqrt(3.0) - 2.0);
  constexpr int kHorizon = 24;  // |pole|^24 is below float's last bit
  const auto at = [&](int i) { return samples + std::size_t(i) * lanes; };

  std::array<float, kLanes> start{};
  float power = 1;
  for (int k = 0; k <= kHorizon; ++k, power *= pole)
    for (std::size_t l = 0; l < lanes; ++l) start[l] += power * at(int(mirrored(k, n)))[l];
  std::copy_n(start.begin(), lanes, at(0));
  for (int i = 1; i < n; ++i)
    for (std::size_t l = 0; l < lanes; ++l) at(i)[l] += pole * at(i - 1)[l];
  for (std::size_t l = 0; l < lanes; ++l)
    at(n - 1)[l] = pole / (pole * pole - 1) * (at(n - 1)[l] + pole * at(n - 2)[l]);
  for (int i = n - 2; i >= 0; --i)
    for (std::size_t l = 0; l < lanes; ++l) at(i)[l] = pole * (at(i + 1)[l] - at(i)[l]);
  for (int i = 0; i < n; ++i)
    for (std::size_t l = 0; l < lanes; ++l) at(i)[l] *= 6;
}

/// The four B-spline weights and coefficients for one new sample.
struct Taps {
  std::array<std::size_t, 4> index;
  std::array<float, 4> weight;
};

std::vector<Taps> taps_of(const AxisPlan& axis) {
  std::vector<Taps> taps(std::size_t(axis.after));
  for (int s = 0; s < axis.after; ++s) {
    const double floor = std::floor(axis.position(s));
    const double t = axis.position(s) - floor;
    Taps& tap = taps[std::size_t(s)];
    for (int k = 0; k < 4; ++k) tap.index[std::size_t(k)] = mirrored(int(floor) - 1 + k, axis.before);
    tap.weight = {float((1 - t) * (1 - t) * (1 - t) / 6), float(2.0 / 3 - t * t * (2 - t) / 2),
                  float(2.0 / 3 - (1 - t) * (1 - t) * (1 + t) / 2), float(t * t * t / 6)};
  }
  return taps;
}

/// Resamples the middle axis of an array [outer][axis.before][inner].
std::vector<float> resample_axis(const std::vector<float>& in, const AxisPlan& axis, std::size_t inner) {
  const std::size_t before = std::size_t(axis.before), after = std::size_t(axis.after);
  const std::size_t outer = in.size() / (before * inner), chunks = (inner + kLanes - 1) / kLanes;
  const std::vector<Taps> taps = taps_of(axis);
  std::vector<float> out(outer * after * inner);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, outer * chunks), [&](const auto& range) {
    std::vector<float> line(before * kLanes);
    for (std::size_t piece = range.begin(); piece != range.end(); ++piece) {
      const std::size_t first = piece % chunks * kLanes, lanes = std::min(kLanes, inner - first);
      const float* from = in.data() + piece / chunks * before * inner + first;
      float* to = out.data() + piece / chunks * after * inner + first;
      for (std::size_t i = 0; i < before; ++i) std::copy_n(from + i * inner, lanes, line.data() + i * lanes);
      to_coefficients(line.data(), axis.before, lanes);
      for (std::size_t s = 0; s < after; ++s) {
        const Taps& tap = taps[s];
        for (std::size_t l = 0; l < lanes; ++l) {
          float sum = 0;
          for (std::size_t k = 0; k < 4; ++k) sum += tap.weight[k] * line[tap.index[k] * lanes + l];
          to[s * inner + l] = sum;
        }
      }
    }
  });
  return out;
}

/// Rounds, and clamps overshoot to the range of the surrounding old voxels: eight, fewer in an old plane, one on a
/// voxel.
void cut_overshoot(const Volume<std::int16_t>& ct, const std::array<AxisPlan, 3>& axes,
                   const std::vector<float>& smooth, Volume<std::int16_t>& out) {
  tbb::parallel_for(tbb::blocked_range<int>(0, out.grid.size.z), [&](const auto& slices) {
    const std::size_t width = std::size_t(ct.grid.size.x);
    std::vector<std::int16_t> least(width), most(width);
    for (int z = slices.begin(); z != slices.end(); ++z)
      for (int y = 0; y < out.grid.size.y; ++y) {
        const std::int16_t* rows[4];
        for (int r = 0; r < 4; ++r)
          rows[r] =
              &ct.at({0, r & 1 ? axes[1].above(y) : axes[1].below(y), r & 2 ? axes[2].above(z) : axes[2].below(z)});
        for (std::size_t x = 0; x < width; ++x) {
          least[x] = std::min({rows[0][x], rows[1][x], rows[2][x], rows[3][x]});
          most[x] = std::max({rows[0][x], rows[1][x], rows[2][x], rows[3][x]});
        }
        std::size_t v = out.grid.offset({0, y, z});
        for (int x = 0; x < out.grid.size.x; ++x, ++v) {
          const std::size_t a = std::size_t(axes[0].below(x)), b = std::size_t(axes[0].above(x));
          out.voxels[v] = std::int16_t(std::lround(
              std::clamp(smooth[v], float(std::min(least[a], least[b])), float(std::max(most[a], most[b])))));
        }
      }
  });
}

}  // namespace

Volume<std::int16_t> resample_isotropic(const Volume<std::int16_t>& ct, double spacing_mm, const std::string& file) {
  const Grid& old = ct.grid;
  bool close = true;
  for (int a = 0; a < 3; ++a) close &= std::abs(old.spacing[a] / spacing_mm - 1) <= kSpacingTolerance;
  if (close) return ct;

  Volume<std::int16_t> out;
  out.grid = old;
  out.grid.spacing = glm::dvec3(spacing_mm);
  std::array<AxisPlan, 3> axes;
  glm::dvec3 first;
  std::array<std::uint64_t, 3> sides;
  for (int a = 0; a < 3; ++a) {
    const double box = old.size[a] * old.spacing[a];
    const double samples = std::max(2.0, std::round(box / spacing_mm));
    sides[std::size_t(a)] = std::uint64_t(std::min(samples, 1e9));
    // The new samples' box has the same centre as the old one; the sizes differ by less than one new voxel.
    first[a] = ((box - (samples - 1) * spacing_mm) / old.spacing[a] - 1) / 2;
    axes[std::size_t(a)] = {old.size[a], int(sides[std::size_t(a)]), first[a], spacing_mm / old.spacing[a]};
  }
  check_size(file + ", in the voxels of equal sides that it is resampled to", sides[0], sides[1], sides[2]);
  out.grid.size = {axes[0].after, axes[1].after, axes[2].after};
  out.grid.origin = old.patient_from_index(first);

  std::vector<float> smooth(ct.voxels.begin(), ct.voxels.end());
  smooth = resample_axis(smooth, axes[0], 1);
  smooth = resample_axis(smooth, axes[1], std::size_t(axes[0].after));
  smooth = resample_axis(smooth, axes[2], std::size_t(axes[0].after) * std::size_t(axes[1].after));
  out.voxels.resize(out.grid.count());
  cut_overshoot(ct, axes, smooth, out);
  return out;
}

}  // namespace insonate
