#pragma once

#include <limits>
#include <optional>

#include "devices/filter/sample_filters.h"

namespace insonate {

/// The last step for a live source's samples before they are published: it makes their times rise strictly and applies
/// the filters. Its results depend on nothing but the samples and their order.
class SampleConditioner {
public:
  explicit SampleConditioner(const FilterSettings& settings) : filters_(settings) {}
  SampleConditioner() : SampleConditioner(FilterSettings()) {}

  /// Call it for each sample, in order. `origin` is the source's (LiveSource::origin).
  void apply(ProbeSample& sample, const std::optional<glm::dvec3>& origin);

  /// Returns the time of the newest sample.
  double last_time_s() const { return last_time_s_; }
  const FilterSettings& filters() const { return filters_.settings(); }

private:
  SampleFilters filters_;
  double last_time_s_ = -std::numeric_limits<double>::infinity();
};

/// Returns the sample that represents silence at a time: its status is `missing`.
ProbeSample silence_at(double time_s);

}  // namespace insonate
