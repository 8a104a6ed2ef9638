#pragma once

#include <limits>
#include <optional>

#include "devices/filter/sample_filters.h"

namespace insonate {

/// The last that happens to a live source's samples before anybody sees them: their times are made to rise strictly,
/// and the filters have their turn. A function of the samples and their order alone.
class SampleConditioner {
public:
  explicit SampleConditioner(const FilterSettings& settings) : filters_(settings) {}
  SampleConditioner() : SampleConditioner(FilterSettings()) {}

  /// To be called for each sample, in order. `origin` is the source's (LiveSource::origin).
  void apply(PoseSample& sample, const std::optional<glm::dvec3>& origin);

  /// Of the newest sample.
  double last_time_s() const { return last_time_s_; }
  const FilterSettings& filters() const { return filters_.settings(); }

private:
  SampleFilters filters_;
  double last_time_s_ = -std::numeric_limits<double>::infinity();
};

/// What stands for a silence at a time: a sample that is `missing`.
PoseSample silence_at(double time_s);

}  // namespace insonate
