#include "tools/register/read_sweep.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

#include "devices/replay/read_log.h"
#include "devices/sequence/recorded_images.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"
#include "sim/image_headers/header_text.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/volume/dicom_series.h"
#include "tools/cli/pose_file.h"
#include "tools/register/read_dicom_sweep.h"

namespace insonate {
namespace {

constexpr double kMaxOffPlane_mm = 1;  // of the face's middle from the image, where no --face-pixel is given
constexpr std::size_t kLargestProbeFile = 1 << 20;
constexpr std::size_t kFront = 1 << 20;  // bytes of a file that may tell what it is
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

constexpr double kSamePixel = 0.01;  // by which the pixels of a recording's images may differ in size

/// An image of the recording with a usable pose.
struct Frame {
  std::uint64_t number = 0;
  Pose sweep_from_probe;
  glm::dmat4 probe_from_pixel;
};

void check_mask(const Image<std::uint8_t>& picture, const SweepInput& input) {
  if (!input.mask || (input.mask->width == picture.width && input.mask->height == picture.height)) return;
  const auto size = [](const Image<std::uint8_t>& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
  };
  throw InputError(input.mask_file, "", "it has " + size(*input.mask) + " pixels, and the images have " + size(picture),
                   "draw it over one of the images");
}

Image<float> clipped(const Image<std::uint8_t>& picture, const SweepInput& input) {
  Image<float> result(picture.width, picture.height, kUnknown);
  const auto [x, y, width, height] = input.clip.value_or(std::array{0, 0, picture.width, picture.height});
  if (x < 0 || y < 0 || width < 1 || height < 1 || width > picture.width - x || height > picture.height - y)
    throw InputError("--clip", "",
                     "the rectangle is not within the images of " + std::to_string(picture.width) + " x " +
                         std::to_string(picture.height) + " pixels",
                     "give X,Y,WIDTH,HEIGHT in pixels");
  check_mask(picture, input);
  for (int row = y; row < y + height; ++row)
    for (int column = x; column < x + width; ++column)
      if (!input.mask || input.mask->at(column, row) > 0) result.at(column, row) = float(picture.at(column, row));
  return result;
}

/// Calls `visit(pixel, place in the sweep's frame)` for each known pixel of one of the sweep's images.
template <typename AnyImage, typename Visit>
void for_each_known(const TrackedSweep& sweep, AnyImage& image, Visit&& visit) {
  const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, image.grey.width, image.grey.height);
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x)
      if (!std::isnan(image.grey.at(x, y)))
        visit(image.grey.at(x, y), image.sweep_from_probe.point(glm::dvec3(geometry.plane_mm(x, y), 0)));
}

/// Returns whether a point of the patient lies where the CT cuts the body: near an end at which there is tissue, or
/// beyond.
bool is_at_end(const Volume<std::int16_t>& ct, const glm::dvec3& point) {
  constexpr int kTissue_hu = -300;
  constexpr double kStartError_mm = 10, kMaxShare = 1.0 / 12;  // of a short CT's length
  constexpr double kMinLength_mm = 80;                         // below that, too little would be left
  const int axis = feet_head_axis(ct.grid);
  const double length_mm = ct.grid.spacing[axis] * ct.grid.size[axis];
  if (length_mm < kMinLength_mm ||
      to_end_mm(ct.grid, point) >= std::min(kEnd_mm + kStartError_mm, kMaxShare * length_mm))
    return false;
  glm::ivec3 end =
      glm::clamp(glm::ivec3(glm::round(ct.grid.index_from_patient(point))), glm::ivec3(0), ct.grid.size - 1);
  end[axis] = 2 * end[axis] < ct.grid.size[axis] ? 0 : ct.grid.size[axis] - 1;
  return ct.at(end) > kTissue_hu;
}

/// Makes other pixels unknown, and drops images of which nothing is left.
template <typename IsKept>
void keep_where(TrackedSweep& sweep, IsKept&& is_kept) {
  std::erase_if(sweep.images, [&](SweepImage& image) {
    std::size_t kept = 0;
    for_each_known(sweep, image, [&](float& grey, const glm::dvec3& at) {
      if (is_kept(grey, at))
        ++kept;
      else
        grey = kUnknown;
    });
    return kept == 0;
  });
}

}  // namespace

glm::dvec2 pixel_size(const glm::dmat4& probe_from_pixel) {
  return {glm::length(glm::dvec3(probe_from_pixel[0])), glm::length(glm::dvec3(probe_from_pixel[1]))};
}

void check_shows_fan(const std::string& file, const TrackedSweep& sweep, double least_shown) {
  double fan = 0, known = 0, sum = 0, squares = 0;
  for (const SweepImage& image : sweep.images) {
    const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, image.grey.width, image.grey.height);
    for (int y = 0; y < geometry.height; ++y)
      for (int x = 0; x < geometry.width; ++x) {
        if (!line_position(sweep.probe, sweep.depth_mm, geometry.plane_mm(x, y))) continue;
        ++fan;
        const double value = image.grey.at(x, y);
        if (std::isnan(value)) continue;
        ++known;
        sum += value;
        squares += value * value;
      }
  }
  if (known < least_shown * fan)
    throw InputError(
        file, "",
        "the images show only " + std::to_string(int(100 * known / std::max(fan, 1.0))) + " % of the probe's fan",
        "name the probe and the depth that they are from, or --face-pixel");
  if (squares / known - std::pow(sum / known, 2) < 1)
    throw InputError(file, "", "the images show nothing in the probe's fan: it is of one grey level",
                     "name the probe and the depth that they are from, or another recording");
}

FoundFan find_probe_in(const EchoSeen& seen, const glm::dmat4& probe_from_pixel, SweepInput& input) {
  Image<std::uint8_t> echo = seen.mask();
  check_mask(echo, input);
  for (std::size_t i = 0; input.mask && i < echo.pixels.size(); ++i)
    if (input.mask->pixels[i] == 0) echo.pixels[i] = 0;
  const glm::dvec2 mm = pixel_size(probe_from_pixel);
  const FanSearch search = find_fan(echo, mm);
  if (!search.fan)
    throw InputError(
        input.file, "", search.problem,
        formatted("name the probe with --probe and --depth, or with --probe-file; if a pixel is not %.3g x "
                  "%.3g mm large, give the right ImageToProbe as --image-to-probe FILE",
                  mm.x, mm.y));
  input.probe = search.fan->probe;
  input.depth_mm = search.fan->depth_mm;
  if (!input.face_pixel) input.face_pixel = search.fan->face_pixel;
  if (!input.clip) input.clip = search.fan->clip;
  return *search.fan;
}

ImagePlacement placement_of(const glm::dmat4& probe_from_pixel, const SweepInput& input) {
  const glm::dvec3 x(probe_from_pixel[0]), y(probe_from_pixel[1]), corner(probe_from_pixel[3]);
  const glm::dvec2 mm = pixel_size(probe_from_pixel);
  const glm::dmat3 axes(x / mm.x, y / mm.y, glm::cross(x, y) / (mm.x * mm.y));
  glm::dvec2 face(0.0);
  if (input.face_pixel) {
    face = *input.face_pixel;
  } else {
    const glm::dvec3 origin = glm::transpose(axes) * -corner;
    if (std::abs(origin.z) > kMaxOffPlane_mm)
      throw InputError(input.file, "",
                       "the origin of its probe's frame does not lie in the images, so it is not known where the "
                       "probe's face is",
                       "give the pixel of the face's middle as --face-pixel X,Y");
    face = glm::dvec2(origin) / mm;
  }
  return {Pose{axes, corner + face.x * x + face.y * y}, glm::dmat3(1 / mm.x, 0, 0, 0, 1 / mm.y, 0, face.x, face.y, 1)};
}

SweepImage place_image(const Image<std::uint8_t>& grey, const Pose& sweep_from_probe,
                       const glm::dmat4& probe_from_pixel, const SweepInput& input) {
  const ImagePlacement placement = placement_of(probe_from_pixel, input);
  const ImageGeometry geometry =
      image_geometry(*input.probe, input.depth_mm.value_or(input.probe->depth_mm), input.width, input.height);
  SweepImage image{sweep_from_probe * placement.probe_from_fan,
                   resampled(clipped(grey, input), placement.pixel_from_plane, geometry)};
  // Beside the fan there is nothing to compare.
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x)
      if (!line_position(*input.probe, input.depth_mm.value_or(input.probe->depth_mm), geometry.plane_mm(x, y)))
        image.grey.at(x, y) = kUnknown;
  return image;
}

namespace {

// Returns the frames that have a usable pose and a place of their image.
std::vector<Frame> usable_frames(const RecordedScan& scan, const SweepInput& input) {
  std::vector<Frame> all;
  bool is_placed = false;
  for (std::size_t n = 0; n < scan.samples.size(); ++n) {
    const RecordedImages::Frame& frame = scan.images->frames[n];
    const auto probe_from_pixel = input.probe_from_pixel ? input.probe_from_pixel : frame.probe_from_pixel;
    is_placed = is_placed || probe_from_pixel;
    if (!probe_from_pixel || scan.samples[n].status != PoseStatus::ok) continue;
    if (const auto why = why_not_image_matrix(*probe_from_pixel))
      throw InputError(input.file, "frame " + std::to_string(frame.number), "ImageToProbe: " + *why,
                       "give that matrix as --image-to-probe FILE, or calibrate and record again");
    all.push_back({frame.number, scan.samples[n].patient_from_probe, *probe_from_pixel});
  }
  if (!is_placed)
    throw InputError(
        input.file, "",
        "it does not say how its images lie in the probe's frame: ImageToProbe is missing, or invalid in all "
        "of them",
        "give that matrix as --image-to-probe FILE");
  if (scan.samples.size() < 2)
    throw InputError(input.file, "", "it has one image alone", "give a sweep of two images or more");
  if (all.size() < 2)
    throw InputError(input.file, "", "fewer than two of its images have a pose whose status is OK",
                     "name the probe's transform with --transform; frames without a status of it count as lost");
  return all;
}

// Returns true for NIfTI, and for NRRD or MetaImage without fields Seq_Frame.
bool is_volume(const std::string& file) {
  std::string front(kFront, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(front.data(), std::streamsize(front.size()));
  front.resize(std::size_t(stream.gcount()));
  const std::string name = lower_case(file);
  const auto ends_in = [&](std::initializer_list<const char*> endings) {
    return std::ranges::any_of(endings, [&](const char* ending) { return name.ends_with(ending); });
  };
  if (front.empty()) return false;
  return ends_in({".nii", ".nii.gz"}) ||
         (ends_in({".nrrd", ".mha", ".mhd"}) && front.find("Seq_Frame") == std::string::npos);
}

RecordedScan read_recording(const SweepInput& input) try {
  RecordingOptions options;
  options.transform = input.transform;
  options.without_times = true;
  return read_log(input.file, options);
} catch (const InputError&) {
  if (is_volume(input.file))
    throw InputError(input.file, "", "it is not a recording of tracked images: it has no fields Seq_Frame...",
                     "if it is a 3D ultrasound volume, say with --beam X,Y,Z in which direction the sound ran");
  throw;
}

FoundFan find_probe_in_recording(ImageReader& reader, const std::vector<Frame>& frames, SweepInput& input) {
  EchoSeen seen;
  const glm::dvec2 mm = pixel_size(frames.front().probe_from_pixel);
  const std::size_t kept = std::min(frames.size(), kMaxSearchedForFan);
  for (std::size_t i = 0; i < kept; ++i) {
    const Frame& frame = frames[(2 * i + 1) * frames.size() / (2 * kept)];
    if (glm::distance(pixel_size(frame.probe_from_pixel), mm) > kSamePixel * glm::length(mm))
      throw InputError(input.file, "frame " + std::to_string(frame.number), "its pixels have another size",
                       "record each depth on its own, and register one of them");
    seen.add(reader.grey(frame.number));
  }
  return find_probe_in(seen, frames.front().probe_from_pixel, input);
}

}  // namespace

bool is_dicom_sweep(const std::string& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;
  const bool is_dicom = is_dicom_file(file);
  if (!is_dicom && lower_case(file).ends_with(".dcm"))
    throw InputError(file, "", "it is not DICOM: DICM does not stand behind its first 128 bytes",
                     "export the clip again, or give the file another ending");
  return is_dicom;
}

ReadSweep read_sweep(const SweepInput& given) {
  if (is_dicom_sweep(given.file)) return read_dicom_sweep(given);
  SweepInput input = given;
  const RecordedScan scan = read_recording(input);
  if (!scan.images)
    throw InputError(input.file, "", "it holds no images that can be read", "record the ultrasound with the poses");
  const std::vector<Frame> all = usable_frames(scan, input);
  ReadSweep result;
  result.transform = scan.recording.transform;
  result.frames = scan.samples.size();
  result.left_out = result.frames - all.size();
  ImageReader reader(*scan.images);
  if (!input.probe) result.fan = find_probe_in_recording(reader, all, input);
  input.probe->lines = input.width;
  result.sweep.probe = *input.probe;
  result.sweep.depth_mm = input.depth_mm.value_or(input.probe->depth_mm);
  const std::size_t kept = std::min(all.size(), std::size_t(input.slices));
  for (std::size_t i = 0; i < kept; ++i) {
    const Frame& frame = all[(2 * i + 1) * all.size() / (2 * kept)];
    result.sweep.images.push_back(
        place_image(reader.grey(frame.number), frame.sweep_from_probe, frame.probe_from_pixel, input));
  }
  check_shows_fan(input.file, result.sweep);
  return result;
}

void keep_labelled(TrackedSweep& sweep, const Volume<std::uint8_t>& labels, const std::string& file) {
  keep_where(sweep, [&](float, const glm::dvec3& at) {
    return sample_nearest(labels, labels.grid.index_from_patient(at)) != 0;
  });
  if (sweep.images.size() < 2)
    throw InputError(file, "", "fewer than two images show anything inside its labels",
                     "draw it in the recording's frame, such as over sweep.nrrd of an earlier result");
}

double leave_out_ends(TrackedSweep& sweep, const Volume<std::int16_t>& ct, const glm::dmat4& ct_from_sweep) {
  std::size_t known = 0, left_out = 0;
  keep_where(sweep, [&](float, const glm::dvec3& at) {
    const bool is_left_out = is_at_end(ct, glm::dvec3(ct_from_sweep * glm::dvec4(at, 1)));
    ++known;
    left_out += is_left_out;
    return !is_left_out;
  });
  return known > 0 ? double(left_out) / double(known) : 0;
}

Probe read_probe(const std::string& file) {
  const TomlDocument document(file, read_file(file, kLargestProbeFile));
  const TomlTable root = document.root();
  const std::string kind = root.text("kind");
  const Probe* like = find_probe(kind);
  if (!like) root.fail("kind", "there is no kind of probe named '" + kind + "'", "write curvilinear, linear or phased");
  Probe probe = *like;
  if (probe.kind == ProbeKind::curvilinear) probe.radius_mm = root.number("radius_mm", {5, 200});
  if (probe.kind != ProbeKind::linear) probe.field_of_view_deg = root.number("field_of_view_deg", {5, 150});
  if (probe.kind != ProbeKind::curvilinear) probe.width_mm = root.number("width_mm", {5, 200});
  probe.depth_mm = root.number("depth_mm", {10, 400});
  root.refuse_unknown_keys();
  return probe;
}

}  // namespace insonate
