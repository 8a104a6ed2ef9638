#include "app/recording/run_files.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "devices/record/recording_files.h"

namespace insonate {
namespace {

/// Returns the file's name with `addition` inserted before its ending.
std::filesystem::path with_addition(const std::filesystem::path& file, const std::string& addition) {
  std::string name = file.filename().string();
  std::size_t ending = file.stem().string().size();
  for (const std::string_view known : {".igs.mha", ".seq.mha", ".mha"})
    if (name.ends_with(known)) ending = std::min(ending, name.size() - known.size());
  std::filesystem::path named = file;
  return named.replace_filename(name.insert(ending, addition));
}

bool is_unused(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path candidates[] = {file, working_file(file), images_file(file)};
  return std::none_of(std::begin(candidates), std::end(candidates),
                      [&](const auto& candidate) { return std::filesystem::exists(candidate, error); });
}

/// Returns the first of FILE, FILE-2, FILE-3... for which no file exists yet.
std::filesystem::path next_unused(const std::filesystem::path& file) {
  for (int part = 1;; ++part) {
    std::filesystem::path candidate = part_of(file, part);
    if (is_unused(candidate) && is_unused(images_of(candidate))) return candidate;
  }
}

/// Resamples a picture to a size: each new pixel takes the old pixel that contains its centre.
Image<std::uint8_t> sampled(const Image<std::uint8_t>& picture, int width, int height) {
  if (picture.width == width && picture.height == height) return picture;
  Image<std::uint8_t> made(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      made.at(x, y) =
          picture.at((2 * x + 1) * picture.width / (2 * width), (2 * y + 1) * picture.height / (2 * height));
  return made;
}

/// Returns the transform from pixels of a resampled picture to the probe's frame.
glm::dmat4 probe_from_pixel(const ImageGeometry& geometry, int width, int height) {
  const glm::dvec2 scale(double(geometry.width) / width, double(geometry.height) / height);
  const glm::dvec2 step = geometry.mm_per_pixel * scale;
  // Centre of the first new pixel, in pixels of the old size.
  const glm::dvec2 first = geometry.plane_mm((scale.x - 1) / 2, (scale.y - 1) / 2);
  return {{step.x, 0, 0, 0}, {0, step.y, 0, 0}, {0, 0, 1, 0}, {first.x, first.y, 0, 1}};
}

}  // namespace

std::filesystem::path images_of(const std::filesystem::path& file) {
  return with_addition(file, "-images");
}

std::filesystem::path part_of(const std::filesystem::path& file, int part) {
  return part == 1 ? file : with_addition(file, "-" + std::to_string(part));
}

RunFiles::RunFiles(std::filesystem::path file, bool exactly, bool with_pictures)
    : file_(std::move(file)), with_pictures_(with_pictures) {
  const std::filesystem::path first = exactly ? file_ : next_unused(file_);
  if (with_pictures_) refuse_existing(images_of(first));
  poses_ = std::make_unique<SequenceRecorder>(first);
}

void RunFiles::begin_next() {
  finish();
  pictures_.reset();
  poses_ = std::make_unique<SequenceRecorder>(next_unused(file_));
}

void RunFiles::add(const std::vector<ProbeSample>& samples, const ActionLog& actions) {
  for (const ProbeSample& sample : samples) {
    const auto done = actions.find(sample.time_s);
    poses_->add(sample, done == actions.end() ? std::string() : to_text(done->second));
  }
  poses_->flush();
}

void RunFiles::add(const DrawnPicture& picture) {
  if (!with_pictures_ || (pictures_ && !(picture.time_s > picture_s_))) return;
  if (!pictures_) {
    width_ = picture.grey.width;
    height_ = picture.grey.height;
    pictures_ = std::make_unique<SequenceRecorder>(images_of(file()), width_, height_);
  }
  picture_s_ = picture.time_s;
  pictures_->add({picture.time_s, PoseStatus::ok, picture.patient_from_probe, 0},
                 sampled(picture.grey, width_, height_), probe_from_pixel(picture.geometry, width_, height_));
  pictures_->flush();
}

void RunFiles::finish() {
  if (pictures_) pictures_->finish();
  poses_->finish();
}

}  // namespace insonate
