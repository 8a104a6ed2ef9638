#pragma once

#include <map>
#include <string>
#include <vector>

namespace insonate {

/// Returns the cells of CSV without line breaks in them.
inline std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool inside = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (c == '"' && inside && i + 1 < csv.size() && csv[i + 1] == '"') {
      rows.back().back() += csv[++i];
    } else if (c == '"') {
      inside = !inside;
    } else if (c == ',' && !inside) {
      rows.back().emplace_back();
    } else if (c == '\n' && !inside) {
      rows.emplace_back(1);
    } else if (c != '\r') {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

/// Returns the rows below the header line, each by its columns' names. A row of another length than the header's has a
/// column named "wrong".
inline std::vector<std::map<std::string, std::string>> rows_of(const std::string& csv) {
  const auto cells = cells_of(csv);
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t r = 1; r < cells.size(); ++r) {
    auto& row = rows.emplace_back();
    if (cells[r].size() != cells[0].size()) row["wrong"] = std::to_string(cells[r].size());
    for (std::size_t c = 0; c < std::min(cells[r].size(), cells[0].size()); ++c) row[cells[0][c]] = cells[r][c];
  }
  return rows;
}

}  // namespace insonate
