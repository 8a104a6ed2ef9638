#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insonate {

/// How scan lines leave a transducer's face and how they spread.
enum class ProbeKind {
  linear,       ///< parallel, from a flat face
  curvilinear,  ///< perpendicular to a curved face
  phased,       ///< a sector steered from a small flat face, as if from one point behind it
};

/// A transducer. sim/core/pose.h describes its frame.
struct Probe {
  std::string name;   ///< "curvilinear"
  std::string title;  ///< the name on the screen: "Curvilinear"
  ProbeKind kind = ProbeKind::curvilinear;
  double radius_mm = 60;          ///< curvilinear: radius of the face, 5 to 200
  double field_of_view_deg = 60;  ///< curvilinear and phased: between the outer edges of the outer lines, 5 to 150
  double width_mm = 40;           ///< linear and phased: width of the face, 5 to 200
  /// The widest aperture of a line, 1 to 200. On a curved face it is narrower than the array, because elements far out
  /// look away from the line.
  double aperture_mm = 32;
  double frequency_mhz = 3.5;  ///< centre frequency, 1 to 20
  double depth_mm = 160;       ///< default imaging depth, 10 to 400
  int lines = 192;             ///< scan lines, 1 to 4096

  bool operator==(const Probe&) const = default;
};

/// Returns the built-in probes: "curvilinear" (abdomen, 3.5 MHz), "linear" (vessels and soft parts, 7.5 MHz) and
/// "phased" (heart and between ribs, 2.5 MHz).
const std::vector<Probe>& probes();
/// Returns the built-in probe of that name, or null if there is none.
const Probe* find_probe(std::string_view name);
std::vector<std::string> probe_names();

/// Returns the distance, mm, from the face's middle back to the point where the lines of a fan (curvilinear, phased)
/// meet. A phased array's outer lines leave at the face's edges.
double apex_behind_mm(const Probe& probe);

/// Returns the face's edge on the marker's side, in the imaging plane (x lateral, y along the central beam), mm.
glm::dvec2 face_edge(const Probe& probe);

/// A scan line: sample k is at start + direction * r_k, r_k = r_min + (k + 1/2) dr. Probe frame, mm.
struct ScanLine {
  glm::dvec3 start{0.0};          ///< on the transducer's face
  glm::dvec3 direction{0, 1, 0};  ///< unit
};

/// Where the lines lie beside each other: line i is at first + i step across, and a point of the imaging plane lies
/// between lines as its own place across.
struct LineFan {
  enum class Face {
    parallel,  ///< across is x, mm; r is y
    round,     ///< across is the angle at the apex, rad; r is the distance from an arc about the apex
    flat       ///< the same, but r is the distance along the line from y = 0; beyond the outer lines as from them
  };
  Face face = Face::parallel;
  double apex_mm = 0;  ///< distance of the apex behind the face's middle, where lines meet; 0 if parallel
  double first = 0;    ///< of line 0, rad or mm
  double step = 1;     ///< from one line to the next, above 0
  /// Lines are turned by this from the direction in which they leave the face, towards +x, rad; 0 for flat faces. r is
  /// the distance along the turned line, and a place across that of the line's start.
  double steering = 0;
};

/// The scan lines to traverse. The traversal depends on them alone, not on the probe.
struct ScanLines {
  std::vector<ScanLine> lines;  ///< 1 to 4096
  LineFan fan;                  ///< how these lie beside each other
  int samples = 512;            ///< samples per line, 1 to 8192
  double r_min_mm = 0;          ///< where the first sample's part of a line begins, from the line's start; 0 or more
  double r_max_mm = 160;        ///< where the last sample's part ends, above r_min_mm
  double aperture_mm = 32;      ///< Probe::aperture_mm

  double dr_mm() const { return (r_max_mm - r_min_mm) / samples; }
};

/// Returns the scan lines of a probe at a depth, from the edge opposite the marker (-x) to the marker's edge (+x). The
/// lines are at the middles of `probe.lines` equal parts of the face (linear) or of the field of view (curvilinear,
/// phased). Each ends `depth_mm` along it from where it leaves the face. Does not check its arguments: numbers out of
/// range are refused where they enter a program, and give meaningless lines here.
/// @param depth_mm  0.1 to 1000
/// @param samples   per line, 1 to 8192
/// @param steering   LineFan::steering, -0.5 to 0.5 rad; 0 for phased probes, whose lines are steered already
ScanLines scan_lines(const Probe& probe, double depth_mm, int samples, double steering = 0);

/// The position of a point of the imaging plane (x lateral, y along the central beam, probe frame, mm) among the lines.
struct LinePosition {
  double line;  ///< 0 on the first line, N - 1 on the last; -1/2 and N - 1/2 at the fan's edges
  double r_mm;  ///< distance from the face along the line
};

/// Returns the position of a point among the lines. Returns nothing outside the fan: beyond its edges (which belong to
/// it, however a point on one was rounded), in front of the face, or deeper than `depth_mm`.
/// @param depth_mm  0.1 to 1000
std::optional<LinePosition> line_position(const Probe& probe, double depth_mm, const glm::dvec2& xy_mm);

/// Returns the position of any point of the imaging plane in front of the apex, also beyond the fan's edges.
LinePosition position_among(const LineFan& fan, const glm::dvec2& xy_mm);

/// Returns the position of a point among the lines as line_position() does, also where they are steered: nothing beyond
/// the edges of these lines, in front of the face, or deeper than they reach.
std::optional<LinePosition> position_within(const ScanLines& lines, const glm::dvec2& xy_mm);

/// Places the pixels of the displayed image in the imaging plane. Pixels are square; the fan is as large as fits, and
/// centred. Pixel (x, y), counted from the top left, has its centre at top_left_mm + mm_per_pixel * (x, y) in the
/// probe's plane.
struct ImageGeometry {
  int width = 640;
  int height = 480;
  double mm_per_pixel = 0.4;    ///< above 0
  glm::dvec2 top_left_mm{0.0};  ///< centre of the top left pixel

  glm::dvec2 plane_mm(double x, double y) const { return top_left_mm + mm_per_pixel * glm::dvec2(x, y); }
  glm::dvec2 pixel(const glm::dvec2& plane_mm) const { return (plane_mm - top_left_mm) / mm_per_pixel; }
};

/// Returns the geometry of the image that shows a probe's fan down to a depth. The side that needs more millimetres per
/// pixel decides the scale. Does not check its arguments, as scan_lines() does not.
/// @param depth_mm       0.1 to 1000
/// @param width, height  pixels, 1 to 8192
ImageGeometry image_geometry(const Probe& probe, double depth_mm, int width, int height);

}  // namespace insonate
