#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "app/pictures/picture_reader.h"
#include "sim/reconstruction/reconstruction.h"
#include "sim/reconstruction/sweep_quality.h"

namespace insonate {

/// The volume of a sweep by hand, and how well it was swept.
struct SweptVolume {
  ReconstructedVolume volume;
  SweepQuality quality;
  std::string remark;  ///< why voxels are larger or the sweep was ended; mostly empty
};

/// Writes the grey levels as an NRRD, and beside it, as NAME-known.nrrd, what is known of each voxel. Throws
/// InputError.
void write_swept(const std::filesystem::path& nrrd_file, const SweptVolume& swept);

/// Makes a volume of the live ultrasound pictures of a sweep by hand. Reconstructs on its own thread while the sweep
/// lasts, so that drawing never waits.
///
///     recorder.start();
///     recorder.take(picture);  // each one
///     recorder.stop();
///     if (auto swept = recorder.take_finished()) ...  // some time later
class SweepRecorder {
public:
  static constexpr double kVoxel_mm = 0.7;
  /// Width of the simulated beam along the elevation: Settings::slice_thickness_mm of the trainer.
  static constexpr double kBeam_mm = 3;
  /// The pictures stay in memory until the volume is made. A sweep that would take more is ended by itself.
  static constexpr std::size_t kMaxBytes = std::size_t(512) << 20;

  SweepRecorder() = default;
  /// Drops a sweep that is not reconstructed yet.
  ~SweepRecorder();
  SweepRecorder(const SweepRecorder&) = delete;
  SweepRecorder& operator=(const SweepRecorder&) = delete;

  /// Begins a sweep. Does nothing while one runs or is being reconstructed.
  void start();
  /// Ends the sweep. The thread makes its volume in the background.
  void stop();
  bool running() const { return running_; }
  /// Returns whether a sweep has ended whose volume is not made yet.
  bool reconstructing() const;

  /// Adds a picture. Frozen pictures, and such that are not later than the last one, are left out. The sweep ends when
  /// the session begins another attempt.
  void take(const DrawnPicture& picture);

  /// Returns the quality of the sweep so far.
  SweepQuality quality() const { return meter_.quality(); }

  /// Waits until the volume of a sweep that has ended is made.
  void wait();
  /// Returns the volume of the last sweep, once, when it is made; nullptr before. Throws, once, what has prevented it.
  std::shared_ptr<const SweptVolume> take_finished();

private:
  std::shared_ptr<const PictureRegion> region_of(const DrawnPicture& picture);
  void run();

  bool running_ = false;
  int attempt_ = 0;  ///< of the session; 0 before the first picture
  double last_s_ = 0;
  std::size_t bytes_ = 0;
  SweepMeter meter_{SweepLimits()};
  DrawnPicture shown_by_region_;  ///< without pixels
  std::shared_ptr<const PictureRegion> region_;

  mutable std::mutex mutex_;  ///< held to move pictures, never to reconstruct
  std::condition_variable changed_;
  std::deque<TrackedPicture> waiting_;
  SweepQuality final_quality_;
  bool ending_ = false, dropped_ = false, full_ = false, busy_ = false;
  std::shared_ptr<const SweptVolume> finished_;
  std::exception_ptr problem_;
  std::jthread thread_;
};

}  // namespace insonate
