#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace insonate::bench {

/// The results of a command: one row per setting, with one cell per column.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  /// Returns the table as CSV (RFC 4180, lines ending in \n), with the column names first.
  std::string csv() const;
  /// Parses CSV. Throws InputError if the text is not such a table.
  static Table parse(const std::string& file, std::string_view text);

  /// Returns the index of a column. Throws std::out_of_range if there is none of that name.
  std::size_t column(std::string_view name) const;
  const std::string& cell(std::size_t row, std::string_view name) const { return rows[row][column(name)]; }
  /// Returns a cell as a number. Throws InputError naming `file` and the line if it is not a number.
  double number(const std::string& file, std::size_t row, std::string_view name) const;
};

/// Returns a number as a table cell with `digits` digits after the point.
std::string cell_of(double value, int digits);

}  // namespace insonate::bench
