#pragma once

#include <memory>
#include <vector>

#include "devices/live/live_source.h"
#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// The first of several devices that can be opened, looked for again each time it is lost.
class BestSource : public LiveSource {
public:
  /// From the best to the worst.
  explicit BestSource(std::vector<std::unique_ptr<LiveSource>> sources) : sources_(std::move(sources)) {}

  void open() override;
  void read(std::chrono::milliseconds timeout, LiveBatch& batch) override { opened_->read(timeout, batch); }
  std::optional<glm::dvec3> origin() const override { return opened_ ? opened_->origin() : std::nullopt; }
  void close() noexcept override { opened_->close(); }

private:
  std::vector<std::unique_ptr<LiveSource>> sources_;
  LiveSource* opened_ = nullptr;
};

/// auto: those that tell place and direction before the one that tells direction and the one that tells speed. Throws
/// InputError.
std::unique_ptr<Tracker> open_best(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
