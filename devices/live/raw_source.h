#pragma once

#include <memory>
#include <utility>

#include "devices/bytes.h"
#include "devices/live/live_source.h"
#include "devices/transport/attached_device.h"

namespace insonate {

/// Receives what a source gets from its device, before it is parsed. Called on the reading thread. Times are from
/// steady_now_s() and never fall.
class RawTap {
public:
  virtual ~RawTap() = default;
  /// The source was opened. A source that is not a device on a bus passes a device without numbers.
  virtual void opened(const AttachedDevice& device, double time_s) noexcept = 0;
  /// A read returned these bytes; empty if it timed out.
  virtual void came(Bytes bytes, double time_s) noexcept = 0;
  /// The tracker published a sample `missing`, because nothing had arrived for a long time.
  virtual void silent(double time_s) noexcept = 0;
};

/// A source whose samples are parsed from bytes. Its bytes can be recorded, and give the same samples again.
class RawSource : public LiveSource {
public:
  /// From the next open() on, `tap` receives what the device sends. Null receives nothing.
  virtual void record_raw(std::shared_ptr<RawTap> tap) { tap_ = std::move(tap); }

  /// Does what open() does, with a device that a tap was passed, but without hardware. Returns false, and does nothing,
  /// if the source does not support such a device.
  virtual bool replay_open(const AttachedDevice& device, double time_s) = 0;

  /// Does what read() does with received bytes. Throws SourceGone where read() would.
  virtual void replay_read(Bytes bytes, double time_s, LiveBatch& batch) = 0;

protected:
  RawTap* tap() const { return tap_.get(); }

private:
  std::shared_ptr<RawTap> tap_;
};

}  // namespace insonate
