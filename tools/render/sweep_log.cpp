#include "tools/render/sweep_log.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "devices/replay/read_log.h"
#include "sim/core/input_error.h"
#include "sim/reconstruction/sweep_extent.h"
#include "tools/cli/pose_file.h"

namespace insonate {
namespace {

/// A picture without its pixels, and its number in the file.
struct PlacedFrame {
  TrackedPicture picture;
  std::uint64_t number = 0;
};

std::shared_ptr<const PictureRegion> region_of(const RecordedImages& images, const glm::dmat4& probe_from_pixel,
                                               const SweepLogSettings& settings) {
  const int width = int(images.form.width), height = int(images.form.height);
  PixelRectangle part{0, 0, width, height};
  if (settings.clip) {
    const auto [x, y, clip_width, clip_height] = *settings.clip;
    if (x < 0 || y < 0 || clip_width < 1 || clip_height < 1 || clip_width > width - x || clip_height > height - y)
      throw InputError("--clip", "",
                       "the rectangle is not within the images of " + std::to_string(width) + " x " +
                           std::to_string(height) + " pixels",
                       "give X,Y,WIDTH,HEIGHT in pixels");
    part = {x, y, clip_width, clip_height};
  }
  if (!settings.probe) return rectangle_region(width, height, part);
  const auto region = region_where(width, height, [&](int x, int y) {
    const bool clipped = x < part.x || y < part.y || x >= part.x + part.width || y >= part.y + part.height;
    const glm::dvec4 at = probe_from_pixel * glm::dvec4(x, y, 0, 1);
    return !clipped && line_position(*settings.probe, settings.depth_mm, glm::dvec2(at)).has_value();
  });
  if (region->outline.empty())
    throw InputError("--depth", "", "the images show nothing of the probe's fan", "name the probe that they are from");
  return region;
}

std::vector<PlacedFrame> placed_frames(const std::string& file, const RecordedScan& scan,
                                       const SweepLogSettings& settings) {
  std::vector<PlacedFrame> frames;
  std::shared_ptr<const PictureRegion> region;
  bool placed = settings.probe_from_pixel.has_value();
  for (std::size_t n = 0; n < scan.samples.size(); ++n) {
    const RecordedImages::Frame& frame = scan.images->frames[n];
    const auto probe_from_pixel = settings.probe_from_pixel ? settings.probe_from_pixel : frame.probe_from_pixel;
    placed = placed || probe_from_pixel;
    if (!probe_from_pixel || scan.samples[n].status != PoseStatus::ok) continue;
    if (const auto why = why_not_image_matrix(*probe_from_pixel))
      throw InputError(file, "frame " + std::to_string(frame.number), "ImageToProbe: " + *why,
                       "give that matrix as --image-to-probe FILE, or calibrate and record again");
    if (!region) region = region_of(*scan.images, *probe_from_pixel, settings);
    PlacedFrame taken;
    taken.picture.region = region;
    taken.picture.patient_from_pixel = scan.samples[n].patient_from_probe.matrix() * *probe_from_pixel;
    taken.picture.time_s = scan.samples[n].time_s;
    taken.number = frame.number;
    frames.push_back(std::move(taken));
  }
  if (!placed)
    throw InputError(file, "", "it does not say how its images lie in the probe's frame: ImageToProbe is missing",
                     "give that matrix as --image-to-probe FILE");
  if (frames.size() < 2)
    throw InputError(file, "", "fewer than two of its images have a pose", "name the probe's with --transform");
  return frames;
}

}  // namespace

ReconstructedLog reconstruct_log(const std::string& file, const SweepLogSettings& settings) {
  RecordingOptions options;
  options.transform = settings.transform;
  options.without_times = true;
  const RecordedScan scan = read_log(file, options);
  if (!scan.images)
    throw InputError(file, "", "it holds no images that can be read", "record the ultrasound with the poses");
  const std::vector<PlacedFrame> frames = placed_frames(file, scan, settings);
  std::vector<TrackedPicture> poses;
  for (const PlacedFrame& frame : frames) poses.push_back(frame.picture);
  const GridChoice choice = choose_grid(poses, settings.voxel_mm);
  Reconstruction reconstruction(choice.grid, settings.reconstruction);
  ImageReader reader(*scan.images);
  for (const PlacedFrame& frame : frames) {
    TrackedPicture picture = frame.picture;
    picture.grey = reader.grey(frame.number);
    reconstruction.add(picture);
  }
  const SweepLimits limits{std::max(settings.beam_mm, choice.grid.spacing.x), settings.reconstruction.hole_radius_mm};
  ReconstructedLog made;
  made.volume = reconstruction.filled();
  made.quality = sweep_quality(poses, limits);
  made.remark = choice.remark;
  made.left_out = scan.samples.size() - frames.size();
  made.has_times = !scan.recording.assumed_rate_hz;
  return made;
}

}  // namespace insonate
