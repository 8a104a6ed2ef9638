#include "devices/registry.h"

#include <filesystem>
#include <string>
#include <vector>

#include "devices/mouse/mouse_tracker.h"
#include "devices/replay/replay_tracker.h"
#include "devices/synthetic/synthetic_tracker.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

constexpr TrackerKind kKinds[] = {
    {"replay", "replay:FILE[?speed=2&loop=1&transform=ProbeToTracker]", "a recorded .igs.mha or .seq.mha file",
     open_replay},
    {"synthetic", "synthetic:[SEED][?rate=60]", "a made-up hand that scans the front of the abdomen", open_synthetic},
    {"mouse", "mouse:", "the mouse and the keyboard, in the trainer's window", open_mouse},
};

}  // namespace

std::span<const TrackerKind> tracker_kinds() {
  return kKinds;
}

std::unique_ptr<Tracker> open_tracker(std::string_view text, const TrackerContext& context) {
  std::error_code error;
  if (std::filesystem::is_regular_file(text, error))
    throw InputError("tracker '" + std::string(text) + "'", "", "a file alone does not say what to do with it",
                     "did you mean 'replay:" + std::string(text) + "'?");
  const TrackerUri uri = parse_tracker_uri(text);
  std::vector<std::string> schemes;
  for (const TrackerKind& kind : kKinds) {
    if (kind.scheme == uri.scheme) return kind.open(uri, context);
    schemes.emplace_back(kind.scheme);
  }
  throw InputError("tracker '" + uri.text + "'", "", "there is no kind of tracker '" + uri.scheme + "'",
                   suggest(uri.scheme, schemes));
}

}  // namespace insonate
