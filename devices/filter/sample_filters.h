#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "devices/filter/one_euro.h"
#include "devices/filter/outlier_gate.h"
#include "devices/tracker_uri.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// The filters that are applied to a tracker's samples before they are published.
struct FilterSettings {
  bool outlier = false;     ///< OutlierGate
  bool one_euro = false;    ///< OneEuroFilter
  bool distortion = false;  ///< rejects samples that the tracker itself grades worse than most_distortion
  /// Limit on the tracker's own scale (ProbeSample::distortion). Samples without a grade pass.
  std::uint32_t most_distortion = 0;

  /// Returns the default filters: those that need no number from a person.
  static FilterSettings usual() { return {.outlier = true, .one_euro = true}; }
  bool operator==(const FilterSettings&) const = default;
};

/// Returns the settings in the form of a URI option: "1euro,outlier", or "off".
std::string to_string(const FilterSettings& settings);

/// Removes `filter` and `distortion` from a tracker's options and returns their settings. Examples: `?filter=off`,
/// `?filter=1euro,outlier`, `?distortion=20`. Without `filter` the usual filters are on, or none if `?raw=1` asks for
/// raw poses. A given `distortion` limit switches that filter on. Throws InputError if a filter is unknown, or if
/// `distortion` has no limit or one that is not a whole number.
FilterSettings take_filter_options(TrackerUri& uri);

/// The filters of one tracker. A rejected sample becomes `invalid`, loses its pose and gets a reason
/// (ProbeSample::rejected). So consumers see that the tracker sent something at that time, but nothing moves. Samples
/// that are not ok pass unchanged.
class SampleFilters {
public:
  explicit SampleFilters(const FilterSettings& settings) : settings_(settings) {}
  SampleFilters() : SampleFilters(FilterSettings()) {}

  /// Call it for each sample, in order. `origin` is that of a magnetic tracker in the samples' frame.
  void apply(ProbeSample& sample, const std::optional<glm::dvec3>& origin = {});

  const FilterSettings& settings() const { return settings_; }

private:
  FilterSettings settings_;
  OutlierGate outliers_;
  OneEuroFilter one_euro_;
};

}  // namespace insonate
