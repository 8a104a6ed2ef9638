#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace insonate::bench {

/// What a command measured: a row a setting, every row with a cell a column.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  /// As CSV (RFC 4180, lines ending in \n), the columns' names first.
  std::string csv() const;
  /// Throws InputError for text that is no such table.
  static Table parse(const std::string& file, std::string_view text);

  /// The number of a column; throws std::out_of_range when there is none of that name.
  std::size_t column(std::string_view name) const;
  const std::string& cell(std::size_t row, std::string_view name) const { return rows[row][column(name)]; }
  /// Throws InputError naming `file` and the line when the cell holds no number.
  double number(const std::string& file, std::size_t row, std::string_view name) const;
};

/// A number as a table's cell, to so many digits behind the point.
std::string cell_of(double value, int digits);

}  // namespace insonate::bench
