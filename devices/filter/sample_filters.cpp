#include "devices/filter/sample_filters.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

struct Named {
  std::string_view name;
  bool FilterSettings::*on;
};

constexpr Named kFilters[] = {{"1euro", &FilterSettings::one_euro},
                              {"outlier", &FilterSettings::outlier},
                              {"distortion", &FilterSettings::distortion}};

void switch_on(FilterSettings& settings, std::string_view name, const TrackerUri& uri) {
  std::vector<std::string> names;
  for (const Named& filter : kFilters) {
    if (filter.name == name) {
      settings.*filter.on = true;
      return;
    }
    names.emplace_back(filter.name);
  }
  names.emplace_back("off");
  throw InputError("tracker '" + uri.text + "'", "option 'filter'", "there is no filter '" + std::string(name) + "'",
                   suggest(name, names));
}

}  // namespace

std::string to_string(const FilterSettings& settings) {
  std::string names;
  for (const Named& filter : kFilters)
    if (settings.*filter.on) names += (names.empty() ? "" : ",") + std::string(filter.name);
  return names.empty() ? "off" : names;
}

FilterSettings take_filter_options(TrackerUri& uri) {
  const auto raw = uri.options.find("raw");
  FilterSettings settings = raw != uri.options.end() && raw->second == "1" ? FilterSettings() : FilterSettings::usual();
  constexpr double kWorst = 4294967295;  // a grade has at most 32 bits
  const double limit = uri.number("distortion", 0, 0, kWorst);
  if (limit != std::floor(limit))
    throw InputError("tracker '" + uri.text + "'", "option 'distortion'", "the limit is not a whole number",
                     "change it");
  settings.most_distortion = std::uint32_t(limit);
  settings.distortion = !uri.options.extract("distortion").empty();
  const bool has_limit = settings.distortion;
  const auto given = uri.options.extract("filter");
  if (given.empty()) return settings;
  for (const Named& filter : kFilters) settings.*filter.on = false;
  if (given.mapped() == "off") return settings;
  for (std::string_view rest = given.mapped();;) {
    const std::string_view name = rest.substr(0, rest.find(','));
    switch_on(settings, name, uri);
    if (name.size() == rest.size()) break;
    rest.remove_prefix(name.size() + 1);
  }
  if (settings.distortion && !has_limit)
    throw InputError("tracker '" + uri.text + "'", "option 'filter'", "'distortion' has no limit",
                     "give it, as in '&distortion=20'");
  return settings;
}

void SampleFilters::apply(ProbeSample& sample, const std::optional<glm::dvec3>& origin) {
  if (sample.status != PoseStatus::ok) return;
  // A distorted reading must not change the state of the other filters.
  if (settings_.distortion && sample.distortion.value_or(0) > settings_.most_distortion)
    sample.rejected = Rejection::distortion;
  else if (settings_.outlier && !outliers_.accepts(sample.time_s, sample.patient_from_probe, origin))
    sample.rejected = outliers_.mirrored() ? Rejection::mirror : Rejection::jump;
  if (sample.rejected != Rejection::none) {
    sample.status = PoseStatus::invalid;
    sample.patient_from_probe = Pose{};
    return;
  }
  if (settings_.one_euro) sample.patient_from_probe = one_euro_.smooth(sample.time_s, sample.patient_from_probe);
}

}  // namespace insonate
