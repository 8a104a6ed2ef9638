// Tests how the table of insonate-bench registration is summarised and drawn.

#include "tools/bench/registration_summary.h"

#include <catch2/catch.hpp>

#include <string>

#include "sim/core/input_error.h"

using namespace insonate;

namespace {

void add(bench::Table& table, const char* measure, double start_mm, double start_deg, double start_error, double error,
         bool converged) {
  table.rows.push_back({"case", "view", measure, bench::cell_of(start_mm, 1), bench::cell_of(start_deg, 1),
                        bench::cell_of(start_error, 1), bench::cell_of(error, 2), "0.3", converged ? "1" : "0", "1000",
                        "2.5"});
}

bench::Table example() {
  bench::Table table{{"case", "view", "measure", "start_mm", "start_deg", "start_error_mm", "error_mm", "expected_mm",
                      "converged", "evaluations", "seconds"},
                     {}};
  add(table, "lc2", 2, 2, 3, 0.5, true);
  add(table, "lc2", 5, 5, 8, 0.7, true);
  add(table, "lc2", 10, 5, 12, 4.9, false);  // a success that is doubted
  add(table, "lc2", 14, 10, 18, 5.0, true);  // a failure that is trusted
  add(table, "lc2", 22, 5, 23, 0.9, true);
  add(table, "mi", 2, 2, 3, 30, false);
  return table;
}

}  // namespace

TEST_CASE("registrations are summarised by patient and measure") {
  const auto all = bench::summaries_of("table.csv", example());
  REQUIRE(all.size() == 2);
  const bench::RegistrationSummary& lc2 = all[0];
  CHECK(lc2.patient == "case, view");
  CHECK(lc2.measure == "lc2");
  CHECK(lc2.starts == 5);
  CHECK(lc2.success == Approx(0.8));
  CHECK(lc2.near_starts == 4);
  CHECK(lc2.near_success == Approx(0.75));
  CHECK(lc2.median_mm == Approx(0.9));
  CHECK(lc2.median_of_successes_mm == Approx(0.8));
  CHECK(lc2.capture_mm == 15);  // the band from 15 mm has a failure
  CHECK(lc2.trusted_failures == 1);
  CHECK(lc2.doubted_successes == 1);
  CHECK(lc2.evaluations == 1000);
  CHECK(all[1].success == 0);
  CHECK(all[1].capture_mm == 0);
}

TEST_CASE("the plot has a panel per patient and a point per band that has starts") {
  const std::string svg = bench::registrations_svg("table.csv", example());
  CHECK(svg.find(">case, view<") != std::string::npos);
  CHECK(svg.find("lc2: 5 starts") != std::string::npos);
  CHECK(svg.find("mi: 1 starts") != std::string::npos);
  std::size_t points = 0;
  for (std::size_t at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) ++points;
  CHECK(points == 4);  // 0 to 10, 10 to 20 and 20 to 30 mm, and one of mi
  bench::Table broken = example();
  broken.rows[0][6] = "near";
  CHECK_THROWS_AS(bench::registrations_svg("table.csv", broken), InputError);
}
