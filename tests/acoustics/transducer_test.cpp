#include "sim/acoustics/transducer.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/probe/probe.h"
#include "tests/acoustics/helpers.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

const std::string kGood =
    "name = 'curvilinear'\ntitle = 'T'\nkind = 'curvilinear'\n"
    "[array]\nelements = 64\npitch_mm = 0.5\nkerf_mm = 0.05\nradius_mm = 40\n"
    "[elevation]\nheight_mm = 12\nfocus_mm = 70\n"
    "[pulse]\nfrequency_mhz = 3\nbandwidth_percent = 60\nexcitation_cycles = 2\n";

struct TemporaryFile {
  fs::path path = fs::temp_directory_path() / ("insonate-transducer-" + std::to_string(::getpid()) + ".toml");
  explicit TemporaryFile(const std::string& text) { write_file(path, text); }
  ~TemporaryFile() { fs::remove(path); }
};

std::string why_refused(const std::string& text) {
  const TemporaryFile file(text);
  try {
    read_transducer(file.path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string with(const std::string& line, const std::string& instead) {
  std::string text = kGood;
  const std::size_t at = text.find(line);
  REQUIRE(at != std::string::npos);
  return text.replace(at, line.size(), instead);
}

}  // namespace

TEST_CASE("every probe of the trainer has a bundled transducer of its kind and about its size") {
  for (const Probe& probe : probes()) {
    const Transducer transducer = test::shipped(probe.name);
    CAPTURE(probe.name, transducer.title);
    CHECK(transducer.name == probe.name);
    CHECK(transducer.kind == probe.kind);
    // Real arrays of the kind. The trainer's numbers are round: within a tenth in frequency, and in the face.
    CHECK(transducer.frequency_mhz == Approx(probe.frequency_mhz).epsilon(0.1));
    const double face =
        probe.kind == ProbeKind::curvilinear ? probe.radius_mm * glm::radians(probe.field_of_view_deg) : probe.width_mm;
    CHECK(transducer.face_mm() == Approx(face).epsilon(0.1));
  }
}

TEST_CASE("a transducer's file gives its numbers") {
  const TemporaryFile file(kGood);
  Transducer expected;
  expected.name = "curvilinear";
  expected.title = "T";
  expected.kind = ProbeKind::curvilinear;
  expected.elements = 64;
  expected.pitch_mm = 0.5;
  expected.kerf_mm = 0.05;
  expected.radius_mm = 40;
  expected.height_mm = 12;
  expected.elevation_focus_mm = 70;
  expected.frequency_mhz = 3;
  expected.bandwidth_percent = 60;
  expected.excitation_cycles = 2;
  CHECK(read_transducer(file.path) == expected);
}

TEST_CASE("a transducer without a lens has no elevation focus") {
  const TemporaryFile file(with("focus_mm = 70\n", ""));
  CHECK(read_transducer(file.path).elevation_focus_mm == 0);
}

TEST_CASE("numbers out of range, missing and unknown keys are refused by name") {
  for (const auto& [line, instead, named] : std::vector<std::array<std::string, 3>>{
           {"elements = 64", "elements = 0", "'elements'"},
           {"elements = 64", "elements = 1025", "'elements'"},
           {"elements = 64", "elements = 3.5", "'elements'"},
           {"pitch_mm = 0.5", "pitch_mm = 0.01", "'pitch_mm'"},
           {"pitch_mm = 0.5", "pitch_mm = nan", "'pitch_mm'"},
           {"kerf_mm = 0.05", "kerf_mm = -0.1", "'kerf_mm'"},
           {"kerf_mm = 0.05", "kerf_mm = 0.5", "'kerf_mm'"},
           {"radius_mm = 40", "radius_mm = 4", "'radius_mm'"},
           {"radius_mm = 40", "radius_mm = 10", "half a circle"},
           {"radius_mm = 40\n", "", "'radius_mm'"},
           {"kind = 'curvilinear'", "kind = 'linear'", "'radius_mm'"},
           {"kind = 'curvilinear'", "kind = 'convex'", "'kind'"},
           {"height_mm = 12", "height_mm = 0", "'height_mm'"},
           {"focus_mm = 70", "focus_mm = 0.5", "'focus_mm'"},
           {"frequency_mhz = 3", "frequency_mhz = 0.4", "'frequency_mhz'"},
           {"bandwidth_percent = 60", "bandwidth_percent = 121", "'bandwidth_percent'"},
           {"bandwidth_percent = 60\n", "", "'bandwidth_percent'"},
           {"excitation_cycles = 2", "excitation_cycles = 51", "'excitation_cycles'"},
           {"excitation_cycles = 2", "excitation_cycles = 2\nbandwith = 3", "'bandwith'"},
           {"title = 'T'\n", "", "'title'"}}) {
    CAPTURE(line, instead);
    const std::string why = why_refused(with(line, instead));
    CHECK(why.find(named) != std::string::npos);
  }
  CHECK(why_refused("this is not TOML").find("line 1") != std::string::npos);
}

TEST_CASE("an unknown probe has no bundled transducer") {
  CHECK_THROWS_AS(bundled_transducer("linaer"), InputError);
  CHECK_THROWS_AS(bundled_transducer("../tissues"), InputError);
}

TEST_CASE("elements lie a pitch apart on the face, and lines leave it at right angles") {
  const Transducer linear = test::shipped("linear"), curved = test::shipped("curvilinear");
  const std::vector<ElementPlace> flat = element_places(linear), arc = element_places(curved);
  REQUIRE(flat.size() == 192);
  CHECK(flat.front().centre.x == Approx(-95.5 * 0.2));
  CHECK(flat[100].centre.x - flat[99].centre.x == Approx(0.2));
  const glm::dvec3 centre(0, -curved.radius_mm, 0);
  for (const ElementPlace& place : arc) {
    CHECK(glm::distance(place.centre, centre) == Approx(curved.radius_mm));
    CHECK(glm::dot(place.lateral, place.centre - centre) == Approx(0).margin(1e-9));
  }
  CHECK(std::acos(glm::dot(arc[10].lateral, arc[11].lateral)) == Approx(curved.pitch_mm / curved.radius_mm));

  const ScanLine line = line_at(curved, 20);
  CHECK(glm::distance(line.start, centre) == Approx(curved.radius_mm));
  CHECK(glm::distance(line.start + 50.0 * line.direction, centre) == Approx(curved.radius_mm + 50));
  CHECK(line.start.x > 0);
  CHECK(line_at(linear, 3).start.x == Approx(3));
  CHECK(line_at(linear, 3).direction.y == Approx(1));
  const ScanLine steered = line_at(test::shipped("phased"), 30);
  CHECK(glm::length(steered.start) == Approx(0).margin(1e-12));
  CHECK(steered.direction.x == Approx(0.5));
}
