#pragma once

#include <string>

#include "tools/bench/table.h"

namespace insonate::bench {

/// Prints the table of measure_registration() in short: per patient and measure, and per band of the start's error, how
/// many starts succeeded, the median error, and what it took. A start succeeds if its final target registration error
/// is below 5 mm. The capture range is the start's error up to which at least 95 % of the starts of every band of 5 mm
/// succeed.
/// @param file  the table's name in error messages
void print_registrations(const std::string& file, const Table& table);

/// Returns an SVG of the share of starts that succeed over the start's error, one panel per patient and one line per
/// measure.
std::string registrations_svg(const std::string& file, const Table& table);

}  // namespace insonate::bench
