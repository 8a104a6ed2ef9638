#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include "devices/calibration/calibration.h"
#include "devices/calibration/setup_input.h"
#include "devices/calibration/utc.h"
#include "sim/core/input_error.h"
#include "tests/core/temporary_folder.h"
#include "tests/devices/calibration/synthetic.h"

using namespace insonate;
using Catch::Contains;

namespace {

Calibration complete() {
  Dice dice(1);
  Calibration calibration;
  calibration.tracker = {"hydra", "A\"1\\2\n\xc3\xa4"};
  calibration.axes = Dated<AxesFinding>{{{{1, -1, 1}, {1, 1, -1}}, 7.25}, 1767225600};
  TipFit tip;
  tip.tip_mm = dice.point(200);
  tip.pivot_mm = dice.point(500);
  tip.residual_mm = 0.31;
  tip.spread_deg = 22.1;
  tip.used = 600;
  tip.rejected = 3;
  calibration.tip = Dated<TipFit>{tip, 1767225601};
  calibration.face = Dated<FaceSetup>{FaceSetup{{dice.pose(100), 1.5, 0.4}, "touch", 0}, 1767225602};
  MannequinSetup setup;
  setup.patient = "a patient";
  setup.ct_from_mannequin = dice.pose(400);
  setup.mannequin_from_tracker = dice.pose(400);
  setup.accuracy_mm = 2.25;
  setup.worst = "the navel";
  setup.worst_mm = 4;
  for (int i = 0; i < 7; ++i)
    setup.landmarks.push_back({"place " + std::to_string(i), dice.point(300), {1, -0.0, double(i)}, i == 6});
  calibration.mannequin = Dated<MannequinSetup>{setup, 1767225603};
  calibration.lag = Dated<KnockLag>{{0.041, 0.006, 10}, 1767225604};
  return calibration;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("a calibration is read back to the same bits") {
  const Calibration out = complete();
  const Calibration in = parse_calibration(to_toml(out), "lab.toml");
  CHECK(to_toml(in) == to_toml(out));
  CHECK(in.tracker == out.tracker);
  CHECK(in.mannequin->value.ct_from_mannequin == out.mannequin->value.ct_from_mannequin);
  CHECK(in.face->value.fit.sensor_from_face == out.face->value.fit.sensor_from_face);
  CHECK(in.tip->value.tip_mm == out.tip->value.tip_mm);
  CHECK(std::signbit(in.mannequin->value.landmarks[0].ct_mm.y));
  CHECK(in.axes->made_s == 1767225600);
  const Pose raw = Dice(5).pose(300);
  CHECK(in.patient_from_probe(raw) == out.patient_from_probe(raw));
  const Calibration only_begun = parse_calibration("[tracker]\nkind = 'hydra'\n", "lab.toml");
  CHECK(why_incomplete(only_begun) == "face");
  CHECK(to_toml(only_begun).find("serial") == std::string::npos);
}

TEST_CASE("a calibration is written under a temporary name and renamed") {
  const TemporaryFolder folder;
  write_calibration(folder.path / "lab.toml", complete());
  CHECK(to_toml(read_calibration(folder.path / "lab.toml")) == to_toml(complete()));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("a calibration that is not as it was written is refused in a sentence") {
  const std::string good = to_toml(complete());
  const struct {
    std::string text, says;
  } bad[] = {
      {"", "the key 'tracker' is missing"},
      {"[tracker", "this is not TOML"},
      {replaced(good, "kind = ", "kin = "),
       "the key 'kind' is missing; add it: a text between quotation marks, or rename 'kin'"},
      {replaced(good, "[axes]", "[axis]"), "the key 'axis' is unknown here; did you mean 'axes'?"},
      {replaced(good, "[axes]\n", "[axes]\nx = 1\n"), "the key 'x' is unknown"},
      {replaced(good, "2026-01-01T00:00:00Z", "2026-13-01T00:00:00Z"), "'made' is not a date and time"},
      {replaced(good, "position_signs = [1.0", "position_signs = [2.0"), "a sign is neither 1 nor -1"},
      {replaced(good, "misfit_deg = 7.25", "misfit_deg = 181"), "'misfit_deg' is 181"},
      {replaced(good, "residual_mm = 0.31", "residual_mm = -1"), "'residual_mm' is -1"},
      {replaced(good, "residual_mm = 0.31", "residual_mm = nan"), "'residual_mm' is nan"},
      {replaced(good, "used = 600", "used = 1e9"), "'used' is not a whole number"},
      {replaced(good, "tip_mm = [", "tip_mm = [inf, "), "'tip_mm' holds inf; write 3 finite numbers"},
      {replaced(good, "tip_mm = [", "tip_mm = [1, "), "'tip_mm' has 4 numbers"},
      {replaced(good, "tip_mm = [", "tip_mm = [1e300, 0, 0] # ["), "beyond any tracker's reach"},
      {replaced(good, "method = \"touch\"", "method = 'guess'"), "write \"touch\" or \"drawing\""},
      {replaced(good, "sensor_from_face = [", "sensor_from_face = [-9, "), "has 17 numbers"},
      {replaced(good, "0.0, 0.0, 0.0, 1.0]", "0.0, 0.0, 0.0, 2.0]"), "last row is not 0 0 0 1"},
      {replaced(good, "held_out = false", "held_out = 0"), "neither true nor false"},
      {good.substr(0, good.rfind("[[mannequin")), "there are 6 landmarks"},
      {replaced(good, "lag_s = 0.041", "lag_s = 5"), "'lag_s' is 5"},
      {replaced(good, good.substr(good.find("[tip]"), good.find("[face]") - good.find("[tip]")), ""), "no [tip]"},
  };
  for (const auto& [text, says] : bad) {
    CAPTURE(says);
    CHECK_THROWS_WITH(parse_calibration(text, "lab.toml"), Contains(says) && Catch::StartsWith("lab.toml: "));
  }
  // Cut anywhere it is refused or lacks what follows, and never crashes.
  for (std::size_t length = 0; length + 2 < good.size(); length += 7) {
    try {
      const Calibration cut = parse_calibration(good.substr(0, length), "lab.toml");
      CHECK_FALSE((cut.axes && cut.tip && cut.face && cut.lag && cut.mannequin &&
                   cut.mannequin->value.landmarks.size() == complete().mannequin->value.landmarks.size()));
    } catch (const InputError&) {
    }
  }
}

TEST_CASE("a calibration that was only begun is refused where a complete one is needed, with the step to make") {
  const TemporaryFolder folder;
  const auto file = folder.put("begun.toml", "[tracker]\nkind = 'hydra'\n");
  CHECK_THROWS_WITH(read_complete_calibration(file),
                    Contains("begun.toml: the step 'face' has not been made; run insonate-devices calibrate face"));
  write_calibration(folder.path / "lab.toml", complete());
  CHECK(read_complete_calibration(folder.path / "lab.toml").tip);
}

TEST_CASE("people are warned of a calibration that is old or another tracker's") {
  const Calibration calibration = complete();
  constexpr std::int64_t kMade = 1767225602, kDay = 86400;
  CHECK(calibration_warnings(calibration, calibration.tracker, kMade + 7 * kDay).empty());
  const auto old = calibration_warnings(calibration, calibration.tracker, kMade + 8 * kDay + 1);
  REQUIRE(old.size() == 1);
  CHECK_THAT(old[0], Contains("8 days old"));
  CHECK(calibration_warnings(calibration, calibration.tracker, kMade + 8 * kDay, 30).empty());
  const auto other = calibration_warnings(calibration, {"hydra", "2"}, kMade);
  REQUIRE(other.size() == 1);
  CHECK_THAT(other[0], Contains("another tracker") && Contains("this is hydra, serial 2"));
  CHECK(calibration_warnings(calibration, {"replay", ""}, kMade).empty());
}

TEST_CASE("dates are written and read, and no others are read") {
  CHECK(utc_text(0) == "1970-01-01T00:00:00Z");
  CHECK(utc_text(1767225599) == "2025-12-31T23:59:59Z");
  CHECK(utc_seconds("2024-02-29T12:00:01Z") == 1709208001);
  for (const char* none :
       {"", "2023-02-29T12:00:00Z", "2024-02-29 12:00:00Z", "2024-02-29T24:00:00Z", "2024-02-29T12:60:00Z",
        "2024-00-01T00:00:00Z", "2024-02-29T12:00:00", "+024-02-29T12:00:00Z"})
    CHECK_FALSE(utc_seconds(none));
}

TEST_CASE("landmark lists and drawings that cannot be used are refused in a sentence") {
  const TemporaryFolder folder;
  const auto file = [&](const std::string& text) { return folder.put("given.toml", text); };
  const LandmarkList built_in = read_landmark_list(std::string(INSONATE_ASSETS_FOLDER) + "/calibration/abdomen.toml");
  CHECK(built_in.landmarks.size() == 9);
  std::string few = "patient = 'p'\n";
  for (int i = 0; i < 6; ++i)
    few += "[[landmark]]\nname = 'n" + std::to_string(i) + "'\nct_mm = [1, 2, " + std::to_string(i) + "]\n";
  CHECK_THROWS_WITH(read_landmark_list(file(few)), Contains("6 landmarks to fit and 0 to check by"));
  CHECK_THROWS_WITH(read_landmark_list(file(few + "[[landmark]]\nname = 'n1'\nct_mm = [0, 0, 0]\nheld_out = true\n")),
                    Contains("a landmark before it has that name too"));
  CHECK_THROWS_WITH(read_landmark_list(file(few + "[[landmark]]\nname = 'n9'\nct_mm = [0, 0, 2e5]\n")),
                    Contains("100 m away"));
  CHECK_THROWS_AS(read_landmark_list(folder.path / "none.toml"), InputError);

  const std::string drawing =
      "name = 'd'\nmiddle_mm = [0, 0, 0]\nmarker_end_mm = [30, -12, 0]\nother_end_mm = [-30, -12, 0]\n";
  const ProbeDrawing read = read_probe_drawing(file(drawing + "tail_mm = [0, -150, 0]\ntip_mm = [1, 2, 3]\n"));
  CHECK(read.tip_mm == glm::dvec3(1, 2, 3));
  CHECK_THROWS_WITH(read_probe_drawing(file(drawing)), Contains("'tail_mm' is missing"));
  CHECK_THROWS_WITH(read_probe_drawing(file(drawing + "tail_mm = [0, 0, 10]\n")), Contains("tail lies too near"));
}
