#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace insonate::csv {

// The parts of a CSV file (RFC 4180, UTF-8, decimal points), so that all tables read alike.

/// Returns a number with enough digits to restore the same double.
std::string number(double value);

/// Returns text in quotes. Text that a spreadsheet would read as a formula begins with an apostrophe.
std::string text(std::string_view text);

/// Returns a line of cells, which number() and text() have made.
std::string row(const std::vector<std::string>& cells);

}  // namespace insonate::csv
