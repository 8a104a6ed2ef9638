#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "devices/filter/one_euro.h"
#include "devices/filter/outlier_gate.h"
#include "devices/tracker_uri.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// What is done to a tracker's samples between the device and whoever uses them.
struct FilterSettings {
  bool outlier = false;     ///< OutlierGate
  bool one_euro = false;    ///< OneEuroFilter
  bool distortion = false;  ///< rejects what the tracker itself grades worse than most_distortion
  /// On the tracker's own scale (PoseSample::distortion); samples without a grade pass.
  std::uint32_t most_distortion = 0;

  /// Those that need no figure from a person.
  static FilterSettings usual() { return {.outlier = true, .one_euro = true}; }
  bool operator==(const FilterSettings&) const = default;
};

/// The settings as a person writes them: "1euro,outlier", or "off".
std::string to_string(const FilterSettings& settings);

/// Takes `filter` and `distortion` out of a tracker's options: `?filter=off`, `?filter=1euro,outlier`,
/// `?distortion=20`. When `filter` is not given the usual ones are on, or none where `?raw=1` asks for the poses as
/// they come, and `distortion` is where its limit is given. Throws InputError when a filter is unknown, or when
/// `distortion` has no limit or none that is a whole number.
FilterSettings take_filter_options(TrackerUri& uri);

/// The filters of one tracker. A rejected sample becomes `invalid`, loses its pose and says why (PoseSample::rejected):
/// the others see that the tracker said something at that time, and nothing moves. Those that are not ok pass
/// untouched.
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
