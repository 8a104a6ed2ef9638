#include "tools/register/read_dicom_sweep.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/volume/dicom_ultrasound.h"

namespace insonate {
namespace {

constexpr double kSamePixelSize = 0.05;  // of a calibration and the machine's own calibration

// Returns how the images lie in the frame of the poses, apart from the place of its origin.
glm::dmat4 matrix_of(const SweepInput& input, const DicomUltrasound& clip) {
  if (!input.probe_from_pixel) {
    if (!clip.region)
      throw InputError(input.file, "", "it has no ultrasound region that gives the size of its pixels",
                       "give the images' matrix as --image-to-probe FILE");
    glm::dmat4 scale(1.0);
    scale[0][0] = clip.region->pixel_mm.x;
    scale[1][1] = clip.region->pixel_mm.y;
    return scale;
  }
  const glm::dvec2 mm = pixel_size(*input.probe_from_pixel);
  for (int axis = 0; clip.region && axis < 2; ++axis)
    if (const double own = clip.region->pixel_mm[axis]; std::abs(mm[axis] - own) > kSamePixelSize * own)
      throw InputError("--image-to-probe", "",
                       formatted("its pixels are %.4f x %.4f mm large, and those of the clip %.4f x %.4f mm", mm.x,
                                 mm.y, clip.region->pixel_mm.x, clip.region->pixel_mm.y),
                       "take the calibration for this depth");
  return *input.probe_from_pixel;
}

void blacken_outside(Image<std::uint8_t>& image, const std::array<int, 4>& rectangle) {
  const auto [left, top, width, height] = rectangle;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (x < left || y < top || x >= left + width || y >= top + height) image.at(x, y) = 0;
}

}  // namespace

ReadSweep read_dicom_sweep(const SweepInput& given) {
  SweepInput input = given;
  const DicomUltrasound clip = read_dicom_ultrasound(input.file);
  if (!input.transform.empty())
    throw InputError("--transform", "", "DICOM ultrasound has no transforms", "leave it out, and give --poses FILE");
  if (!input.poses)
    throw InputError(input.file, "", "DICOM does not say where the probe was",
                     "give a pose for each of its " + count_of(clip.frames, "image") + " as --poses FILE");
  if (input.poses->size() != clip.frames)
    throw InputError(
        "--poses", "",
        "there are " + count_of(input.poses->size(), "pose") + ", and the clip has " + count_of(clip.frames, "image"),
        "write one matrix per image");
  if (clip.frames < 2) throw InputError(input.file, "", "it has one image", "name a clip of a sweep");
  glm::dmat4 probe_from_pixel = matrix_of(input, clip);
  if (!input.probe_from_pixel && input.probe && !input.face_pixel)
    throw InputError(input.file, "", "it does not say where the probe's face is in its images",
                     "give the pixel of the face's middle as --face-pixel X,Y, or leave out --probe");

  // So many that both the sweep's images and those that are looked at lie evenly.
  const auto slices = std::size_t(input.slices);
  const std::size_t kept = std::min(clip.frames, slices * ((kMaxSearchedForFan + slices - 1) / slices));
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < kept; ++i) numbers.push_back((2 * i + 1) * clip.frames / (2 * kept));
  std::vector<Image<std::uint8_t>> images = read_dicom_frames(input.file, numbers);
  if (clip.region)
    for (Image<std::uint8_t>& image : images) blacken_outside(image, clip.region->rectangle);

  ReadSweep result;
  result.frames = clip.frames;
  if (!input.probe) {
    EchoSeen seen;
    for (const Image<std::uint8_t>& image : images) seen.add(image);
    result.fan = find_probe_in(seen, probe_from_pixel, input);
  }
  if (!input.clip && clip.region) input.clip = clip.region->rectangle;
  if (!input.probe_from_pixel)
    for (int axis = 0; axis < 2; ++axis)
      probe_from_pixel[3][axis] = -(*input.face_pixel)[axis] * probe_from_pixel[axis][axis];
  input.probe->lines = input.width;
  result.sweep.probe = *input.probe;
  result.sweep.depth_mm = input.depth_mm.value_or(input.probe->depth_mm);
  const std::size_t used = std::min(kept, slices);
  for (std::size_t i = 0; i < used; ++i) {
    const std::size_t n = (2 * i + 1) * kept / (2 * used);
    result.sweep.images.push_back(place_image(images[n], (*input.poses)[numbers[n]], probe_from_pixel, input));
  }
  check_shows_fan(input.file, result.sweep);
  return result;
}

}  // namespace insonate
