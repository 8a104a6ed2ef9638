#include "app/registration/live_session.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/core/input_error.h"
#include "tools/cli/pose_file.h"
#include "tools/register/result_files.h"

namespace insonate {
namespace {

constexpr double kSamePixel = 0.02;     // of a pixel's size
constexpr std::size_t kFirstLook = 24;  // images in which the fan is sought first, and again at twice as many each time

/// Whether two fans are the same but for what a few pixels of echo more or less at their edges change. A depth that was
/// found too small for want of echo only leaves that part out.
bool are_alike(const FoundFan& a, const FoundFan& b) {
  constexpr double kPixels = 4, kShare = 0.03, kDepthShare = 0.25, kAngle_deg = 2;
  const auto is_near = [](double x, double y) { return std::abs(x - y) <= kShare * std::max(x, y); };
  return a.probe.kind == b.probe.kind && glm::distance(a.face_pixel, b.face_pixel) <= kPixels &&
         std::abs(a.depth_mm - b.depth_mm) <= kDepthShare * std::max(a.depth_mm, b.depth_mm) &&
         is_near(a.probe.radius_mm, b.probe.radius_mm) && is_near(a.probe.width_mm, b.probe.width_mm) &&
         std::abs(a.probe.field_of_view_deg - b.probe.field_of_view_deg) <= kAngle_deg;
}

igtl::ImagePlace place_of(const SweepInput& input) {
  return input.probe_from_pixel ? igtl::ImagePlace::by_transform : igtl::ImagePlace::by_image;
}

}  // namespace

LiveSession::LiveSession(LiveRequest request, const Case& subject, const AcousticVolume& volume)
    : request_(std::move(request)),
      input_(request_.input),
      subject_(subject),
      volume_(volume),
      stream_(request_.tracker, place_of(request_.input)),
      next_look_(kFirstLook) {}

void LiveSession::update(double now_s) {
  std::erase_if(ending_, [](const auto& registrar) { return registrar->has_ended(); });
  arrived_.clear();
  stream_.poll(now_s, arrived_);
  for (igtl::TrackedImage& image : arrived_) {
    if (width_ == 0) {
      width_ = image.grey.width;
      height_ = image.grey.height;
    }
    try {
      const std::string size = std::to_string(image.grey.width) + " x " + std::to_string(image.grey.height);
      if (image.grey.width != width_ || image.grey.height != height_)
        throw InputError(input_.file, "",
                         "its images have changed from " + std::to_string(width_) + " x " + std::to_string(height_) +
                             " to " + size + " pixels",
                         "go back to the size before, or start again");
      if (!input_.probe_from_pixel)
        if (const auto why = why_not_image_matrix(image.frame_from_pixel))
          throw InputError(input_.file, "", "its images: " + *why, "give their place as --image-to-probe FILE");
      if (const glm::dvec2 mm = pixel_size(image.frame_from_pixel); !input_.probe_from_pixel) {
        if (!pixel_mm_) pixel_mm_ = mm;
        if (glm::distance(mm, *pixel_mm_) > kSamePixel * glm::length(mm))
          throw InputError(input_.file, "", "the size of its pixels has changed, as with another depth",
                           "go back to the depth before, or start again");
      }
      if (!request_.input.probe) look_for_fan(image);
      if (input_.probe) show(std::move(image), now_s);
    } catch (const InputError& error) {
      problem_ = error.what();
    }
  }
}

void LiveSession::look_for_fan(const igtl::TrackedImage& image) {
  seen_.add(image.grey);
  if (seen_.images() < next_look_) return;
  next_look_ = fan_ ? 2 * seen_.images() : seen_.images() + kFirstLook;
  SweepInput input = request_.input;
  try {
    const FoundFan found = find_probe_in(seen_, input.probe_from_pixel.value_or(image.frame_from_pixel), input);
    next_look_ = 2 * seen_.images();
    if (fan_ && are_alike(found, *fan_)) return;
    fan_ = found;
  } catch (const InputError&) {
    if (!fan_) throw;
    return;
  }
  // A probe that was lifted off when it began shows a part of its fan, or only noise: all that was found is void.
  if (registrar_) {
    registrar_->end();  // which may take long beside other programs, and the pictures go on
    ending_.push_back(std::move(registrar_));
  }
  input_ = input;
  newest_.reset();
}

void LiveSession::show(igtl::TrackedImage image, double now_s) {
  const glm::dmat4 probe_from_pixel = input_.probe_from_pixel.value_or(image.frame_from_pixel);
  const ImagePlacement placement = placement_of(probe_from_pixel, input_);
  if (now_s - taken_s_ >= kTakenEvery_s) {
    taken_s_ = now_s;
    if (!registrar_) {
      Probe probe = *input_.probe;
      probe.lines = input_.width;
      registrar_ = std::make_unique<LiveRegistrar>(
          volume_, probe, depth_mm(), request_.start.ct_from_sweep,
          LiveRegistrarSettings{request_.settings, request_.gives_way, request_.searches},
          [this](TrackedSweep& sweep, const glm::dmat4& estimate) { return keep_what_compares(sweep, estimate); });
      registrar_->refine(request_.refines);
    }
    registrar_->add(place_image(image.grey, image.sweep_from_probe, probe_from_pixel, input_));
  }
  problem_.clear();
  newest_ = Shown{std::move(image), Pose(), placement.pixel_from_plane};
  newest_->sweep_from_fan = newest_->image.sweep_from_probe * placement.probe_from_fan;
  ++shown_count_;
}

// Called on the registrar's thread.
double LiveSession::keep_what_compares(TrackedSweep& sweep, const glm::dmat4& ct_from_sweep) const {
  constexpr double kMaxLeftOut = 0.5;
  check_shows_fan(request_.input.file, sweep);
  check_start(request_.subject, subject_.ct, sweep, ct_from_sweep);
  const double share = leave_out_ends(sweep, subject_.ct, ct_from_sweep);
  if (share > kMaxLeftOut)
    throw InputError(request_.input.file, "", "most of what the images show lies where the CT ends",
                     "move the probe away from the CT's ends");
  return share;
}

LiveRegistrar::State LiveSession::state() const {
  if (registrar_) return registrar_->state();
  LiveRegistrar::State state;
  state.ct_from_sweep = request_.start.ct_from_sweep;
  return state;
}

void LiveSession::refine(bool on) {
  request_.refines = on;
  if (registrar_) registrar_->refine(on);
}

void LiveSession::search_widely() {
  if (registrar_) registrar_->search_widely();
}

void LiveSession::reset() {
  if (registrar_) registrar_->reset();
}

std::string LiveSession::problem() const {
  if (const std::string of_stream = stream_.problem(); !of_stream.empty()) return of_stream;
  if (!problem_.empty()) return problem_;
  return state().problem;
}

std::string LiveSession::verdict() const {
  const auto last = state().last;
  return last ? insonate::verdict(last->found) : std::string();
}

std::filesystem::path LiveSession::save(const std::filesystem::path& folder) const {
  const auto last = state().last;
  if (!last)
    throw InputError(folder.string(), "", "nothing has been registered yet", "wait for the first round, and save then");
  return save(folder, *last);
}

std::filesystem::path LiveSession::save(const std::filesystem::path& to, const LiveRound& round) const {
  const std::filesystem::path folder = to.has_filename() ? to : to.parent_path();
  std::filesystem::path name = folder;
  std::error_code error;
  for (int n = 2; std::filesystem::exists(name, error); ++n) name = folder.string() + "-" + std::to_string(n);
  ReadSweep read;
  read.sweep = round.sweep;
  read.fan = fan_;
  read.frames = std::size_t(stream_.received());
  read.left_out = std::size_t(stream_.unplaced());
  read.share_at_ends = round.share_left_out;
  RegistrationReport report{
      std::string(request_.subject),    std::string(request_.tracker), read, round.settings, round.found,
      std::vector<ComparisonPictures>()};
  report.landmark_error_mm = request_.start.landmark_error_mm;
  report.device = round.device;
  write_registration(name, std::move(report), subject_.ct);
  return name;
}

}  // namespace insonate
