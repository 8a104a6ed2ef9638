#include <cmath>
#include <cstdio>
#include <sstream>

#include "devices/calibration/calibration.h"
#include "devices/calibration/utc.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/core/toml_table.h"

namespace insonate {
namespace {

constexpr std::size_t kMostBytes = 1u << 20;
/// Beyond that nothing of a set-up lies (why_not_rigid has the same reach).
constexpr double kReachMm = 1e5;
/// A Viper has as many.
constexpr int kMostSensors = 16;

class Writer {
public:
  void line(const std::string& text) { text_ += text + "\n"; }
  void number(const char* key, double value) { line(std::string(key) + " = " + digits(value)); }
  void whole(const char* key, std::size_t value) { line(std::string(key) + " = " + std::to_string(value)); }
  void text(const char* key, const std::string& value) {
    std::ostringstream quoted;
    quoted << toml::table{{"v", value}};
    line(std::string(key) + " " + quoted.str().substr(quoted.str().find('=')));
  }
  void point(const char* key, const glm::dvec3& p) { numbers(key, {p.x, p.y, p.z}); }
  void pose(const char* key, const Pose& pose) {
    const glm::dmat4 m = pose.matrix();
    std::vector<double> rows;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) rows.push_back(m[column][row]);
    numbers(key, rows);
  }
  void section(const char* name, std::int64_t made_s) {
    line("");
    line(name);
    text("made", utc_text(made_s));
  }
  std::string done() && { return std::move(text_); }

private:
  // With a point, so that TOML takes it for a number that may be minus zero.
  static std::string digits(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return std::string(text).find_first_of(".en") == std::string::npos ? std::string(text) + ".0" : text;
  }
  void numbers(const char* key, const std::vector<double>& values) {
    std::string list;
    for (const double value : values) list += (list.empty() ? "" : ", ") + digits(value);
    line(std::string(key) + " = [" + list + "]");
  }
  std::string text_;
};

glm::dvec3 read_point(const TomlTable& table, const char* key) {
  const std::vector<double> v = table.numbers(key, 3);
  for (const double value : v)
    if (std::abs(value) > kReachMm) table.fail(key, "the point lies beyond any tracker's reach", "calibrate again");
  return {v[0], v[1], v[2]};
}

Pose read_pose(const TomlTable& table, const char* key) {
  const std::vector<double> rows = table.numbers(key, 16);
  glm::dmat4 m;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) m[column][row] = rows[std::size_t(4 * row + column)];
  if (const auto why = why_not_rigid(m)) table.fail(key, *why, "calibrate again");
  return pose_from_matrix(m);
}

glm::dvec3 read_signs(const TomlTable& table, const char* key) {
  const std::vector<double> v = table.numbers(key, 3);
  for (const double value : v)
    if (std::abs(value) != 1) table.fail(key, "a sign is neither 1 nor -1", "write three of them");
  return {v[0], v[1], v[2]};
}

std::size_t read_count(const TomlTable& table, const char* key) {
  return std::size_t(table.whole_number(key, 0, 100000000));
}

double read_mm(const TomlTable& table, const char* key) {
  return table.number(key, 0, kReachMm);
}

std::int64_t read_made(const TomlTable& table) {
  const auto seconds = utc_seconds(table.text("made"));
  if (!seconds) table.fail("made", "'made' is no date and time", "write it as in \"2026-03-01T09:30:00Z\"");
  return *seconds;
}

Dated<AxesFinding> read_axes(const TomlTable& table) {
  table.allow_only({"made", "position_signs", "quaternion_signs", "misfit_deg"});
  return {{{read_signs(table, "position_signs"), read_signs(table, "quaternion_signs")},
           table.number("misfit_deg", 0, 180)},
          read_made(table)};
}

Dated<TipFit> read_tip(const TomlTable& table) {
  table.allow_only({"made", "tip_mm", "pivot_mm", "residual_mm", "tip_sd_mm", "spread_deg", "used", "rejected"});
  TipFit tip;
  tip.tip_mm = read_point(table, "tip_mm");
  tip.pivot_mm = read_point(table, "pivot_mm");
  tip.residual_mm = read_mm(table, "residual_mm");
  tip.tip_sd_mm = read_mm(table, "tip_sd_mm");
  tip.spread_deg = table.number("spread_deg", 0, 90);
  tip.used = read_count(table, "used");
  tip.rejected = read_count(table, "rejected");
  return {tip, read_made(table)};
}

Dated<FaceSetup> read_face(const TomlTable& table) {
  table.allow_only({"made", "method", "sensor_from_face", "skew_deg", "off_middle_mm", "tip_off_mm"});
  FaceSetup face;
  face.method = table.text("method");
  if (face.method != "touch" && face.method != "drawing")
    table.fail("method", "'method' is '" + face.method + "'", "write \"touch\" or \"drawing\"");
  face.fit.sensor_from_face = read_pose(table, "sensor_from_face");
  face.fit.skew_deg = table.number("skew_deg", 0, 90);
  face.fit.off_middle_mm = read_mm(table, "off_middle_mm");
  face.tip_off_mm = read_mm(table, "tip_off_mm");
  return {face, read_made(table)};
}

Dated<MannequinSetup> read_mannequin(const TomlTable& table) {
  table.allow_only({"made", "patient", "ct_from_mannequin", "mannequin_from_tracker", "accuracy_mm", "residual_mm",
                    "worst", "worst_mm", "landmark"});
  MannequinSetup setup;
  setup.patient = table.text("patient");
  setup.ct_from_mannequin = read_pose(table, "ct_from_mannequin");
  setup.mannequin_from_tracker = read_pose(table, "mannequin_from_tracker");
  setup.accuracy_mm = read_mm(table, "accuracy_mm");
  setup.residual_mm = read_mm(table, "residual_mm");
  setup.worst = table.text("worst");
  setup.worst_mm = read_mm(table, "worst_mm");
  for (const TomlTable& landmark : table.tables("landmark")) {
    landmark.allow_only({"name", "mannequin_mm", "ct_mm", "held_out"});
    setup.landmarks.push_back({landmark.text("name"), read_point(landmark, "mannequin_mm"),
                               read_point(landmark, "ct_mm"), landmark.boolean("held_out")});
  }
  if (setup.landmarks.size() <= kLeastLandmarks)
    table.fail("landmark", "there are " + std::to_string(setup.landmarks.size()) + " landmarks",
               "touch " + std::to_string(kLeastLandmarks + 1) + " or more");
  return {setup, read_made(table)};
}

Dated<KnockLag> read_lag(const TomlTable& table) {
  table.allow_only({"made", "lag_s", "spread_s", "knocks"});
  return {{table.number("lag_s", kLeastLagS, kMostLagS), table.number("spread_s", 0, 1), read_count(table, "knocks")},
          read_made(table)};
}

}  // namespace

std::string to_toml(const Calibration& calibration) {
  Writer out;
  out.line("# A tracker's calibration, as Insonate writes it. docs/calibration.md says what each key means.");
  out.line("");
  out.line("[tracker]");
  out.text("kind", calibration.tracker.kind);
  if (!calibration.tracker.serial.empty()) out.text("serial", calibration.tracker.serial);
  if (calibration.tracker.sensor != 1) out.whole("sensor", std::size_t(calibration.tracker.sensor));
  if (const auto& axes = calibration.axes) {
    out.section("[axes]", axes->made_s);
    out.point("position_signs", axes->value.signs.position);
    out.point("quaternion_signs", axes->value.signs.quaternion);
    out.number("misfit_deg", axes->value.misfit_deg);
  }
  if (const auto& tip = calibration.tip) {
    out.section("[tip]", tip->made_s);
    out.point("tip_mm", tip->value.tip_mm);
    out.point("pivot_mm", tip->value.pivot_mm);
    out.number("residual_mm", tip->value.residual_mm);
    out.number("tip_sd_mm", tip->value.tip_sd_mm);
    out.number("spread_deg", tip->value.spread_deg);
    out.whole("used", tip->value.used);
    out.whole("rejected", tip->value.rejected);
  }
  if (const auto& face = calibration.face) {
    out.section("[face]", face->made_s);
    out.text("method", face->value.method);
    out.pose("sensor_from_face", face->value.fit.sensor_from_face);
    out.number("skew_deg", face->value.fit.skew_deg);
    out.number("off_middle_mm", face->value.fit.off_middle_mm);
    out.number("tip_off_mm", face->value.tip_off_mm);
  }
  if (const auto& lag = calibration.lag) {
    out.section("[lag]", lag->made_s);
    out.number("lag_s", lag->value.lag_s);
    out.number("spread_s", lag->value.spread_s);
    out.whole("knocks", lag->value.knocks);
  }
  if (const auto& mannequin = calibration.mannequin) {
    out.section("[mannequin]", mannequin->made_s);
    out.text("patient", mannequin->value.patient);
    out.pose("ct_from_mannequin", mannequin->value.ct_from_mannequin);
    out.pose("mannequin_from_tracker", mannequin->value.mannequin_from_tracker);
    out.number("accuracy_mm", mannequin->value.accuracy_mm);
    out.number("residual_mm", mannequin->value.residual_mm);
    out.text("worst", mannequin->value.worst);
    out.number("worst_mm", mannequin->value.worst_mm);
    for (const LandmarkPair& landmark : mannequin->value.landmarks) {
      out.line("\n[[mannequin.landmark]]");
      out.text("name", landmark.name);
      out.point("mannequin_mm", landmark.touched_mm);
      out.point("ct_mm", landmark.ct_mm);
      out.line(std::string("held_out = ") + (landmark.held_out ? "true" : "false"));
    }
  }
  return std::move(out).done();
}

Calibration parse_calibration(std::string_view text, const std::string& file) {
  const toml::table parsed = parse_toml(file, text);
  const TomlTable top(file, "", parsed);
  top.allow_only({"tracker", "axes", "tip", "face", "mannequin", "lag"});
  Calibration calibration;
  const TomlTable tracker = top.table("tracker");
  tracker.allow_only({"kind", "serial", "sensor"});
  calibration.tracker.kind = tracker.text("kind");
  if (tracker.has("serial")) calibration.tracker.serial = tracker.text("serial");
  if (tracker.has("sensor")) calibration.tracker.sensor = tracker.whole_number("sensor", 1, kMostSensors);
  if (top.has("axes")) calibration.axes = read_axes(top.table("axes"));
  if (top.has("tip")) calibration.tip = read_tip(top.table("tip"));
  if (top.has("face")) calibration.face = read_face(top.table("face"));
  if (top.has("mannequin")) calibration.mannequin = read_mannequin(top.table("mannequin"));
  if (top.has("lag")) calibration.lag = read_lag(top.table("lag"));
  const bool touched = calibration.mannequin || (calibration.face && calibration.face->value.method == "touch");
  if (touched && !calibration.tip)
    top.fail("", "it has points that were touched but no [tip] to touch them with", "calibrate the tip again");
  return calibration;
}

Calibration read_calibration(const std::filesystem::path& file) {
  return parse_calibration(read_file(file, kMostBytes), file.string());
}

Calibration read_complete_calibration(const std::filesystem::path& file) {
  Calibration calibration = read_calibration(file);
  if (const std::string missing = why_incomplete(calibration); !missing.empty())
    throw InputError(file.string(), "", "the step '" + missing + "' has not been made",
                     "make it: 'insonate-devices calibrate " + missing + " --tracker URI --out " + file.string() + "'");
  return calibration;
}

void write_calibration(const std::filesystem::path& file, const Calibration& calibration) {
  write_file(file, to_toml(calibration));
}

}  // namespace insonate
