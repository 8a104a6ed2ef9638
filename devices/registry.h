#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "devices/live/raw_source.h"
#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// A kind of tracker. A new kind needs a folder with its class and a function that opens or makes it, and an entry in
/// registry.cpp. Exactly one of `open` and `make` is set.
struct TrackerKind {
  std::string_view scheme;   ///< "replay"
  std::string_view form;     ///< "replay:FILE[?speed=2&loop=1]"
  std::string_view summary;  ///< one line for users
  std::unique_ptr<Tracker> (*open)(const TrackerUri& uri, const TrackerContext& context);
  /// Makes the source of a LiveTracker.
  std::unique_ptr<RawSource> (*make)(const TrackerUri& uri, const TrackerContext& context) = nullptr;
};

/// Returns all kinds of tracker in this build.
std::span<const TrackerKind> tracker_kinds();

/// Opens the tracker that `uri` names. Every live tracker accepts the options `filter` and `distortion`
/// (take_filter_options). Throws InputError if there is no such kind, if an option or its value is not allowed, or if
/// the file that the URI names cannot be used.
std::unique_ptr<Tracker> open_tracker(std::string_view uri, const TrackerContext& context = {});

/// Opens the tracker that `uri` names, unless it is a device. For a device it checks the URI alone and returns nullptr.
/// Throws what open_tracker() throws, so that a caller detects errors before long work.
std::unique_ptr<Tracker> open_unless_device(std::string_view uri);

/// Returns the source of the tracker that `uri` names, if its samples are parsed from a device's bytes. Throws
/// InputError for all other trackers, and as open_tracker() does.
std::unique_ptr<RawSource> make_raw_source(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
