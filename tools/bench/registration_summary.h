#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/bench/tables/table.h"

namespace insonate::bench {

/// The starts of one patient and measure in short. A start succeeds if its final target registration error is below
/// 5 mm.
struct RegistrationSummary {
  std::string patient, measure;
  std::size_t starts = 0;
  double success = 0;                                ///< share of the starts, 0 to 1
  std::size_t near_starts = 0;                       ///< those off by at most 20 mm and 15 degrees
  double near_success = 0;                           ///< share of these
  double median_mm = 0, median_of_successes_mm = 0;  ///< final error; 0 without a start
  double capture_mm = 0;                ///< start's error up to which 95 % of the starts of every band of 5 mm succeed
  std::size_t trusted_failures = 0;     ///< converged, but with an error of 5 mm or more
  std::size_t doubted_successes = 0;    ///< not converged, but with less
  double evaluations = 0, seconds = 0;  ///< medians
};

/// Returns a summary per patient and measure, from the table of measure_registration(). Throws InputError.
/// @param file  the table's name in error messages
std::vector<RegistrationSummary> summaries_of(const std::string& file, const Table& table);

/// Prints summaries, one line each.
void print_summaries(const std::vector<RegistrationSummary>& summaries);

/// Returns an SVG of the share of starts that succeed over the start's error, one panel per patient and one line per
/// measure.
std::string registrations_svg(const std::string& file, const Table& table);

}  // namespace insonate::bench
