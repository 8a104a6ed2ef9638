#pragma once

#include <memory>
#include <utility>

#include "devices/bytes.h"
#include "devices/live/live_source.h"
#include "devices/transport/attached_device.h"

namespace insonate {

/// Is told what a source gets from its device, before anybody has made anything of it. Called on the thread that reads;
/// times by steady_now_s(), never falling.
class RawTap {
public:
  virtual ~RawTap() = default;
  /// The source was opened. A source that is no device on a bus gives a device without numbers.
  virtual void opened(const AttachedDevice& device, double time_s) noexcept = 0;
  /// A read brought these bytes, or none in its time.
  virtual void came(Bytes bytes, double time_s) noexcept = 0;
  /// A sample `missing` was handed over, because nothing had come for long.
  virtual void silent(double time_s) noexcept = 0;
};

/// A source whose samples come of bytes: what it got can be recorded, and gives the same samples again.
class RawSource : public LiveSource {
public:
  /// From the next open() on `tap` is told; null for nobody.
  virtual void record_raw(std::shared_ptr<RawTap> tap) { tap_ = std::move(tap); }

  /// What open() does, with a device that a tap was told of and nothing behind it. False, and nothing is done, when the
  /// source is not for such a device.
  virtual bool replay_open(const AttachedDevice& device, double time_s) = 0;

  /// What read() does with what came. Throws SourceGone where that would.
  virtual void replay_read(Bytes bytes, double time_s, LiveBatch& batch) = 0;

protected:
  RawTap* tap() const { return tap_.get(); }

private:
  std::shared_ptr<RawTap> tap_;
};

}  // namespace insonate
