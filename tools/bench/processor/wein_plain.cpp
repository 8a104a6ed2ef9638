#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/bench/processor/wein_on_processor.h"

namespace insonate::bench {
namespace {

struct Medium {
  double hu = 0;
  glm::dvec3 gradient{0};
};

Medium medium_at(const DensityVoxels& ct, const glm::dvec3& index) {
  const glm::dvec3 held = glm::clamp(index, glm::dvec3(-1), glm::dvec3(ct.grid.size));
  const glm::dvec3 floor = glm::floor(held), share = held - floor;
  Medium medium;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double weight = (i ? share.x : 1 - share.x) * (j ? share.y : 1 - share.y) * (k ? share.z : 1 - share.z);
    const DensityVoxel* voxel = ct.at(int(floor.x) + i, int(floor.y) + j, int(floor.z) + k);
    medium.hu += weight * voxel->hu;
    for (int axis = 0; axis < 3; ++axis) medium.gradient[axis] += weight * voxel->gradient[axis];
  }
  return medium;
}

}  // namespace

void simulate_plainly(const DensityVoxels& ct, const ProcessorFan& fan, const WeinSettings& settings,
                      std::span<const Pose> patient_from_probe, std::span<std::uint8_t> pictures) {
  const std::size_t samples = std::size_t(fan.lines.samples);
  const double dr = fan.lines.dr_mm(), full = std::log(1 + settings.compression);
  std::vector<double> grey(fan.lines.lines.size() * samples);
  for (std::size_t image = 0; image < patient_from_probe.size(); ++image) {
    const Pose& pose = patient_from_probe[image];
    for (std::size_t line = 0; line < fan.lines.lines.size(); ++line) {
      const ScanLine& sight = fan.lines.lines[line];
      const glm::dvec3 along_axes = glm::transpose(ct.grid.direction) * pose.direction(sight.direction);
      double intensity = 1;
      for (std::size_t k = 0; k < samples; ++k) {
        const double r = fan.lines.r_min_mm + (double(k) + 0.5) * dr;
        Medium medium = medium_at(ct, ct.grid.index_from_patient(pose.point(sight.start + r * sight.direction)));
        if (r < settings.contact_mm) {
          medium.hu *=
              1 - std::clamp((kCouplingTissue_hu - medium.hu) / (kCouplingTissue_hu - kCouplingAir_hu), 0.0, 1.0);
          medium.gradient = glm::dvec3(0);
        }
        const double mu = std::max(medium.hu + 1000, kAirMu);
        const double steepness = glm::length(medium.gradient), change = std::min(steepness / (2 * mu), 1.0);
        const double cosine = steepness > 0 ? std::abs(glm::dot(along_axes, medium.gradient)) / steepness : 0;
        const double reflection = std::log(1 + settings.compression * intensity * change * change * cosine) / full;
        double echogenicity =
            std::clamp((medium.hu - settings.dark_hu) / (settings.bright_hu - settings.dark_hu), 0.0, 1.0);
        if (settings.shadows) echogenicity *= intensity;
        grey[line * samples + k] =
            settings.reflection_share * reflection + (1 - settings.reflection_share) * echogenicity;
        intensity *= std::pow(1 - change * change, dr / settings.reflection_length_mm);
      }
    }

    const auto picture = pictures.subspan(image * std::size_t(fan.width) * std::size_t(fan.height));
    for (const ProcessorPixel& pixel : fan.pixels) {
      const double* here = grey.data() + std::size_t(pixel.line) * samples + pixel.sample;
      const double* next = here + std::size_t(pixel.next_line) * samples;
      const double on_line = here[0] + pixel.sample_share * (here[pixel.next_sample] - here[0]);
      const double on_next = next[0] + pixel.sample_share * (next[pixel.next_sample] - next[0]);
      picture[std::size_t(pixel.pixel)] =
          std::uint8_t(std::lround(255 * (on_line + pixel.line_share * (on_next - on_line))));
    }
  }
}

}  // namespace insonate::bench
