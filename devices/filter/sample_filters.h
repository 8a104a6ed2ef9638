#pragma once

#include <cstdint>
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
  bool predict = false;   ///< PoseHistory carries the newest pose on to the time of the picture

  static FilterSettings all() { return {true, true, true}; }
  bool operator==(const FilterSettings&) const = default;
};

/// The settings as a person writes them: "1euro,outlier,predict", or "off".
std::string to_string(const FilterSettings& settings);

/// Takes `filter` out of a tracker's options. A live tracker has all filters unless told, any other
/// none, so that a log is replayed to the bit: `?filter=off`, `?filter=1euro,outlier`. Throws
/// InputError when a filter is unknown.
FilterSettings take_filter_options(TrackerUri& uri, bool live);

/// The filters of one tracker. A rejected sample becomes `invalid` and loses its pose: the others see that the tracker
/// said something at that time, and nothing moves. Those that are not ok pass untouched.
class SampleFilters {
public:
  explicit SampleFilters(const FilterSettings& settings) : settings_(settings) {}
  SampleFilters() : SampleFilters(FilterSettings()) {}

  /// To be called for each sample, in order.
  void apply(PoseSample& sample);

  const FilterSettings& settings() const { return settings_; }
  std::uint64_t rejected() const { return rejected_; }

private:
  FilterSettings settings_;
  OutlierGate outliers_;
  OneEuroFilter one_euro_;
  std::uint64_t rejected_ = 0;
};

}  // namespace insonate
