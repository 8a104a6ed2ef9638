#include "devices/registry.h"

#include <filesystem>
#include <string>
#include <vector>

#include "devices/auto/best_source.h"
#include "devices/hydra/hydra_tracker.h"
#include "devices/igtl/igtl_source.h"
#include "devices/live/live_tracker.h"
#include "devices/mouse/mouse_tracker.h"
#include "devices/osvr/osvr_tracker.h"
#include "devices/polhemus/polhemus_tracker.h"
#include "devices/rehearsal/rehearsal_tracker.h"
#include "devices/replay/raw_replay.h"
#include "devices/replay/replay_tracker.h"
#include "devices/spacemouse/spacemouse_tracker.h"
#include "devices/synthetic/synthetic_tracker.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

constexpr TrackerKind kKinds[] = {
    {.scheme = "replay",
     .form = "replay:FILE[?speed=2&loop=1&transform=ProbeToTracker&rate=25]",
     .summary = "a recorded .igs.mha, .seq.mha or .seq.nrrd file",
     .poses = PosesOf::recording,
     .open = open_replay},
    {.scheme = "raw",
     .form = "raw:FILE[?speed=2&loop=1]",
     .summary = "what a tracker's device sent, recorded with --record-raw",
     .poses = PosesOf::recording,
     .open = open_raw},
    {.scheme = "synthetic",
     .form = "synthetic:[SEED][?rate=60&live=1]",
     .summary = "a made-up hand that scans the front of the abdomen, also as from a device",
     .poses = PosesOf::made_up,
     .open = open_synthetic},
    {.scheme = "rehearsal",
     .form = "rehearsal:[?raw=1]",
     .summary = "a made-up hand with a tracked probe, to rehearse the set-up without a tracker",
     .poses = PosesOf::sensor,
     .open = open_rehearsal,
     .places_sensor = true},
    {.scheme = "auto",
     .form = "auto:",
     .summary = "the first of Polhemus, Hydra, OSVR and SpaceMouse that can be opened",
     .poses = PosesOf::any,
     .make = make_best},
    {.scheme = "polhemus",
     .form = "polhemus:[SERIAL][?sensor=1&distortion=20&raw=1]",
     .summary = "a Polhemus Patriot, Liberty HS or Viper",
     .poses = PosesOf::sensor,
     .make = make_polhemus,
     .device = &kPolhemusDevice,
     .places_sensor = true,
     .in_auto = true},
    {.scheme = "hydra",
     .form = "hydra:[SERIAL][?handset=2&raw=1]",
     .summary = "a Razer Hydra's handset",
     .poses = PosesOf::sensor,
     .make = make_hydra,
     .device = &kHydraDevice,
     .places_sensor = true,
     .in_auto = true},
    {.scheme = "osvr",
     .form = "osvr:[SERIAL]",
     .summary = "an OSVR head tracker, which turns the probe where it was put",
     .poses = PosesOf::probe,
     .make = make_osvr,
     .device = &kOsvrDevice,
     .in_auto = true},
    {.scheme = "spacemouse",
     .form = "spacemouse:[SERIAL][?speed=1]",
     .summary = "a 3Dconnexion SpaceMouse, which moves the probe at a rate",
     .poses = PosesOf::probe,
     .make = make_spacemouse,
     .device = &kSpaceMouseDevice,
     .in_auto = true},
    {.scheme = "igtl",
     .form = "igtl://HOST[:18944][/NAME][?frame=ras&time=sender]",
     .summary = "TRANSFORM messages of an OpenIGTLink server",
     .poses = PosesOf::sensor,
     .make = igtl::make_igtl},
    {.scheme = "mouse",
     .form = "mouse:",
     .summary = "the mouse and the keyboard, in the trainer's window",
     .poses = PosesOf::probe,
     .open = open_mouse},
};

std::unique_ptr<Tracker> open_kind(const TrackerKind& kind, const TrackerUri& uri, const TrackerContext& context) {
  if (kind.open) return kind.open(uri, context);
  return std::make_unique<LiveTracker>(kind.make(uri, context));
}

}  // namespace

std::span<const TrackerKind> tracker_kinds() {
  return kKinds;
}

const TrackerKind& kind_of(const TrackerUri& uri) {
  std::vector<std::string> schemes;
  for (const TrackerKind& kind : kKinds) {
    if (kind.scheme == uri.scheme) return kind;
    schemes.emplace_back(kind.scheme);
  }
  throw InputError("tracker '" + uri.text + "'", "", "there is no kind of tracker '" + uri.scheme + "'",
                   suggest(uri.scheme, schemes));
}

std::unique_ptr<Tracker> open_tracker(std::string_view text, const TrackerContext& context) {
  std::error_code error;
  if (std::filesystem::is_regular_file(text, error))
    throw InputError("tracker '" + std::string(text) + "'", "", "a file alone does not say what to do with it",
                     "did you mean 'replay:" + std::string(text) + "'?");
  const TrackerUri uri = parse_tracker_uri(text);
  TrackerUri plain = uri;
  const FilterSettings filters = take_filter_options(plain);
  std::unique_ptr<Tracker> tracker = open_kind(kind_of(uri), plain, context);
  if (auto* live = dynamic_cast<LiveTracker*>(tracker.get()))
    live->set_filters(filters);
  else
    for (const char* option : {"filter", "distortion"})
      if (uri.options.contains(option))
        throw InputError("tracker '" + uri.text + "'", "option '" + std::string(option) + "'",
                         "only a live tracker's samples are filtered", "leave it out");
  return tracker;
}

std::unique_ptr<Tracker> open_unless_device(std::string_view text) {
  TrackerUri uri = parse_tracker_uri(text);
  const TrackerKind& kind = kind_of(uri);
  if (!kind.make) return open_tracker(text);
  take_filter_options(uri);
  kind.make(uri, {});
  return nullptr;
}

std::unique_ptr<RawSource> make_raw_source(const TrackerUri& uri, const TrackerContext& context) {
  const TrackerKind& kind = kind_of(uri);
  if (!kind.make)
    throw InputError("tracker '" + uri.text + "'", "", "its samples do not come of a device's bytes",
                     "name a tracker on a bus or on the network");
  return kind.make(uri, context);
}

}  // namespace insonate
