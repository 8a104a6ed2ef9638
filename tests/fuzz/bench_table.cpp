// Tables of run times as CSV.
#include "tests/fuzz/fuzz_target.h"
#include "tools/bench/tables/table.h"

namespace insonate::fuzz {
namespace {

const Target bench_table_target("bench_table", [](std::string_view bytes) -> std::string {
  const bench::Table table = bench::Table::parse("times.csv", bytes);
  for (const auto& row : table.rows)
    if (row.size() != table.columns.size()) return "a row has not a cell per column";
  const bench::Table again = bench::Table::parse("written.csv", table.csv());
  if (again.columns != table.columns || again.rows != table.rows) return "written and read again it is another";
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    for (const std::string& column : table.columns) table.number("times.csv", row, column);
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
