// insonate-bench as a person runs it, on a small case and with settings that take no time. What it measures depends on
// the machine and is not asserted.

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include "sim/files/files.h"
#include "tests/core/run_program.h"
#include "tests/core/temporary_folder.h"
#include "tests/scenarios/tiny_case.h"
#include "tools/bench/tables/table.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

struct Fixture {
  TemporaryFolder temporary;
  fs::path folder = temporary.path;
  fs::path csv = folder / "table.csv";
  std::string output;

  Fixture() { write_case(folder / "tiny", tiny_case()); }

  int run(const std::string& arguments) {
    ProgramOutcome outcome = run_program(std::string(INSONATE_BENCH_PROGRAM) + " " + arguments + " 2>&1");
    output = std::move(outcome.output);
    return outcome.code;
  }

  /// Runs a measurement of two small configurations and checks what every table must hold.
  bench::Table measure(const std::string& command, const std::string& configurations = "24,40,40,30,18,30,20,30") {
    const int exit_code = run(command + " --case " + (folder / "tiny").string() + " --frames 3 --configuration " +
                              configurations + " --csv " + csv.string());
    INFO(output);
    REQUIRE(exit_code == 0);
    bench::Table table = bench::Table::parse("table.csv", read_file(csv));
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const auto number = [&](const char* name) { return table.number("table.csv", i, name); };
      CHECK(table.cell(i, "case") == "Ball in a block");
      CHECK_FALSE(table.cell(i, "device").empty());
      CHECK(number("q1_ms") > 0);
      CHECK(number("q1_ms") <= number("median_ms"));
      CHECK(number("median_ms") <= number("q3_ms"));
    }
    return table;
  }
};

}  // namespace

TEST_CASE("insonate-bench paper: both methods see the same, and the ratio on the last line is the table's smallest") {
  Fixture f;
  const bench::Table table = f.measure("paper");
  REQUIRE(table.rows.size() == 8);  // two modes, two configurations, two methods
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < table.rows.size(); i += 2) {
    const auto number = [&](std::size_t row, const char* name) { return table.number("table.csv", row, name); };
    CHECK(table.cell(i, "method") == "passes");
    CHECK(table.cell(i + 1, "method") == "insonate");
    CHECK(table.cell(i, "lines") == (i % 4 == 0 ? "24" : "18"));
    smallest = std::min(smallest, number(i, "median_ms") / number(i + 1, "median_ms"));
    // Single precision moves both by 1e-4 at most, which is 4e-4 dB; the distance between samples costs far more.
    CHECK(number(i, "error_db") > 0);
    CHECK(number(i, "error_db") == Approx(number(i + 1, "error_db")).margin(1e-3));
    CHECK(number(i, "error_r_db") == Approx(number(i + 1, "error_r_db")).margin(1e-3));
    CHECK(number(i, "evaluated") == number(i, "possible"));
    CHECK(number(i + 1, "evaluated") <= number(i, "possible"));
  }
  const std::string words = "\nsmallest ratio ";
  const std::size_t last = f.output.rfind(words);
  REQUIRE(last != std::string::npos);
  // Two digits behind the point, from times of which the CSV keeps four.
  CHECK(std::stod(f.output.substr(last + words.size())) == Approx(smallest).epsilon(0.01).margin(0.006));
}

TEST_CASE("insonate-bench frames: each mode, what each stage takes, and a still frame that runs none") {
  Fixture f;
  const bench::Table table = f.measure("frames");
  REQUIRE(table.rows.size() == 3 * 2);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    CHECK(table.cell(i, "mode") == std::array{"paper", "trainer", "machine"}[i / 2]);
    if (i >= 4) continue;  // its stages are the trainer's
    for (const char* stage : {"traverse", "beam", "scan_convert", "smooth", "fuse"})
      CHECK(table.number("table.csv", i, std::string(stage) + "_ms") > 0);
    CHECK(table.cell(i, "runs_still") == "0");
  }
}

TEST_CASE("insonate-bench work-division: both ways to walk along a line, in both modes") {
  Fixture f;
  const bench::Table table = f.measure("work-division");
  REQUIRE(table.rows.size() == 2 * 2 * 2);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto number = [&](std::size_t row, const char* name) { return table.number("table.csv", row, name); };
    CHECK(table.cell(i, "method") == std::array{"invocation", "group"}[i % 2]);
    CHECK(table.cell(i, "mode") == std::array{"paper", "trainer"}[i / 4]);
    CHECK(table.cell(i, "planes") == "1");
    CHECK(number(i, "evaluated") > 0);
    CHECK(number(i, "evaluated") <= number(i, "possible"));
    if (i % 2 == 1) CHECK(number(i, "evaluated") >= number(i - 1, "evaluated"));
  }
  CHECK(f.output.find("of this device: a line ") != std::string::npos);
}

TEST_CASE("insonate-bench batch: images and LC2, one a call and many, as throughput") {
  Fixture f;
  const bench::Table table = f.measure("batch");
  constexpr const char* kMethods[] = {"images", "images", "LC2", "LC2", "model S", "fetches"};
  REQUIRE(table.rows.size() == 2 * 6);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    CHECK((table.number("table.csv", i, "images_per_call") > 1) == (i % 6 % 2 == 1));
    CHECK(table.cell(i, "method") == kMethods[i % 6]);
    // Times keep seven digits behind the point. On a graphics card they are some thousandths of a millisecond.
    CHECK(table.number("table.csv", i, "images_per_second") * table.number("table.csv", i, "median_ms") ==
          Approx(1000).epsilon(0.01));
    const double pixels = table.number("table.csv", i, "width") * table.number("table.csv", i, "height");
    CHECK(table.number("table.csv", i, "mpixels_per_second") ==
          Approx(table.number("table.csv", i, "images_per_second") * pixels * 1e-6).epsilon(0.01).margin(0.006));
  }
  CHECK(f.output.find(" MPixel/s; ") != std::string::npos);
}

TEST_CASE("insonate-bench throughput: images of the device and of the processor, and a plot of both") {
  Fixture f;
  const fs::path svg = f.folder / "throughput.svg";
  const bench::Table table = f.measure("throughput --svg " + svg.string());
  constexpr const char* kMethods[] = {"OpenGL", "plain", "vectorised"};
  REQUIRE(table.rows.size() == 2 * 3);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    CHECK(table.cell(i, "method") == kMethods[i % 3]);
    CHECK(table.cell(i, "images_per_call") == "1");
    const double plain_ms = table.number("table.csv", i / 3 * 3 + 1, "median_ms");
    // Times keep seven digits behind the point. On a graphics card they are some thousandths of a millisecond.
    // Speed-ups keep four, because the software renderer of a busy machine takes many times as long as the plain
    // implementation.
    CHECK(table.number("table.csv", i, "speed_up_of_plain") * table.number("table.csv", i, "median_ms") ==
          Approx(plain_ms).epsilon(0.02).margin(0.001));
  }
  CHECK(read_file(svg).find("<polyline") != std::string::npos);
}

TEST_CASE("insonate-bench sweep: a volume with a moving probe, of the same lines elsewhere, and with another gain") {
  Fixture f;
  const bench::Table table = f.measure("sweep", "12,40,16,20");
  REQUIRE(table.rows.size() == 3);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    CHECK(table.cell(i, "method") == std::array{"moved", "scan converted", "gained"}[i]);
    CHECK(table.cell(i, "planes") == "64");
    CHECK(table.cell(i, "depth") == "16");
  }
}

TEST_CASE("insonate-bench front: errors against the converged reference, a front, and a plot of it") {
  Fixture f;
  const fs::path svg = f.folder / "front.svg";
  const bench::Table table =
      f.measure("front --svg " + svg.string(), "24,1600,60,45,24,200,60,45,24,1600,15,11,24,800,45,34");
  REQUIRE(table.rows.size() == 4 + 11);
  const auto error = [&](std::size_t row) { return table.number("table.csv", row, "error_db"); };
  CHECK(error(0) > 0);
  CHECK(error(1) > 2 * error(0));  // an eighth of the samples
  CHECK(error(2) > 2 * error(0));  // a sixteenth of the pixels
  CHECK(table.cell(4, "setting") == "nothing skipped");
  CHECK(error(4) < 1.1 * error(0));  // what is skipped is not seen, so nothing is gained by it
  CHECK(table.cell(5, "setting") == "exact filtering");
  CHECK(error(5) == Approx(error(0)).epsilon(0.1));  // the filter's error is small beside the others
  CHECK(table.number("table.csv", 0, "volume_mib") > 0);
  CHECK(table.cell(6, "setting") == "no speckle");
  CHECK(error(6) > 2);  // the envelope of speckle is off by 5.6 dB from its mean wherever there is echo
  for (std::size_t i = 7; i < table.rows.size(); ++i) {
    INFO(table.cell(i, "setting"));
    CHECK(error(i) != error(0));  // each draws something else
  }
  CHECK(std::count_if(table.rows.begin(), table.rows.end(), [](const auto& row) { return row.back() == "1"; }) >= 1);
  CHECK(read_file(svg).starts_with("<svg"));
  CHECK(f.output.find("\nbalanced, the default, ") != std::string::npos);
  CHECK(f.output.find("45 x 34 (fast)\n") != std::string::npos);
  CHECK(f.output.find("\nfast ") != std::string::npos);
}

TEST_CASE("insonate-bench denormal: behind gas and bone and in tissue, neither with denormal numbers") {
  Fixture f;
  REQUIRE(f.run("denormal --frames 3 --csv " + f.csv.string()) == 0);
  INFO(f.output);
  const bench::Table table = bench::Table::parse("table.csv", read_file(f.csv));
  REQUIRE(table.rows.size() == 2);
  CHECK(table.cell(0, "case") == "tissue");
  CHECK(table.cell(1, "case") == "behind gas and bone");
  for (const std::size_t row : {0u, 1u}) {
    CHECK(table.number("table.csv", row, "median_ms") > 0);
    CHECK(table.cell(row, "denormal") == "0");
    CHECK(table.number("table.csv", row, "faintest") > 0);
  }
  CHECK(table.number("table.csv", 0, "faintest") > 0.1);
  CHECK(table.number("table.csv", 1, "faintest") < 1e-18);
}

TEST_CASE("insonate-bench filter: what the device's own filter is off by, and whether to do without it") {
  Fixture f;
  REQUIRE(f.run("filter --csv " + f.csv.string()) == 0);
  INFO(f.output);
  const bench::Table table = bench::Table::parse("table.csv", read_file(f.csv));
  REQUIRE(table.rows.size() == 1);
  const double largest = table.number("table.csv", 0, "largest_error");
  CHECK(table.number("table.csv", 0, "rms_error") <= largest);
  CHECK(largest < 0.02);  // less than the 6 bits that nothing has
  const bool coarse = table.cell(0, "coarse") == "1";
  CHECK(coarse == (largest > 2e-5));
  CHECK((f.output.find("\nCoarse: ") != std::string::npos) == coarse);
  CHECK((f.output.find("\nFine: ") != std::string::npos) == !coarse);
}

TEST_CASE("insonate-bench compare: a run against itself has not changed") {
  Fixture f;
  f.measure("frames");
  CHECK(f.run("compare " + f.csv.string() + " " + f.csv.string()) == 0);
  CHECK(f.output.find("6 settings, median ratio 1.000; beyond the spread: 0 slower, 0 faster; worse otherwise: 0") !=
        std::string::npos);
}

TEST_CASE("insonate-bench measures the EGL device that is asked for, and says loudly when it is not a graphics card") {
  Fixture f;
  ::setenv("INSONATE_EGL_DEVICE", "99", 1);
  CHECK(f.run("frames --case " + (f.folder / "tiny").string()) == 2);
  CHECK(f.output.starts_with("insonate-bench: INSONATE_EGL_DEVICE: there is no EGL device 99; "));
  ::unsetenv("INSONATE_EGL_DEVICE");
  const bench::Table table = f.measure("frames");
  const bool software = table.cell(0, "device").find("llvmpipe") != std::string::npos;
  CHECK((f.output.find("SOFTWARE RENDERER") != std::string::npos) == software);
}

TEST_CASE("insonate-bench says what is wrong in one line and exits with 2") {
  Fixture f;
  const std::string tiny = "--case " + (f.folder / "tiny").string();
  const std::pair<std::string, const char*> wrong[] = {
      {"frames --case /nowhere/ct.nii.gz", "/nowhere/ct.nii.gz"},
      {"paper " + tiny + " --view bal", "did you mean 'ball'?"},
      {"front " + tiny + " --configuration 1,2,3", "LINES,SAMPLES,WIDTH,HEIGHT"},
      {"frames " + tiny + " --configuration 1,2,3,0", "0 lies outside 1 to 8192"},
      {"compare /nowhere/a.csv /nowhere/b.csv", "/nowhere/a.csv"},
      {"compare /dev/null /dev/null", "not an ordinary file"},
  };
  for (const auto& [arguments, expected] : wrong) {
    CAPTURE(arguments);
    CHECK(f.run(arguments) == 2);
    CAPTURE(f.output);
    CHECK(f.output.find(expected) != std::string::npos);
    CHECK(std::count(f.output.begin(), f.output.end(), '\n') <= 2);  // the device, then the sentence
  }
  // Found out while it measures.
  const std::pair<std::string, const char*> beyond[] = {
      {"frames --configuration 1,1,1,1", "--configuration: 1 samples: 'reflection_length_mm' is"},
      {"paper --configuration 1,1,1,1", "--configuration: 1 samples: 'reflection_length_mm' is"},
      {"frames --configuration 4096,8192,64,64", "--configuration: 33554432 samples or pixels are above the device's"},
  };
  REQUIRE(f.run("frames " + tiny + " --frames 3 --configuration 18,30,20,30") == 0);
  const bool small_device = f.output.starts_with("llvmpipe");  // a graphics card may take the last
  for (const auto& [arguments, expected] : beyond) {
    if (&expected == &std::end(beyond)[-1].second && !small_device) continue;
    CAPTURE(arguments);
    const int code = f.run(arguments + " " + tiny + " --frames 3");
    CAPTURE(f.output);
    CHECK(code == 2);
    CHECK(f.output.find(expected) != std::string::npos);
  }
  CHECK(f.run("") == 2);
  CHECK(f.run("--help") == 0);
}
