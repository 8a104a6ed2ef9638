#pragma once

#include <optional>
#include <string>

#include "devices/filter/one_euro.h"
#include "devices/filter/outlier_gate.h"
#include "devices/tracker_uri.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// What is done to a tracker's samples between the device and whoever uses them.
struct FilterSettings {
  bool outlier = false;   ///< OutlierGate
  bool one_euro = false;  ///< OneEuroFilter

  static FilterSettings all() { return {true, true}; }
  bool operator==(const FilterSettings&) const = default;
};

/// The settings as a person writes them: "1euro,outlier", or "off".
std::string to_string(const FilterSettings& settings);

/// Takes `filter` out of a tracker's options: `?filter=off`, `?filter=1euro,outlier`. When it is not given they are
/// all on, or all off where `?raw=1` asks for the poses as they come. Throws InputError when a filter is unknown.
FilterSettings take_filter_option(TrackerUri& uri);

/// The filters of one tracker. A rejected sample becomes `invalid` and loses its pose: the others see that the tracker
/// said something at that time, and nothing moves. Those that are not ok pass untouched.
class SampleFilters {
public:
  explicit SampleFilters(const FilterSettings& settings) : settings_(settings) {}
  SampleFilters() : SampleFilters(FilterSettings()) {}

  /// To be called for each sample, in order. `origin` is that of a magnetic tracker in the samples' frame.
  void apply(PoseSample& sample, const std::optional<glm::dvec3>& origin = {});

  const FilterSettings& settings() const { return settings_; }

private:
  FilterSettings settings_;
  OutlierGate outliers_;
  OneEuroFilter one_euro_;
};

}  // namespace insonate
