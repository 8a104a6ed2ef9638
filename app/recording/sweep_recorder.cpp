#include "app/recording/sweep_recorder.h"

#include <algorithm>
#include <utility>

#include "sim/core/input_error.h"
#include "sim/reconstruction/growing_volume.h"
#include "sim/reconstruction/sweep_extent.h"
#include "sim/volume/ct_reader.h"

namespace insonate {
namespace {

bool same_geometry(const ImageGeometry& a, const ImageGeometry& b) {
  return a.width == b.width && a.height == b.height && a.mm_per_pixel == b.mm_per_pixel &&
         a.top_left_mm == b.top_left_mm;
}

}  // namespace

void write_swept(const std::filesystem::path& nrrd_file, const SweptVolume& swept) {
  write_labels(nrrd_file, swept.volume.grey);
  std::filesystem::path known = nrrd_file;
  known.replace_filename(nrrd_file.stem().string() + "-known.nrrd");
  write_labels(known, swept.volume.known);
}

SweepRecorder::~SweepRecorder() {
  const std::lock_guard lock(mutex_);
  dropped_ = true;
  changed_.notify_all();
}

void SweepRecorder::start() {
  if (running_ || reconstructing()) return;
  wait();
  running_ = true;
  attempt_ = 0;
  bytes_ = 0;
  meter_ = SweepMeter({std::max(kBeam_mm, kVoxel_mm), ReconstructionSettings().hole_radius_mm});
  region_.reset();
  waiting_.clear();
  finished_.reset();
  ending_ = full_ = false;
  busy_ = true;
  thread_ = std::jthread([this] { run(); });
}

void SweepRecorder::stop() {
  if (!std::exchange(running_, false)) return;
  const std::lock_guard lock(mutex_);
  final_quality_ = meter_.quality();
  ending_ = true;
  changed_.notify_all();
}

bool SweepRecorder::reconstructing() const {
  const std::lock_guard lock(mutex_);
  return busy_ && !running_;
}

std::shared_ptr<const PictureRegion> SweepRecorder::region_of(const DrawnPicture& picture) {
  const bool same = region_ && picture.probe == shown_by_region_.probe &&
                    picture.depth_mm == shown_by_region_.depth_mm &&
                    same_geometry(picture.geometry, shown_by_region_.geometry);
  if (same) return region_;
  const Probe* probe = find_probe(picture.probe);
  if (!probe) return nullptr;
  region_ = fan_region(*probe, picture.depth_mm, picture.geometry);
  shown_by_region_.probe = picture.probe;
  shown_by_region_.depth_mm = picture.depth_mm;
  shown_by_region_.geometry = picture.geometry;
  return region_;
}

void SweepRecorder::take(const DrawnPicture& picture) {
  if (!running_) return;
  if (attempt_ != 0 && picture.attempt != attempt_) return stop();
  if (picture.frozen || (attempt_ != 0 && picture.time_s <= last_s_)) return;
  std::shared_ptr<const PictureRegion> region = region_of(picture);
  if (!region || region->outline.empty()) return;
  attempt_ = picture.attempt;
  last_s_ = picture.time_s;
  TrackedPicture tracked;
  tracked.region = std::move(region);
  tracked.patient_from_pixel = patient_from_pixel(picture.patient_from_probe, picture.geometry);
  tracked.time_s = picture.time_s;
  meter_.add(tracked);
  tracked.grey = picture.grey;
  bytes_ += tracked.grey.pixels.size();
  const bool full = bytes_ >= kMaxBytes;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(tracked));
    full_ = full;
    changed_.notify_all();
  }
  if (full) stop();
}

void SweepRecorder::wait() {
  if (thread_.joinable() && !running_) thread_.join();
}

std::shared_ptr<const SweptVolume> SweepRecorder::take_finished() {
  const std::lock_guard lock(mutex_);
  if (const std::exception_ptr problem = std::exchange(problem_, nullptr)) {
    running_ = false;
    std::rethrow_exception(problem);
  }
  return std::exchange(finished_, nullptr);
}

void SweepRecorder::run() {
  std::unique_lock lock(mutex_);
  try {
    GrowingVolume growing(kVoxel_mm, ReconstructionSettings(), kMaxReconstructedVoxels);
    for (;;) {
      changed_.wait(lock, [this] { return !waiting_.empty() || ending_ || dropped_; });
      if (dropped_) return;
      if (waiting_.empty()) break;
      TrackedPicture picture = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      growing.add(std::move(picture));
      lock.lock();
    }
    auto swept = std::make_shared<SweptVolume>();
    swept->quality = final_quality_;
    const bool full = full_;
    lock.unlock();
    if (swept->quality.pictures < 2)
      throw InputError("sweep", "", "it has fewer than two pictures", "move the probe while the sweep is recorded");
    swept->volume = growing.finish();
    swept->remark = growing.remark();
    if (full) {
      if (!swept->remark.empty()) swept->remark += " ";
      swept->remark += "The sweep was ended when its pictures filled 512 MiB.";
    }
    lock.lock();
    finished_ = std::move(swept);
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    problem_ = std::current_exception();
  }
  busy_ = false;
}

}  // namespace insonate
