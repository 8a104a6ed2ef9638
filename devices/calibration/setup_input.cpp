#include "devices/calibration/setup_input.h"

#include <glm/geometric.hpp>

#include <cstdio>
#include <set>

#include "sim/files/files.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

constexpr std::size_t kMaxLandmarks = 64;

glm::dvec3 read_point(const TomlTable& table, const char* key) {
  const glm::dvec3 point = table.vector(key);
  if (!(glm::length(point) <= kTrackerRange_mm))
    table.fail(key, "the point lies 100 m away or farther", "give it in mm");
  return point;
}

}  // namespace

LandmarkList read_landmark_list(const std::filesystem::path& file) {
  const TomlDocument document(file.string(), read_file(file, kMaxSetupBytes));
  const TomlTable top = document.root();
  LandmarkList list{top.text("patient"), {}};
  std::set<std::string> names;
  std::size_t held_out = 0;
  for (const TomlTable& table : top.tables("landmark")) {
    list.landmarks.push_back({table.text("name"), {}, read_point(table, "ct_mm"), table.boolean("held_out", false)});
    held_out += list.landmarks.back().held_out;
    if (!names.insert(list.landmarks.back().name).second)
      table.fail("name", "a landmark before it has that name too", "name each of them differently");
  }
  top.refuse_unknown_keys();
  const std::size_t fitted = list.landmarks.size() - held_out;
  if (fitted < kMinLandmarks || held_out == 0 || list.landmarks.size() > kMaxLandmarks)
    top.fail(
        "",
        "there are " + std::to_string(fitted) + " landmarks to fit and " + std::to_string(held_out) + " to check by",
        "give " + std::to_string(kMinLandmarks) + " to " + std::to_string(kMaxLandmarks - 1) +
            ", and one or more with held_out = true");
  return list;
}

ProbeDrawing read_probe_drawing(const std::filesystem::path& file) {
  const TomlDocument document(file.string(), read_file(file, kMaxSetupBytes));
  const TomlTable top = document.root();
  ProbeDrawing drawing;
  drawing.name = top.text("name");
  drawing.face = {read_point(top, "middle_mm"), read_point(top, "marker_end_mm"), read_point(top, "other_end_mm"),
                  read_point(top, "tail_mm")};
  if (top.has("tip_mm")) drawing.tip_mm = read_point(top, "tip_mm");
  top.refuse_unknown_keys();
  if (const auto fit = fit_face(drawing.face); !fit) top.fail("", fit.refusal(), "correct the points");
  return drawing;
}

Outcome<FaceSetup> face_from_drawing(const ProbeDrawing& drawing, const std::optional<TipFit>& tip) {
  const Outcome<FaceFit> fit = fit_face(drawing.face);
  if (!fit) return Refusal{fit.refusal()};
  FaceSetup face{*fit, "drawing", 0};
  if (!tip || !drawing.tip_mm) return face;
  const glm::dvec3 off = tip->tip_mm - *drawing.tip_mm;
  face.tip_off_mm = glm::length(off);
  face.fit.sensor_from_face.translation += off;
  if (face.tip_off_mm <= kMaxTipOff_mm) return face;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "The tip was found %.0f mm from where the drawing has it; give the points along the sensor's own axes, or "
      "touch them.",
      face.tip_off_mm);
  return Refusal{text};
}

}  // namespace insonate
