#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "devices/live/raw_source.h"
#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A kind of tracker. A new one is a folder with its class and a function that opens or makes it, and a line in
/// registry.cpp. One of the two is there.
struct TrackerKind {
  std::string_view scheme;   ///< "replay"
  std::string_view form;     ///< "replay:FILE[?speed=2&loop=1]"
  std::string_view summary;  ///< one line for people
  std::unique_ptr<Tracker> (*open)(const TrackerUri& uri, const TrackerContext& context);
  /// The source of a LiveTracker.
  std::unique_ptr<RawSource> (*make)(const TrackerUri& uri, const TrackerContext& context) = nullptr;
};

/// Every kind this build has.
std::span<const TrackerKind> tracker_kinds();

/// Opens the tracker that `uri` names. `filter` and `distortion`
/// are options of every live tracker (take_filter_options). Throws
/// InputError when there is no such kind, an option or its value is not allowed, or what it names (a file) cannot be
/// used.
std::unique_ptr<Tracker> open_tracker(std::string_view uri, const TrackerContext& context = {});

/// Opens the tracker that `uri` names unless it is a device, of which only the URI is checked: nullptr. Throws what
/// open_tracker() throws, so that a caller can learn it before work that takes long.
std::unique_ptr<Tracker> open_unless_device(std::string_view uri);

/// The source of the tracker that `uri` names, for one whose samples come of bytes. Throws InputError as open_tracker()
/// does, and for all others.
std::unique_ptr<RawSource> make_raw_source(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
