#include "sim/reference/wave_reference.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/model/beam.h"
#include "sim/model/compounding.h"
#include "sim/model/waves.h"

namespace insonate {
namespace {

using Wave = Image<std::complex<double>>;

/// A box in the probe's frame that holds every scatterer that reaches a sample, mm.
struct Box {
  glm::dvec3 low{1e300}, high{-1e300};
};

Box box_of(const ScanLines& lines, const Settings& settings) {
  Box box;
  const double dr = lines.dr_mm();
  double thickness = 0;
  for (const ScanLine& line : lines.lines)
    for (const double r : {lines.r_min_mm - dr, lines.r_max_mm + dr}) {
      box.low = glm::min(box.low, line.start + r * line.direction);
      box.high = glm::max(box.high, line.start + r * line.direction);
      thickness = std::max(thickness, slice_thickness_at_mm(settings, r));
    }
  // Scatterers beside the outer lines reach them from one line's distance; the arc's sagitta is shorter than that.
  const LineFan& fan = lines.fan;
  const double apex = fan.face == LineFan::Face::flat ? fan.apex_mm / std::cos(fan.first) : fan.apex_mm;
  const double beside = 2 * fan.step * (fan.face == LineFan::Face::parallel ? 1 : apex + lines.r_max_mm + dr);
  box.low -= glm::dvec3(beside, beside, 0);
  box.high += glm::dvec3(beside, beside, 0);
  box.low.z = -kSliceHalf * thickness;
  box.high.z = kSliceHalf * thickness;
  return box;
}

/// Adds a scatterer to the samples around it.
void add(Wave& sums, const ScanLines& lines, const Settings& settings, const glm::dvec3& at,
         const std::complex<double>& amplitude) {
  const LinePosition place = position_among(lines.fan, {at.x, at.y});
  const double window = slice_window(at.z, slice_thickness_at_mm(settings, place.r_mm));
  if (window <= 0) return;
  const double sample = (place.r_mm - lines.r_min_mm) / lines.dr_mm() - 0.5;
  const std::complex<double> echo = amplitude * window;
  for (int line = int(std::floor(place.line)); line <= std::floor(place.line) + 1; ++line)
    for (int k = int(std::floor(sample)); k <= std::floor(sample) + 1; ++k)
      if (line >= 0 && line < sums.width && k >= 0 && k < sums.height)
        sums.at(line, k) += echo * ((1 - std::abs(place.line - line)) * (1 - std::abs(sample - k)));
}

}  // namespace

Wave scatterers_reference(const ScanLines& lines, const Settings& settings, const Pose& patient_from_probe) {
  Wave sums(int(lines.lines.size()), lines.samples);
  if (!settings.speckle) {
    std::ranges::fill(sums.pixels, std::complex<double>(0, 1));
    return sums;
  }

  const glm::dmat4 cells_from_probe =
      cells_from_patient(scatterer_pitch_mm(lines, settings)) * patient_from_probe.matrix();
  const glm::dmat4 probe_from_cells = glm::inverse(cells_from_probe);
  const Box box = box_of(lines, settings);
  glm::dvec3 low(1e300), high(-1e300);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at(corner & 1 ? box.low.x : box.high.x, corner & 2 ? box.low.y : box.high.y,
                        corner & 4 ? box.low.z : box.high.z);
    const glm::dvec3 cell(cells_from_probe * glm::dvec4(at, 1));
    low = glm::min(low, cell);
    high = glm::max(high, cell);
  }
  const std::array<std::uint32_t, 3> phase = phase_steps(probe_from_cells, settings, lines.fan.steering);
  const auto quarters = [&](const glm::ivec3& cell, const glm::dvec3& place) {  // q of sim/model/compounding.h
    std::uint32_t turn = 0;
    for (int axis = 0; axis < 3; ++axis)
      turn += phase[std::size_t(axis)] * (std::uint32_t(cell[axis]) * 1024u + std::uint32_t(place[axis] * 1024));
    return turn >> 30;
  };
  // Of each row of cells along z, the part that the box cuts out.
  const glm::dvec3 step(probe_from_cells[2]);
  for (int x = int(std::floor(low.x)); x <= high.x; ++x)
    for (int y = int(std::floor(low.y)); y <= high.y; ++y) {
      const glm::dvec3 middle(probe_from_cells * glm::dvec4(x + 0.5, y + 0.5, 0.5, 1));
      double first = std::floor(low.z), last = std::floor(high.z);
      for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(step[axis]) < 1e-9) continue;
        // A scatterer lies within a cell's half diagonal of the cell's middle, less than 0.87 of its side.
        const double margin = 0.87 * scatterer_pitch_mm(lines, settings);
        const double a = (box.low[axis] - margin - middle[axis]) / step[axis],
                     b = (box.high[axis] + margin - middle[axis]) / step[axis];
        first = std::max(first, std::ceil(std::min(a, b)));
        last = std::min(last, std::floor(std::max(a, b)));
      }
      for (int z = int(first); z <= last; ++z) {
        const Scatterer scatterer = scatterer_of({x, y, z}, settings.speckle_seed);
        const glm::dvec3 at(probe_from_cells * glm::dvec4(glm::dvec3(x, y, z) + scatterer.place, 1));
        std::complex<double> amplitude = scatterer.amplitude;
        for (std::uint32_t quarter = quarters({x, y, z}, scatterer.place); quarter > 0; --quarter)
          amplitude = {-amplitude.imag(), amplitude.real()};
        add(sums, lines, settings, at, amplitude);
      }
    }
  const std::vector<double> scale = scatterer_scale(lines, settings);
  for (int k = 0; k < sums.height; ++k)
    for (int line = 0; line < sums.width; ++line) sums.at(line, k) *= scale[std::size_t(k)];
  return sums;
}

Wave wave_reference(const Wave& echo, const ScanLines& lines, const Settings& settings) {
  const std::vector<double> pulse = pulse_weights(lines, settings);
  const int radius = int(pulse.size() / 2);
  Wave pulsed(echo.width, echo.height);
  for (int line = 0; line < echo.width; ++line)
    for (int k = 0; k < echo.height; ++k)
      for (int m = -radius; m <= radius; ++m)
        if (k + m >= 0 && k + m < echo.height)
          pulsed.at(line, k) += pulse[std::size_t(m + radius)] * echo.at(line, k + m);

  const std::vector<double> sigma = focused_beam_sigma(lines, settings);
  Wave wave(echo.width, echo.height);
  for (int k = 0; k < echo.height; ++k) {
    const std::vector<double> weights = beam_weights_at(settings, sigma[std::size_t(k)]);
    const int half = int(weights.size() / 2);
    for (int line = 0; line < echo.width; ++line)
      for (int j = -half; j <= half; ++j)
        if (line + j >= 0 && line + j < echo.width)
          wave.at(line, k) += weights[std::size_t(j + half)] * pulsed.at(line + j, k);
  }
  return wave;
}

}  // namespace insonate
