#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "devices/live/raw_source.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// The first of several devices that can be opened. The search is repeated each time the device is lost.
class BestSource : public RawSource {
public:
  /// `sources` are ordered from the best to the worst.
  explicit BestSource(std::vector<std::unique_ptr<RawSource>> sources) : sources_(std::move(sources)) {}

  std::string name() const override { return "the best tracker that is plugged in, without a calibration"; }
  void open() override;
  void read(std::chrono::milliseconds timeout, LiveBatch& batch) override { opened_->read(timeout, batch); }
  std::optional<glm::dvec3> origin() const override { return opened_ ? opened_->origin() : std::nullopt; }
  void close() noexcept override { opened_->close(); }
  bool relative() const override { return relative_; }

  void record_raw(std::shared_ptr<RawTap> tap) override;
  bool replay_open(const AttachedDevice& device, double time_s) override;
  void replay_read(Bytes bytes, double time_s, LiveBatch& batch) override {
    opened_->replay_read(bytes, time_s, batch);
  }

private:
  std::vector<std::unique_ptr<RawSource>> sources_;
  RawSource* opened_ = nullptr;
  std::atomic<bool> relative_{false};  ///< of the source that is or was open
};

/// Makes auto:. Trackers that measure position and orientation come first, then the one that measures orientation, then
/// the one that measures speed. Throws InputError.
std::unique_ptr<RawSource> make_best(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
