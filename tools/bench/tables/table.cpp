#include "tools/bench/tables/table.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate::bench {
namespace {

constexpr char kRemedy[] = "give a file that insonate-bench --csv wrote";

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string text = "\"";
  for (char c : cell) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) text += (i ? "," : "") + quoted(cells[i]);
  return text + "\n";
}

}  // namespace

std::string Table::csv() const {
  std::string text = line_of(columns);
  for (const auto& row : rows) text += line_of(row);
  return text;
}

Table Table::parse(const std::string& file, std::string_view text) {
  std::vector<std::vector<std::string>> lines(1);
  std::string cell;
  bool in_quotes = false;
  const auto end_line = [&] {
    lines.back().push_back(std::move(cell));
    cell.clear();
    lines.emplace_back();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_quotes && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
      cell += text[++i];
    else if (c == '"')
      in_quotes = !in_quotes;
    else if (!in_quotes && c == ',') {
      lines.back().push_back(std::move(cell));
      cell.clear();
    } else if (!in_quotes && c == '\n')
      end_line();
    else if (in_quotes || c != '\r')
      cell += c;
  }
  if (!cell.empty() || !lines.back().empty()) end_line();
  lines.pop_back();
  if (in_quotes) throw InputError(file, "", "a quotation mark is never closed", kRemedy);
  if (lines.empty()) throw InputError(file, "", "there is no table in it", kRemedy);

  Table table;
  table.columns = std::move(lines.front());
  lines.erase(lines.begin());
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].size() != table.columns.size())
      throw InputError(file, "line " + std::to_string(i + 2),
                       "it has " + std::to_string(lines[i].size()) + " cells under " +
                           std::to_string(table.columns.size()) + " columns",
                       kRemedy);
  table.rows = std::move(lines);
  return table;
}

std::size_t Table::column(std::string_view name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) throw std::out_of_range("there is no column " + std::string(name));
  return std::size_t(found - columns.begin());
}

double Table::number(const std::string& file, std::size_t row, std::string_view name) const {
  const std::string& text = cell(row, name);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end)
    throw InputError(file, "line " + std::to_string(row + 2) + ", column '" + std::string(name) + "'",
                     "'" + text + "' is not a number", kRemedy);
  return value;
}

std::string cell_of(double value, int digits) {
  return formatted("%.*f", digits, value);
}

}  // namespace insonate::bench
