#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "devices/live/device_source.h"
#include "devices/live/raw_source.h"
#include "devices/tracker.h"
#include "devices/tracker_context.h"
#include "devices/tracker_uri.h"

namespace insonate {

/// What the poses of a kind of tracker describe. A set-up can place a sensor, a recording and a synthetic hand.
enum class PosesOf {
  probe,      ///< the probe's in the patient, moved by a hand at a desk: there is no sensor to set up
  sensor,     ///< a sensor's on a dummy probe, which a lab sets up once
  recording,  ///< whatever was recorded; a file's name says nothing of the tracker
  made_up,    ///< a synthetic hand's
  any,        ///< of the first tracker that can be opened
};

/// A kind of tracker. A new one is a folder with its class and a function that opens or makes it, and an entry in
/// registry.cpp. Exactly one of `open` and `make` is set.
struct TrackerKind {
  std::string_view scheme;   ///< "replay"
  std::string_view form;     ///< "replay:FILE[?speed=2&loop=1]"
  std::string_view summary;  ///< one line for people
  PosesOf poses;
  /// Opens a tracker that is not a device.
  std::unique_ptr<Tracker> (*open)(const TrackerUri& uri, const TrackerContext& context) = nullptr;
  /// Makes the source of a LiveTracker.
  std::unique_ptr<RawSource> (*make)(const TrackerUri& uri, const TrackerContext& context) = nullptr;
  const DeviceKind* device = nullptr;  ///< on HID or USB
  bool places_sensor = false;          ///< guesses where the sensor is on the patient, unless the URI has raw=1
  bool in_auto = false;                ///< auto: tries it, in the order of the table
};

/// Returns all kinds of tracker in this build.
std::span<const TrackerKind> tracker_kinds();

/// Returns the kind that a URI names. Throws InputError when there is none.
const TrackerKind& kind_of(const TrackerUri& uri);

/// Opens the tracker that `uri` names. Every live tracker accepts the options `filter` and `distortion`
/// (take_filter_options). Throws InputError if there is no such kind, if an option or its value is not allowed, or if
/// the file that the URI names cannot be used.
std::unique_ptr<Tracker> open_tracker(std::string_view uri, const TrackerContext& context = {});

/// Opens the tracker that `uri` names, unless it is a device. For a device it checks the URI alone and returns nullptr.
/// Throws what open_tracker() throws, so that a caller detects errors before long work.
std::unique_ptr<Tracker> open_unless_device(std::string_view uri);

/// Returns the source of the tracker that `uri` names, if its samples are parsed from a device's bytes. Throws
/// InputError if the tracker has no such source, or if open_tracker() would refuse the URI.
std::unique_ptr<RawSource> make_raw_source(const TrackerUri& uri, const TrackerContext& context);

}  // namespace insonate
