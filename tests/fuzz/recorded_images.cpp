// The images of a recording: read forwards and backwards, and as insonate-register takes them.
#include "devices/sequence/recorded_images.h"

#include <cmath>

#include "devices/sequence/probe_samples.h"
#include "tests/fuzz/fuzz_target.h"
#include "tools/register/read_sweep.h"

namespace insonate::fuzz {
namespace {

constexpr std::size_t kMaxRead = 8;  ///< images: more take the fuzzer's time and show nothing new

std::string broken_by_images(const std::filesystem::path& file) {
  RecordingOptions options;
  options.without_times = true;
  const RecordedScan scan = read_recorded_scan(file, options);
  if (!scan.images) return "";
  if (scan.images->frames.size() != scan.samples.size()) return "there is not an image per sample";
  const std::size_t count = std::min(scan.images->frames.size(), kMaxRead);
  std::vector<Image<std::uint8_t>> forwards;
  ImageReader reader(*scan.images);
  for (std::size_t i = 0; i < count; ++i) {
    const Image<std::uint8_t>& grey = reader.grey(scan.images->frames[i].number);
    if (std::uint64_t(grey.width) != scan.images->form.width || std::uint64_t(grey.height) != scan.images->form.height)
      return "an image has another size than the header says";
    forwards.push_back(grey);
  }
  for (std::size_t i = count; i-- > 0;)
    if (reader.grey(scan.images->frames[i].number).pixels != forwards[i].pixels)
      return "an image depends on what was read before it";
  return "";
}

std::string broken_by_sweep(const std::filesystem::path& file) {
  SweepInput input;
  input.file = file.string();
  input.probe = *find_probe("linear");
  input.depth_mm = 40;
  input.slices = 2;
  input.width = 16;
  input.height = 12;
  const ReadSweep read = read_sweep(input);
  for (const SweepImage& image : read.sweep.images) {
    if (why_not_rigid(image.sweep_from_probe.matrix(), 1e6)) return "an image's pose is not rigid";
    for (const float value : image.grey.pixels)
      if (!std::isnan(value) && !(value >= 0 && value <= 255)) return "a pixel is out of range";
  }
  return read.sweep.images.size() == 2 && read.left_out < read.frames ? "" : "it is not the sweep that was asked for";
}

const Target recorded_images_target("recorded_images", [](std::string_view bytes) -> std::string {
  const std::filesystem::path file = file_with("scan.igs.mha", bytes);
  const std::string broken = broken_by([&] { return broken_by_images(file); });
  return broken.empty() ? broken_by_sweep(file) : broken;
});

}  // namespace
}  // namespace insonate::fuzz
