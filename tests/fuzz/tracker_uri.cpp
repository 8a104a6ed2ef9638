// What a person names a tracker by, its options, and the source that is made of it; no device is opened.
#include "devices/tracker_uri.h"

#include "devices/filter/sample_filters.h"
#include "devices/registry.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target tracker_uri_target("tracker_uri", [](std::string_view bytes) -> std::string {
  TrackerUri uri = parse_tracker_uri(bytes);
  if (uri.text != bytes) return "the text differs from what was given";
  if (uri.scheme.empty() || uri.scheme.find(':') != std::string::npos) return "the scheme is not a name";
  for (const auto& [option, value] : uri.options)
    if (option.empty() || value.empty()) return "an option without a name or value was taken";
  const FilterSettings filters = take_filter_options(uri);
  const std::string limit = filters.distortion ? "&distortion=" + std::to_string(filters.most_distortion) : "";
  TrackerUri again = parse_tracker_uri("any:?filter=" + to_string(filters) + limit);
  if (to_string(take_filter_options(again)) != to_string(filters))
    return "written and read again, other filters are on";
  make_raw_source(uri, {});
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
