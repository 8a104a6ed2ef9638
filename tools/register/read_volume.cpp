#include "tools/register/read_volume.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "sim/core/grid.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/volume/ct_reader.h"
#include "tools/register/swept_planes.h"

namespace insonate {
namespace {

constexpr int kSamples = 3;         // per pixel along both of its sides
constexpr double kMinShown = 0.15;  // of the slices: a swept volume fills its box in part
constexpr double kMinAcross = 0.1;  // by which an axis has to lie across the beam to give the slices' rows

PlaneBox box_of(const Grid& grid, const glm::dvec3& beam) {
  // Rows run along the longest axis of the volume that lies across the beam.
  double longest = 0;
  glm::dvec3 along(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 across = grid.direction[axis] - glm::dot(grid.direction[axis], beam) * beam;
    const double length = glm::length(across) * grid.size[axis] * grid.spacing[axis];
    if (glm::length(across) < kMinAcross || length <= longest) continue;
    longest = length;
    along = glm::normalize(across);
  }
  PlaneBox box{glm::dmat3(along, beam, glm::cross(along, beam)), glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 index((corner & 1) * (grid.size.x - 1), (corner >> 1 & 1) * (grid.size.y - 1),
                           (corner >> 2) * (grid.size.z - 1));
    const glm::dvec3 at = glm::transpose(box.axes) * grid.patient_from_index(index);
    box.low = glm::min(box.low, at);
    box.high = glm::max(box.high, at);
  }
  return box;
}

/// Returns the side of the pixels in which the fan is looked for: planes that are not tilted need not be as coarse as
/// the volume is across them.
double pixel_mm(const Grid& grid, const PlaneBox& box, bool tilted) {
  double mm = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double across = std::abs(glm::dot(grid.direction[axis], box.axes[2]));
    if (tilted || across < 0.5) mm = std::max(mm, grid.spacing[axis]);
  }
  return mm;
}

/// The sweep that a volume shows.
struct FoundSweep {
  SweptPlanes planes;
  FoundFan fan;
  glm::dvec2 face;  ///< its middle, in each plane, mm
};

/// Returns nothing where there is no fan. The rectangle of a linear probe in parallel planes says no more than the box.
std::optional<FoundSweep> find_sweep(const Grid& grid, const PlaneBox& box,
                                     const std::function<bool(const glm::ivec3&)>& known) {
  for (const SweptPlanes& planes : {find_swept_planes(grid, box, known), SweptPlanes{box.low.z, box.high.z}}) {
    const double mm = pixel_mm(grid, box, planes.tilted);
    const FanSearch search = find_fan(known_in_planes(grid, box, planes, mm, known), glm::dvec2(mm));
    if (search.fan && (planes.tilted || search.fan->probe.kind != ProbeKind::linear))
      return FoundSweep{planes, *search.fan, glm::dvec2(box.low.x, planes.depths(box).x) + mm * search.fan->face_pixel};
    if (!planes.tilted) break;  // the others are the same
  }
  return std::nullopt;
}

std::string in_words(const FoundSweep& found) {
  const SweptPlanes& planes = found.planes;
  if (!planes.tilted) return probe_description(found.fan) + "; parallel planes";
  return probe_description(found.fan) +
         formatted("; planes tilted over %.1f degrees about a line ", glm::degrees(planes.last - planes.first)) +
         formatted("%.1f mm behind the face", found.face.y);
}

// Returns the least value that is known. A volume with numbers below 0 marks with them what is not, and black is known.
std::int16_t least_known(const Volume<std::int16_t>& volume) {
  constexpr std::size_t kFew = 100;  // a 100th of the voxels may be below 0 by interpolation
  const auto below = std::ranges::count_if(volume.voxels, [](std::int16_t value) { return value < 0; });
  return std::size_t(below) * kFew > volume.voxels.size() ? 0 : 1;
}

// Returns the mean of what is known in a pixel; NaN if most of it is not.
float value_at(const Volume<std::int16_t>& volume, std::int16_t least, const Pose& sweep_from_slice,
               const glm::dvec2& plane, double mm) {
  double sum = 0;
  int known = 0;
  for (int j = 0; j < kSamples; ++j)
    for (int i = 0; i < kSamples; ++i) {
      const glm::dvec2 part = plane + mm * (glm::dvec2(i, j) + 0.5 - kSamples / 2.0) / double(kSamples);
      const glm::dvec3 index = volume.grid.index_from_patient(sweep_from_slice.point(glm::dvec3(part, 0)));
      const glm::ivec3 nearest(glm::round(index));
      if (!volume.grid.contains(nearest) || volume.at(nearest) < least) continue;
      ++known;
      sum += volume.at(nearest);
    }
  return 2 * known > kSamples * kSamples ? float(sum / known) : std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

ReadSweep read_volume_sweep(const std::string& file, const glm::dvec3& beam, const SweepInput& input) {
  if (!(glm::length(beam) > 1e-6) || !(glm::length(beam) < 1e6))
    throw InputError("--beam", "", "it is not a direction", "give X,Y,Z in LPS, such as 0,1,0 from front to back");
  // Its images would pass for slices that lie 1 mm apart.
  for (const char* ending : {".igs.mha", ".seq.mha", ".igs.nrrd", ".seq.nrrd"})
    if (file.ends_with(ending)) throw InputError(file, "", "it is a recording, not a volume", "leave out --beam");
  const Volume<std::int16_t> volume = read_case_ct(file);
  const PlaneBox box = box_of(volume.grid, glm::normalize(beam));
  const glm::dvec3 size = box.high - box.low;
  const auto check = [&](const char* what, double value, double least, double most) {
    if (!(value >= least && value <= most))
      throw InputError(file, "", formatted("it is %.0f mm %s, not %.0f to %.0f", value, what, least, most),
                       "crop it, or see whether --beam is right");
  };
  const std::int16_t least = least_known(volume);
  const auto found = find_sweep(volume.grid, box, [&](const glm::ivec3& index) { return volume.at(index) >= least; });
  ReadSweep read;
  TrackedSweep& sweep = read.sweep;
  SweptPlanes planes{box.low.z, box.high.z};
  glm::dvec2 face((box.low.x + box.high.x) / 2, box.low.y);
  if (found) {
    planes = found->planes;
    face = found->face;
    sweep.probe = found->fan.probe;
    sweep.depth_mm = found->fan.depth_mm;
    read.found_in_volume = in_words(*found);
  } else {
    check("wide across the beam", size.x, 5, 200);
    check("deep along the beam", size.y, 10, 400);
    sweep.probe = *find_probe("linear");
    sweep.probe.width_mm = size.x;
    sweep.probe.depth_mm = sweep.depth_mm = size.y;
    read.found_in_volume = formatted("no fan; it is read as parallel planes of a linear probe %.0f mm wide", size.x);
  }
  sweep.probe.lines = input.width;
  const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, input.width, input.height);
  read.frames = std::size_t(input.slices);
  for (int slice = 0; slice < input.slices; ++slice) {
    Pose pose = planes.plane(box, (slice + 0.5) / input.slices);
    pose.translation = pose.point(glm::dvec3(face, 0));
    SweepImage image{pose, Image<float>(input.width, input.height)};
    std::size_t known = 0;
    for (int y = 0; y < input.height; ++y)
      for (int x = 0; x < input.width; ++x) {
        float& pixel = image.grey.at(x, y);
        pixel = value_at(volume, least, pose, geometry.plane_mm(x, y), geometry.mm_per_pixel);
        known += !std::isnan(pixel);
      }
    // Slices at the ends of a swept volume may be empty.
    if (known > 0) sweep.images.push_back(std::move(image));
  }
  read.left_out = read.frames - sweep.images.size();
  if (sweep.images.size() < 2)
    throw InputError(file, "", "fewer than two of its slices have a voxel that is known",
                     "give a volume of grey levels above 0");
  check_shows_fan(file, sweep, kMinShown);
  return read;
}

}  // namespace insonate
