#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "devices/calibration/calibration.h"
#include "devices/calibration/utc.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"
#include "sim/files/toml_value.h"

namespace insonate {
namespace {

/// As many as a Viper has.
constexpr int kMaxSensors = 16;

/// The keys of each section are listed once, in fields() below. A Reader and a Writer traverse them.

template <typename Io>
void fields(Io& io, AxesFinding& axes) {
  io.signs("position_signs", axes.signs.position);
  io.signs("quaternion_signs", axes.signs.quaternion);
  io.number("misfit_deg", axes.misfit_deg, 0, 180);
}

template <typename Io>
void fields(Io& io, TipFit& tip) {
  io.point("tip_mm", tip.tip_mm);
  io.point("pivot_mm", tip.pivot_mm);
  io.number("residual_mm", tip.residual_mm, 0, kTrackerRange_mm);
  io.number("tip_sd_mm", tip.tip_sd_mm, 0, kTrackerRange_mm);
  io.number("spread_deg", tip.spread_deg, 0, 90);
  io.count("used", tip.used);
  io.count("rejected", tip.rejected);
}

template <typename Io>
void fields(Io& io, FaceSetup& face) {
  io.text("method", face.method);
  io.pose("sensor_from_face", face.fit.sensor_from_face);
  io.number("skew_deg", face.fit.skew_deg, 0, 90);
  io.number("off_middle_mm", face.fit.off_middle_mm, 0, kTrackerRange_mm);
  io.number("tip_off_mm", face.tip_off_mm, 0, kTrackerRange_mm);
}

template <typename Io>
void fields(Io& io, KnockLag& lag) {
  io.number("lag_s", lag.lag_s, kMinLag_s, kMaxLag_s);
  io.number("spread_s", lag.spread_s, 0, 1);
  io.count("knocks", lag.knocks);
}

template <typename Io>
void fields(Io& io, LandmarkPair& landmark) {
  io.text("name", landmark.name);
  io.point("mannequin_mm", landmark.touched_mm);
  io.point("ct_mm", landmark.ct_mm);
  io.flag("held_out", landmark.held_out);
}

template <typename Io>
void fields(Io& io, MannequinSetup& mannequin) {
  io.text("patient", mannequin.patient);
  io.pose("ct_from_mannequin", mannequin.ct_from_mannequin);
  io.pose("mannequin_from_tracker", mannequin.mannequin_from_tracker);
  io.number("accuracy_mm", mannequin.accuracy_mm, 0, kTrackerRange_mm);
  io.number("residual_mm", mannequin.residual_mm, 0, kTrackerRange_mm);
  io.text("worst", mannequin.worst);
  io.number("worst_mm", mannequin.worst_mm, 0, kTrackerRange_mm);
  io.landmarks("landmark", mannequin.landmarks);
}

class Writer {
public:
  void line(const std::string& text) { text_ += text + "\n"; }
  void text(const char* key, const std::string& value) { line(std::string(key) + " = " + toml_value(value)); }
  void number(const char* key, double value, double, double) { line(std::string(key) + " = " + toml_value(value)); }
  void count(const char* key, std::size_t value) { line(std::string(key) + " = " + std::to_string(value)); }
  void flag(const char* key, bool value) { line(std::string(key) + (value ? " = true" : " = false")); }
  void signs(const char* key, const glm::dvec3& p) { point(key, p); }
  void point(const char* key, const glm::dvec3& p) { numbers(key, {p.x, p.y, p.z}); }
  void pose(const char* key, const Pose& pose) {
    const glm::dmat4 m = pose.matrix();
    std::vector<double> rows;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) rows.push_back(m[column][row]);
    numbers(key, rows);
  }
  void landmarks(const char* key, std::vector<LandmarkPair>& landmarks) {
    for (LandmarkPair& landmark : landmarks) {
      line("\n[[mannequin." + std::string(key) + "]]");
      fields(*this, landmark);
    }
  }
  template <typename T>
  void section(const char* name, const std::optional<Dated<T>>& section) {
    if (!section) return;
    line("\n[" + std::string(name) + "]");
    text("made", utc_text(section->made_s));
    T value = section->value;
    fields(*this, value);
  }
  std::string done() && { return std::move(text_); }

private:
  void numbers(const char* key, const std::vector<double>& values) {
    line(std::string(key) + " = " + toml_value(values));
  }
  std::string text_;
};

class Reader {
public:
  explicit Reader(const TomlTable& table) : table_(table) {}

  void text(const char* key, std::string& value) { value = table_.text(key); }
  void number(const char* key, double& value, double least, double most) { value = table_.number(key, {least, most}); }
  void count(const char* key, std::size_t& value) { value = std::size_t(table_.whole_number(key, 0, 100000000)); }
  void flag(const char* key, bool& value) { value = table_.boolean(key); }
  void signs(const char* key, glm::dvec3& signs) {
    signs = table_.vector(key);
    if (glm::abs(signs) != glm::dvec3(1.0)) table_.fail(key, "a sign is neither 1 nor -1", "write three of them");
  }
  void point(const char* key, glm::dvec3& point) {
    point = table_.vector(key);
    if (glm::any(glm::greaterThan(glm::abs(point), glm::dvec3(kTrackerRange_mm))))
      table_.fail(key, "the point lies beyond any tracker's reach", "calibrate again");
  }
  void pose(const char* key, Pose& pose) {
    const std::vector<double> rows = table_.numbers(key, 16);
    glm::dmat4 m;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) m[column][row] = rows[std::size_t(4 * row + column)];
    if (const auto why = why_not_rigid(m)) table_.fail(key, *why, "calibrate again");
    pose = pose_from_matrix(m);
  }
  void landmarks(const char* key, std::vector<LandmarkPair>& landmarks) {
    for (const TomlTable& table : table_.tables(key)) landmarks.push_back(read<LandmarkPair>(table));
    if (landmarks.size() <= kMinLandmarks)
      table_.fail(key, "there are " + std::to_string(landmarks.size()) + " landmarks",
                  "touch " + std::to_string(kMinLandmarks + 1) + " or more");
  }

  template <typename T>
  static T read(const TomlTable& table) {
    T value;
    Reader reader(table);
    fields(reader, value);
    return value;
  }

private:
  TomlTable table_;
};

template <typename T>
void read_section(const TomlTable& top, const char* name, std::optional<Dated<T>>& section) {
  if (!top.has(name)) return;
  const TomlTable table = top.table(name);
  T value = Reader::read<T>(table);
  const auto made = utc_seconds(table.text("made"));
  if (!made) table.fail("made", "'made' is not a date and time", "write it as in \"2026-03-01T09:30:00Z\"");
  section = Dated<T>{std::move(value), *made};
}

}  // namespace

std::string to_toml(const Calibration& calibration) {
  Writer out;
  out.line("# A tracker's calibration, as Insonate writes it. docs/calibration.md says what each key means.");
  out.line("\n[tracker]");
  out.text("kind", calibration.tracker.kind);
  if (!calibration.tracker.serial.empty()) out.text("serial", calibration.tracker.serial);
  if (calibration.tracker.sensor != 1) out.count("sensor", std::size_t(calibration.tracker.sensor));
  out.section("axes", calibration.axes);
  out.section("tip", calibration.tip);
  out.section("face", calibration.face);
  out.section("lag", calibration.lag);
  out.section("mannequin", calibration.mannequin);
  return std::move(out).done();
}

Calibration parse_calibration(std::string_view text, const std::string& file) {
  const TomlDocument document(file, text);
  const TomlTable top = document.root();
  Calibration calibration;
  const TomlTable tracker = top.table("tracker");
  calibration.tracker.kind = tracker.text("kind");
  calibration.tracker.serial = tracker.text("serial", "");
  calibration.tracker.sensor = int(tracker.whole_number("sensor", 1, kMaxSensors, 1));
  read_section(top, "axes", calibration.axes);
  read_section(top, "tip", calibration.tip);
  read_section(top, "face", calibration.face);
  read_section(top, "mannequin", calibration.mannequin);
  read_section(top, "lag", calibration.lag);
  top.refuse_unknown_keys();
  const std::string method = calibration.face ? calibration.face->value.method : "touch";
  if (method != "touch" && method != "drawing")
    top.table("face").fail("method", "'method' is '" + method + "'", "write \"touch\" or \"drawing\"");
  const bool touched = calibration.mannequin || (calibration.face && method == "touch");
  if (touched && !calibration.tip)
    top.fail("", "it has points that were touched but no [tip] to touch them with", "calibrate the tip again");
  return calibration;
}

Calibration read_calibration(const std::filesystem::path& file) {
  return parse_calibration(read_file(file, kMaxSetupBytes), file.string());
}

Calibration read_complete_calibration(const std::filesystem::path& file) {
  Calibration calibration = read_calibration(file);
  if (const std::string missing = why_incomplete(calibration); !missing.empty())
    throw InputError(file.string(), "", "the step '" + missing + "' has not been made",
                     "run insonate-devices calibrate " + missing + " --tracker URI --out " + shell_word(file.string()) +
                         " to make it");
  return calibration;
}

void write_calibration(const std::filesystem::path& file, const Calibration& calibration) {
  write_file(file, to_toml(calibration));
}

}  // namespace insonate
