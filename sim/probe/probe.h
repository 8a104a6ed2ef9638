#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// Where scan lines leave a transducer's face and how they spread.
enum class ProbeKind {
  linear,       ///< straight into the depth from a flat face
  curvilinear,  ///< square to a curved face
  phased,       ///< steered from a small flat face, all as if from one point behind it, a sector
};

/// A transducer. Its frame is described in sim/core/pose.h.
struct Probe {
  std::string name;   ///< "curvilinear"
  std::string title;  ///< as people read it: "Curvilinear"
  ProbeKind kind = ProbeKind::curvilinear;
  double radius_mm = 60;          ///< curvilinear: of the face, 5 to 200
  double field_of_view_deg = 60;  ///< curvilinear and phased: between the outer lines' outer edges, 5 to 150
  double width_mm = 40;           ///< linear and phased: of the face, 5 to 200
  double frequency_mhz = 3.5;     ///< centre frequency, 1 to 20
  double depth_mm = 160;          ///< default imaging depth, 10 to 400
  int lines = 192;                ///< scan lines, 1 to 4096

  bool operator==(const Probe&) const = default;
};

/// The probes that ship: "curvilinear" (abdomen, 3.5 MHz), "linear" (vessels and soft parts, 7.5 MHz) and "phased"
/// (heart and between ribs, 2.5 MHz).
const std::vector<Probe>& probes();
const Probe* find_probe(std::string_view name);
std::vector<std::string> probe_names();

/// How far behind the face's middle the lines of a fan (curvilinear, phased) meet, mm; a phased array's outer lines
/// leave at the face's edges.
double apex_behind_mm(const Probe& probe);

/// The face's edge on the marker's side, in the imaging plane (x lateral, y along the central beam), mm.
glm::dvec2 face_edge(const Probe& probe);

/// A line of sight: sample k sits at start + direction * r_k, r_k = r_min + (k + 1/2) dr. Probe frame, mm.
struct ScanLine {
  glm::dvec3 start{0.0};          ///< on the transducer's face
  glm::dvec3 direction{0, 1, 0};  ///< unit
};

/// What the traversal is given: it knows lines, not probes.
struct ScanLines {
  std::vector<ScanLine> lines;  ///< 1 to 4096
  int samples = 512;            ///< a line, 1 to 8192
  double r_min_mm = 0;          ///< where the first sample's share of a line begins, from its start; 0 or more
  double r_max_mm = 160;        ///< where the last one's ends, above r_min_mm

  double dr_mm() const { return (r_max_mm - r_min_mm) / samples; }
};

/// The scan lines of a probe at a depth, from the edge opposite the marker (-x) to the marker's edge (+x), at the
/// middles of `probe.lines` equal parts of the face (linear) or of the field of view (curvilinear, phased).
/// Each ends `depth_mm` along it from where it leaves the face. Throws nothing of its own: numbers out of range are
/// refused where they enter a program, and mean nothing here.
/// @param depth_mm  0.1 to 1000
/// @param samples   a line, 1 to 8192
ScanLines scan_lines(const Probe& probe, double depth_mm, int samples);

/// Where a point of the imaging plane (x lateral, y along the central beam, probe frame, mm) lies among the lines.
struct LinePosition {
  double line;  ///< 0 on the first line, N - 1 on the last; -1/2 and N - 1/2 at the fan's edges
  double r_mm;  ///< distance from the face along the line
};

/// Empty outside the fan: beyond its edges, in front of the face, or deeper than `depth_mm`.
/// @param depth_mm  0.1 to 1000
std::optional<LinePosition> line_position(const Probe& probe, double depth_mm, const glm::dvec2& xy_mm);

/// How pixels of the displayed image lie in the imaging plane: square pixels, the fan as large as fits, centred.
/// Pixel (x, y), counted from the top left, has its centre at top_left_mm + mm_per_pixel * (x, y) in the probe's plane.
struct ImageGeometry {
  int width = 640;
  int height = 480;
  double mm_per_pixel = 0.4;    ///< above 0
  glm::dvec2 top_left_mm{0.0};  ///< centre of the top left pixel

  glm::dvec2 plane_mm(double x, double y) const { return top_left_mm + mm_per_pixel * glm::dvec2(x, y); }
  glm::dvec2 pixel(const glm::dvec2& plane_mm) const { return (plane_mm - top_left_mm) / mm_per_pixel; }
};

/// Of the image that shows a probe's fan down to a depth, with as many millimetres a pixel as its wider side needs.
/// Numbers out of range mean nothing, as in scan_lines().
/// @param depth_mm       0.1 to 1000
/// @param width, height  pixels, 1 to 8192
ImageGeometry image_geometry(const Probe& probe, double depth_mm, int width, int height);

}  // namespace insonate
