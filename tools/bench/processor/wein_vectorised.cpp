// Compiled with -O3 -ffast-math (CMakeLists.txt), so that the compiler turns each loop over lanes into vector
// instructions, its logarithms too.

#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "tools/bench/processor/wein_on_processor.h"

namespace insonate::bench {
namespace {

constexpr int kLanes = 8;

// GCC's and clang's vector extension: four values of a voxel in one load, and a value of each of eight lines.
using Four = float __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(4 * kLanes)));

// What is called per sample is inlined whole, so that it becomes instructions of the processor that its caller was
// compiled for.
#define INSONATE_INLINED [[gnu::always_inline]] inline

INSONATE_INLINED Eight least_of(const Eight& a, const Eight& b) {
  return a < b ? a : b;
}

INSONATE_INLINED Eight most_of(const Eight& a, const Eight& b) {
  return a > b ? a : b;
}

INSONATE_INLINED Eight between_0_and_1(const Eight& x) {
  return least_of(most_of(x, Eight{}), Eight{} + 1);
}

// A loop without anything else in it becomes one call of the C library's vector function.
template <typename Function>
INSONATE_INLINED Eight each(const Eight& x, Function&& function) {
  float in[kLanes], out[kLanes];
  std::memcpy(in, &x, sizeof in);
#pragma GCC unroll 1  // else the loop is unrolled before it can be vectorised
  for (int lane = 0; lane < kLanes; ++lane) out[lane] = function(in[lane]);
  Eight y;
  std::memcpy(&y, out, sizeof y);
  return y;
}

INSONATE_INLINED Eight log_of(const Eight& x) {
  return each(
      x, [](float value) __attribute__((always_inline)) { return std::log(value); });
}

INSONATE_INLINED Eight exp_of(const Eight& x) {
  return each(
      x, [](float value) __attribute__((always_inline)) { return std::exp(value); });
}

INSONATE_INLINED Eight root_of(const Eight& x) {
  return each(
      x, [](float value) __attribute__((always_inline)) { return std::sqrt(value); });
}

// A line in voxels of the CT, and its direction along the CT's axes.
struct Line {
  glm::vec3 first, step, direction;
};

Line line_in(const Grid& grid, const Pose& pose, const ScanLine& sight, const ScanLines& lines) {
  const glm::dvec3 direction = glm::transpose(grid.direction) * pose.direction(sight.direction);
  const double r = lines.r_min_mm + 0.5 * lines.dr_mm();
  return {grid.index_from_patient(pose.point(sight.start + r * sight.direction)),
          direction * lines.dr_mm() / grid.spacing, direction};
}

INSONATE_INLINED Four voxel_at(const DensityVoxel* voxel) {
  Four four;
  std::memcpy(&four, voxel, sizeof four);
  return four;
}

// Density and gradient at a position, interpolated in all four values at once.
INSONATE_INLINED Four medium_at(const DensityVoxels& ct, float x, float y, float z) {
  x = std::clamp(x, -1.0f, float(ct.grid.size.x));
  y = std::clamp(y, -1.0f, float(ct.grid.size.y));
  z = std::clamp(z, -1.0f, float(ct.grid.size.z));
  const int i = int(x + 1) - 1, j = int(y + 1) - 1, k = int(z + 1) - 1;
  const float fx = x - float(i), fy = y - float(j), fz = z - float(k);
  const DensityVoxel* at = ct.at(i, j, k);
  const auto along = [fx](const DensityVoxel* voxel) __attribute__((always_inline)) {
    const Four first = voxel_at(voxel);
    return first + fx * (voxel_at(voxel + 1) - first);
  };
  const Four near_low = along(at), near_high = along(at + ct.row);
  const Four far_low = along(at + ct.layer), far_high = along(at + ct.layer + ct.row);
  const Four low = near_low + fy * (near_high - near_low), high = far_low + fy * (far_high - far_low);
  return low + fz * (high - low);
}

INSONATE_INLINED void traverse_inlined(const DensityVoxels& ct, const ScanLines& lines, const WeinSettings& settings,
                                       const Line* eight, float* grey) {
  const float dr = float(lines.dr_mm()), exponent = float(lines.dr_mm() / settings.reflection_length_mm);
  const float compression = float(settings.compression), by_full = 1 / std::log1p(compression);
  const float dark = float(settings.dark_hu), by_range = 1 / float(settings.bright_hu - settings.dark_hu);
  const float shadow = settings.shadows ? 1.0f : 0.0f;
  const float reflection_share = float(settings.reflection_share), echo_share = 1 - reflection_share;
  const float coupling_tissue = float(kCouplingTissue_hu);
  const float by_coupling = 1 / float(kCouplingTissue_hu - kCouplingAir_hu);
  Eight dx{}, dy{}, dz{}, hu{}, gx{}, gy{}, gz{};
  for (int lane = 0; lane < kLanes; ++lane) {
    dx[lane] = eight[lane].direction.x;
    dy[lane] = eight[lane].direction.y;
    dz[lane] = eight[lane].direction.z;
  }
  Eight intensity = Eight{} + 1;
  for (int k = 0; k < lines.samples; ++k) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const glm::vec3 at = eight[lane].first + float(k) * eight[lane].step;
      const Four medium = medium_at(ct, at.x, at.y, at.z);
      hu[lane] = medium[0];
      gx[lane] = medium[1];
      gy[lane] = medium[2];
      gz[lane] = medium[3];
    }
    if (float(lines.r_min_mm) + (float(k) + 0.5f) * dr < float(settings.contact_mm)) {
      hu *= 1 - between_0_and_1((coupling_tissue - hu) * by_coupling);
      gx = gy = gz = Eight{};
    }
    const Eight mu = most_of(hu + 1000, Eight{} + float(kAirMu));
    const Eight square = most_of(gx * gx + gy * gy + gz * gz, Eight{} + 1e-20f);
    const Eight change = least_of(square / (4 * mu * mu), Eight{} + 1);  // squared
    const Eight along = dx * gx + dy * gy + dz * gz;
    const Eight cosine = most_of(along, -along) / root_of(square);
    const Eight reflection = log_of(1 + compression * intensity * change * cosine) * by_full;
    const Eight echo = between_0_and_1((hu - dark) * by_range) * (1 - shadow + shadow * intensity);
    const Eight grey_of = reflection_share * reflection + echo_share * echo;
    intensity *= exp_of(exponent * log_of(most_of(1 - change, Eight{} + 1e-20f)));
    for (int lane = 0; lane < kLanes; ++lane) grey[lane * lines.samples + k] = grey_of[lane];
  }
}

#if defined(__x86_64__)
[[gnu::target("avx2,fma")]] void traverse_by_avx2(const DensityVoxels& ct, const ScanLines& lines,
                                                  const WeinSettings& settings, const Line* eight, float* grey) {
  traverse_inlined(ct, lines, settings, eight, grey);
}
#endif

// Traverses eight lines side by side and stores the grey of each sample, line after line.
void traverse(const DensityVoxels& ct, const ScanLines& lines, const WeinSettings& settings, const Line* eight,
              float* grey) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    return traverse_by_avx2(ct, lines, settings, eight, grey);
#endif
  traverse_inlined(ct, lines, settings, eight, grey);
}

void convert(const ProcessorFan& fan, const float* grey, std::size_t from, std::size_t to, std::uint8_t* picture) {
  constexpr float kToNearest = 0.5f;  // grey is never negative, so that truncation rounds
  for (std::size_t i = from; i < to; ++i) {
    const ProcessorPixel& pixel = fan.pixels[i];
    const float* here = grey + std::size_t(pixel.line) * std::size_t(fan.lines.samples) + pixel.sample;
    const float* next = here + std::size_t(pixel.next_line) * std::size_t(fan.lines.samples);
    const float on_line = here[0] + pixel.sample_share * (here[pixel.next_sample] - here[0]);
    const float on_next = next[0] + pixel.sample_share * (next[pixel.next_sample] - next[0]);
    picture[pixel.pixel] = std::uint8_t(255 * (on_line + pixel.line_share * (on_next - on_line)) + kToNearest);
  }
}

}  // namespace

void simulate_vectorised(const DensityVoxels& ct, const ProcessorFan& fan, const WeinSettings& settings,
                         std::span<const Pose> patient_from_probe, std::span<std::uint8_t> pictures) {
  // The last group of lines repeats the last line, so that every lane has one.
  const std::size_t groups = (fan.lines.lines.size() + kLanes - 1) / kLanes;
  const std::size_t scan_size = groups * kLanes * std::size_t(fan.lines.samples);
  const auto scan = [&](const Pose& pose, std::size_t group, float* grey) {
    Line eight[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane)
      eight[lane] = line_in(ct.grid, pose, fan.lines.lines[std::min(group * kLanes + lane, fan.lines.lines.size() - 1)],
                            fan.lines);
    traverse(ct, fan.lines, settings, eight, grey + group * kLanes * std::size_t(fan.lines.samples));
  };
  const std::size_t picture_size = std::size_t(fan.width) * std::size_t(fan.height);
  if (patient_from_probe.size() == 1) {  // the cores share the image
    std::vector<float> grey(scan_size);
    tbb::parallel_for(std::size_t(0), groups,
                      [&](std::size_t group) { scan(patient_from_probe[0], group, grey.data()); });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, fan.pixels.size(), 4096), [&](const auto& range) {
      convert(fan, grey.data(), range.begin(), range.end(), pictures.data());
    });
    return;
  }
  tbb::parallel_for(std::size_t(0), patient_from_probe.size(), [&](std::size_t image) {
    thread_local std::vector<float> grey;
    grey.resize(scan_size);
    for (std::size_t group = 0; group < groups; ++group) scan(patient_from_probe[image], group, grey.data());
    convert(fan, grey.data(), 0, fan.pixels.size(), pictures.data() + image * picture_size);
  });
}

}  // namespace insonate::bench
