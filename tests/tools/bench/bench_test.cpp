// What insonate-bench does with its measurements: statistics, tables and the comparison of two runs.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/model/quality.h"
#include "tests/scenarios/tiny_case.h"
#include "tools/bench/converged.h"
#include "tools/bench/display.h"
#include "tools/bench/tables/compare.h"
#include "tools/bench/tables/plot.h"
#include "tools/bench/tables/statistics.h"
#include "tools/bench/tables/table.h"

using namespace insonate;
using namespace insonate::bench;

namespace {

Table run(const std::string& device, double first_quartile, double median, double third_quartile) {
  return {{"device", "case", "lines", "q1_ms", "median_ms", "q3_ms", "error_db"},
          {{device, "a", "64", cell_of(first_quartile, 3), cell_of(median, 3), cell_of(third_quartile, 3), "0.5"},
           {device, "b", "64", "2", "3", "4", "0.5"}}};
}

}  // namespace

TEST_CASE("the root mean square of nothing is 0, of others the root of their mean square") {
  RootMeanSquare rms;
  CHECK(rms.value() == 0);
  for (const double value : {1.0, -7.0, 5.0, 5.0}) rms.add(value);
  CHECK(rms.value() == 5);
  CHECK(rms.count() == 4);
}

TEST_CASE("on the front lies what no other setting beats in one and equals in the other") {
  const auto front = [](const std::vector<std::pair<double, double>>& settings) {
    std::vector<Cost> costs;
    for (const auto& [time, error] : settings) costs.push_back({{time, time, time}, error});
    return on_front(costs);
  };
  CHECK(front({{1, 5}, {2, 3}, {2, 4}, {3, 3}, {4, 1}, {5, 2}}) ==
        std::vector<bool>{true, true, false, false, true, false});
}

TEST_CASE("of settings that cannot be distinguished the first lies on the front, whichever is faster by chance") {
  const Cost usual{{9, 10, 11}, 1.0}, by_chance{{8, 9.5, 11}, 0.999}, faster{{7, 8, 8.9}, 1.0},
      finer{{9, 10, 11}, 0.98}, slower{{12, 13, 14}, 0.999};
  CHECK(on_front({usual, by_chance, slower}) == std::vector<bool>{true, false, false});
  CHECK(on_front({by_chance, usual}) == std::vector<bool>{true, false});
  CHECK(on_front({usual, faster}) == std::vector<bool>{false, true});
  CHECK(on_front({usual, finer}) == std::vector<bool>{false, true});
  CHECK(on_front({usual, usual}) == std::vector<bool>{true, false});
}

TEST_CASE("what takes more memory does not push from the front what takes less") {
  const Cost usual{{9, 10, 11}, 1.0, 4}, faster{{7, 8, 8.9}, 1.0, 8}, by_chance{{8, 9.5, 11}, 1.0, 8},
      lighter{{9, 10, 11}, 1.0, 2};
  CHECK(on_front({usual, faster}) == std::vector<bool>{true, true});
  CHECK(on_front({usual, by_chance}) == std::vector<bool>{true, false});
  CHECK(on_front({by_chance, usual}) == std::vector<bool>{false, true});
  CHECK(on_front({usual, lighter}) == std::vector<bool>{false, true});
}

TEST_CASE("a table comes back from its CSV as it was, whatever its cells hold") {
  const Table table{{"device", "median_ms"},
                    {{"llvmpipe (LLVM 15, 256 bits), OpenGL", "1.5"}, {"say \"so\"\nbelow", ""}, {"", "-2e-3"}}};
  CHECK(table.csv().starts_with("device,median_ms\n\"llvmpipe (LLVM 15, 256 bits), OpenGL\",1.5\n"));
  const Table parsed = Table::parse("t.csv", table.csv());
  CHECK(parsed.columns == table.columns);
  CHECK(parsed.rows == table.rows);
  CHECK(parsed.number("t.csv", 2, "median_ms") == -2e-3);
  CHECK(Table::parse("t.csv", "a,b\r\n1,2").rows == std::vector<std::vector<std::string>>{{"1", "2"}});
}

TEST_CASE("a file that is not a table is refused with its place") {
  CHECK_THROWS_WITH(Table::parse("t.csv", ""), Catch::Contains("t.csv") && Catch::Contains("no table"));
  CHECK_THROWS_WITH(Table::parse("t.csv", "a,b\n1,2\n1\n"), Catch::Contains("line 3") && Catch::Contains("1 cells"));
  CHECK_THROWS_WITH(Table::parse("t.csv", "a\n\"b\n"), Catch::Contains("quotation mark"));
  const Table words = Table::parse("t.csv", "median_ms\nfast\n");
  CHECK_THROWS_WITH(words.number("t.csv", 0, "median_ms"), Catch::Contains("line 2") && Catch::Contains("'fast'"));
}

TEST_CASE("two runs compare setting by setting, on whatever device, and distinguish a change from the spread") {
  const auto compared = compare("old", run("X", 9, 10, 11), "new", run("Y", 17, 20, 24)).changes;
  REQUIRE(compared.size() == 2);
  CHECK(compared[0].setting == "case=a, lines=64");
  CHECK(compared[0].ratio == 2);
  CHECK(compared[0].least_ratio == Approx(17.0 / 11));
  CHECK(compared[0].most_ratio == Approx(24.0 / 9));
  CHECK(compared[0].slower());
  CHECK_FALSE(compared[0].faster());
  CHECK_FALSE(compared[1].slower());
  CHECK_FALSE(compared[1].faster());

  CHECK(compare("old", run("X", 9, 10, 11), "new", run("X", 6, 7, 8)).changes[0].faster());
  const Change within = compare("old", run("X", 9, 10, 11), "new", run("X", 10.5, 12, 13)).changes[0];
  CHECK_FALSE(within.slower());
  CHECK_FALSE(within.faster());
}

TEST_CASE("a run whose errors have grown is distinguished from one that is as accurate, however fast") {
  const auto with_error = [](const char* db, const char* grey) {
    Table table = run("X", 9, 10, 11);
    table.columns.emplace_back("error_grey");
    for (auto& row : table.rows) row.back() = db, row.emplace_back(grey);
    return table;
  };
  const Table before = with_error("0.500", "2.25");
  const auto worse = [&](const Table& after) { return compare("old", before, "new", after).changes[1].worse; };
  CHECK(worse(with_error("0.500", "2.25")).empty());
  CHECK(worse(with_error("0.501", "2.20")).empty());  // rounded otherwise, and better
  CHECK(worse(with_error("0.510", "2.25")) == std::vector<std::string>{"error_db 0.500 -> 0.510"});
  CHECK(worse(with_error("0.400", "3.00")) == std::vector<std::string>{"error_grey 2.25 -> 3.00"});
  CHECK(worse(with_error("nan", "2.25")) == std::vector<std::string>{"error_db 0.500 -> nan"});
  CHECK(worse(run("X", 6, 7, 8)) == std::vector<std::string>{"error_grey 2.25 -> missing"});
  CHECK_THROWS_WITH(worse(with_error("good", "2.25")), Catch::Contains("line 2, column 'error_db': 'good'"));
}

TEST_CASE("an unchanged frame that runs anything has become worse") {
  const auto still = [](const char* runs) {
    Table table = run("X", 9, 10, 11);
    table.columns.emplace_back("runs_still");
    for (auto& row : table.rows) row.emplace_back(runs);
    return table;
  };
  CHECK(compare("old", still("0"), "new", still("0")).changes[0].worse.empty());
  CHECK(compare("old", still("0"), "new", still("1")).changes[0].worse.size() == 1);
}

TEST_CASE("settings that only one of two runs has are named") {
  Table before = run("X", 1, 2, 3), after = before;
  before.rows[1][2] = "65";
  after.rows[1][2] = "66";
  const Comparison compared = compare("old", before, "new", after);
  CHECK(compared.changes.size() == 1);
  CHECK(compared.gone == std::vector<std::string>{"case=b, lines=65"});
  CHECK(compared.arrived == std::vector<std::string>{"case=b, lines=66"});
}

TEST_CASE("runs that cannot be compared are refused") {
  Table other = run("X", 1, 2, 3);
  for (auto& row : other.rows) row[2] = "65";
  CHECK_THROWS_AS(compare("old", run("X", 1, 2, 3), "new", other), InputError);
  CHECK_THROWS_WITH(compare("old", {{"a"}, {{"1"}}}, "new", other), Catch::Contains("no column 'q1_ms'"));
  for (const char* none : {"0", "nan", "-3", "inf"}) {
    const Table good = run("X", 1, 2, 3);
    Table bad = good;
    bad.rows[1][bad.column("q3_ms")] = none;
    const auto refusal = [&](const char* file) {
      return Catch::Contains(std::string(file) + ": line 3, column 'q3_ms': '" + none + "' is not a positive time");
    };
    CHECK_THROWS_WITH(compare("old", bad, "new", good), refusal("old"));
    CHECK_THROWS_WITH(compare("old", good, "new", bad), refusal("new"));
  }
}

TEST_CASE("the plot names the front's settings and the levels of quality alone, and takes any name") {
  const std::string svg = front_svg("a < b", {{"P & Q",
                                               {{"quick", 1, 5, true, ""},
                                                {"slow", 8, 0.1, true, ""},
                                                {"beaten", 9, 6, false, ""},
                                                {"usual", 3, 6, false, "balanced"}}}});
  CHECK(svg.find("a &lt; b") != std::string::npos);
  CHECK(svg.find("P &amp; Q") != std::string::npos);
  CHECK(svg.find("quick: 1.0 ms") != std::string::npos);
  CHECK(svg.find("usual (balanced): 3.0 ms") != std::string::npos);
  CHECK(svg.find("beaten: 9.0 ms") == std::string::npos);
}

TEST_CASE("the levels of quality are points of the measured fronts") {
  const std::string machine = GENERATE("xeon-2-cores", "epyc-2-cores");
  const std::string file = INSONATE_DOCS_FOLDER "/benchmarks/" + machine + "/front.csv";
  const Table table = Table::parse(file, read_file(file));
  for (const Quality quality : kQualities) {
    const Settings settings = at_quality(trainer_settings(3.5, 160), quality);
    const std::string name = std::to_string(settings.samples) + " samples, " + std::to_string(settings.image_width) +
                             " x " + std::to_string(settings.image_height);
    INFO(name);
    int patients = 0;
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      if (table.cell(row, "setting") == name) {
        ++patients;
        CHECK(table.cell(row, "on_front") == "1");
      }
    CHECK(patients == 2);
  }
}

TEST_CASE("the converged reference shows the places that the fewer samples have") {
  Scene scene;
  scene.table = tiny_tissues();
  scene.volume.grid.size = {3, 3, 3};
  scene.volume.grid.spacing = glm::dvec3(300);
  scene.volume.grid.origin = glm::dvec3(-300);
  scene.volume.voxels.assign(27, {60, 0});
  Probe probe = *find_probe("curvilinear");
  probe.lines = 31;
  const ScanLines lines = scan_lines(probe, 100, 20);
  Settings settings;
  settings.gel_mm = 0;
  const Converged converged = converge(scene, lines, settings, 11);
  REQUIRE(converged.lines == std::vector<int>{0, 3, 6, 9, 12, 15, 18, 21, 24, 27, 30});
  for (const int i : {0, 10})
    for (int k = 0; k < 20; ++k) {
      const double r = (k + 0.5) * lines.dr_mm();  // 0.5 dB/(cm MHz) in this tissue
      CHECK(converged.intensity.at(i, k) ==
            Approx(std::pow(10.0, -0.5 * settings.frequency_mhz * r / 100)).epsilon(1e-9));
      CHECK(converged.reflection.at(i, k) == 0);
    }
}

TEST_CASE("a picture's error counts what is displayed: in dB within the dynamic range, in grey levels over the fan") {
  const Probe& probe = *find_probe("linear");
  Settings settings = trainer_settings(7.5, 60);
  const auto picture = [&](int w, int h, double level_db) {
    Stages<double> stages;
    const ImageGeometry geometry = image_geometry(probe, 60, w, h);
    stages.fused = Image<double>(w, h);
    stages.grey = stages.inside = Image<std::uint8_t>(w, h);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const auto at = line_position(probe, 60, geometry.plane_mm(x, y));
        if (!at) continue;
        // The gain in time makes up for 2 x 0.5 dB/(cm MHz), so that every pixel shows `level_db` below white.
        const double lost_db = 7.5 * at->r_mm / 10;
        stages.inside.at(x, y) = 1;
        stages.fused.at(x, y) = settings.fixed_level * std::pow(10.0, (level_db - lost_db) / 10);
        stages.grey.at(x, y) =
            std::uint8_t(std::lround(255 * std::clamp(1 + level_db / settings.dynamic_range_db, 0.0, 1.0)));
      }
    return displayed(stages, probe, 60, settings);
  };
  const double range_db = settings.dynamic_range_db;
  const Display converged = picture(80, 60, -20);
  CHECK(error_of(converged, converged, range_db).db == 0);
  for (const auto& [w, h] : {std::pair(80, 60), std::pair(31, 47)}) {
    CAPTURE(w, h);
    const DisplayError error = error_of(picture(w, h, -32), converged, range_db);
    CHECK(error.db == Approx(12));
    CHECK(error.grey == Approx(12 * 255 / range_db));
  }
  // Below black all is alike.
  CHECK(error_of(picture(80, 60, -70), converged, range_db).db == Approx(range_db - 20));
  CHECK(error_of(converged, picture(80, 60, -70), range_db).db == 0);
  CHECK(error_of(picture(80, 60, 3), picture(80, 60, 1), range_db).db == 0);
}
