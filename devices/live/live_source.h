#pragma once

#include <glm/vec3.hpp>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "devices/transport/source_gone.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// Result of one read.
struct LiveBatch {
  std::vector<ProbeSample> samples;  ///< time_s is from steady_now_s(), taken as soon as the bytes arrived
  std::string note;                  ///< what users should know while the device is open, as a sentence; usually empty
};

/// A device that delivers poses in real time, as seen by a LiveTracker's thread. That one thread makes all calls except
/// name() and relative().
///
/// A source that is gone is opened again, after a pause, for as long as the tracker lives. So a source for a device
/// that is plugged in late, or pulled out and plugged in again, only has to report that it is gone.
class LiveSource {
public:
  virtual ~LiveSource() = default;

  /// Returns the name that users know it by: "Razer Hydra".
  virtual std::string name() const = 0;

  /// Finds the device and starts it. This may take a second or two, because a bus is listed and a device has to answer;
  /// only the tracker's thread waits. Throws SourceGone if the device is absent, busy or forbidden, and then leaves
  /// nothing open.
  virtual void open() = 0;

  /// Waits for samples, at most `timeout`, and appends those that arrived to `batch`, possibly none. The LiveTracker
  /// corrects equal or falling times. Throws SourceGone if the device is lost.
  virtual void read(std::chrono::milliseconds timeout, LiveBatch& batch) = 0;

  /// Returns a magnetic tracker's own origin in the frame of its samples; empty for other devices. A magnetic tracker
  /// can report a sensor as its mirror image through that point.
  virtual std::optional<glm::dvec3> origin() const { return std::nullopt; }

  /// See Tracker::relative(). Any thread may call it.
  virtual bool relative() const { return false; }

  /// Releases the device, which may take as long as open(). Called after each open() that succeeded.
  virtual void close() noexcept = 0;
};

}  // namespace insonate
