#pragma once

#include <glm/vec3.hpp>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "devices/transport/source_gone.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// What one read brought.
struct LiveBatch {
  std::vector<PoseSample> samples;  ///< time_s by steady_now_s(), taken as soon as the bytes were there
  std::string note;                 ///< what people should know while the device is open, as a sentence; mostly empty
};

/// A device that gives poses in real time, as a LiveTracker's thread sees it: every call comes from that one thread,
/// but name() and relative().
///
/// A source that is gone is opened again, after a pause, for as long as the tracker lives; so a device that is plugged
/// in late, pulled and plugged in again needs nothing more than to say that it is gone.
class LiveSource {
public:
  virtual ~LiveSource() = default;

  /// What people call it: "Razer Hydra".
  virtual std::string name() const = 0;

  /// Looks for the device and starts it, which may take a second or two: a bus is listed, a device has to answer. Only
  /// the tracker's thread waits. Throws SourceGone when it is not there, busy or forbidden, and leaves nothing open
  /// then.
  virtual void open() = 0;

  /// Waits for samples, no longer than `timeout`, and appends to `batch` what came, which may be nothing. Equal or
  /// falling times are the LiveTracker's to mend. Throws SourceGone when the device is lost.
  virtual void read(std::chrono::milliseconds timeout, LiveBatch& batch) = 0;

  /// Of a magnetic tracker, where its own origin lies in the frame of its samples: it may take a sensor for its mirror
  /// image through that point.
  virtual std::optional<glm::dvec3> origin() const { return std::nullopt; }

  /// Tracker::relative(). By any thread.
  virtual bool relative() const { return false; }

  /// Lets go of the device, which may take as long. Called after each open() that went well.
  virtual void close() noexcept = 0;
};

}  // namespace insonate
