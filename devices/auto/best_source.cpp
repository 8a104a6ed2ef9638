#include "devices/auto/best_source.h"

#include <string>
#include <utility>

#include "devices/registry.h"
#include "devices/transport/transport.h"
#include "sim/core/input_error.h"

namespace insonate {

void BestSource::open() {
  std::string there_but_useless;
  for (const auto& source : sources_) {
    try {
      source->open();
      opened_ = source.get();
      relative_ = opened_->relative();
      return;
    } catch (const TransportError& error) {
      if (error.fault() != TransportFault::absent && there_but_useless.empty()) there_but_useless = error.what();
    }
  }
  throw SourceGone(there_but_useless.empty() ? "No tracker that is known here is plugged in." : there_but_useless);
}

void BestSource::record_raw(std::shared_ptr<RawTap> tap) {
  for (const auto& source : sources_) source->record_raw(tap);
}

bool BestSource::replay_open(const AttachedDevice& device, double time_s) {
  for (const auto& source : sources_) {
    if (!source->replay_open(device, time_s)) continue;
    opened_ = source.get();
    return true;
  }
  return false;
}

std::unique_ptr<RawSource> make_best(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({});
  if (!uri.subject.empty())
    throw InputError("tracker '" + uri.text + "'", "", "whatever is plugged in has no name to be given",
                     "write just 'auto:', or name the kind of tracker");
  std::vector<std::unique_ptr<RawSource>> sources;
  for (const TrackerKind& kind : tracker_kinds())
    if (kind.in_auto) sources.push_back(kind.make(uri, context));
  return std::make_unique<BestSource>(std::move(sources));
}

}  // namespace insonate
