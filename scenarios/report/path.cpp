#include "scenarios/report/path.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>

#include "scenarios/report/embedded_files.h"
#include "scenarios/report/svg.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

// All lengths are in the drawings' own units, which are pixels on a screen.
constexpr double kTop = 26;
constexpr double kSize = 300;
constexpr double kMargin = 24;
constexpr double kGap = 20;

/// The content of the drawings.
struct ProbePath {
  glm::dvec3 low{0.0}, high{0.0};  ///< patient, mm
  glm::dvec3 start{0.0};
  struct Stretch {
    std::size_t step;
    std::vector<glm::dvec3> points;
  };
  std::vector<Stretch> stretches;  ///< each without a gap
  struct Spot {
    glm::dvec3 at;
    bool held;
  };
  std::vector<Spot> spots;  ///< places where each step's picture was judged

  glm::dvec3 middle() const { return (low + high) / 2.0; }
  double across() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z, 20.0}); }
};

std::optional<ProbePath> path_of(const ExamResult& result, std::span<const TracePoint> trace) {
  const auto first = std::find_if(trace.begin(), trace.end(), [](const TracePoint& p) { return p.valid; });
  if (first == trace.end()) return std::nullopt;
  ProbePath path;
  path.low = path.high = path.start = first->face;
  bool going = false;
  for (const TracePoint& point : trace) {
    if (point.valid) {
      path.low = glm::min(path.low, point.face);
      path.high = glm::max(path.high, point.face);
      if (!going || path.stretches.back().step != point.step) path.stretches.push_back({point.step, {}});
      path.stretches.back().points.push_back(point.face);
    }
    going = point.valid;
  }
  for (const StepResult& step : result.steps) {
    if (!step.judged_from_s) continue;
    const auto judged = std::find_if(trace.begin(), trace.end(),
                                     [&](const TracePoint& p) { return p.valid && p.time_s >= *step.judged_from_s; });
    if (judged != trace.end()) path.spots.push_back({judged->face, is_done(step.outcome)});
  }
  return path;
}

/// One of the two projections of the probe's path.
struct Projection {
  const char* title;
  const char* left_side;  ///< label at the drawing's left
  glm::dvec3 right;       ///< patient direction that points to the right
  glm::dvec3 up;
};

std::string projected(const Projection& projection, double left, const ProbePath& path) {
  const double scale = (kSize - 2 * kMargin) / path.across();
  const auto x = [&](const glm::dvec3& p) {
    return left + kSize / 2 + scale * glm::dot(p - path.middle(), projection.right);
  };
  const auto y = [&](const glm::dvec3& p) {
    return kTop + kSize / 2 - scale * glm::dot(p - path.middle(), projection.up);
  };
  std::string svg =
      formatted("<rect class='frame' x='%.0f' y='%.0f' width='%.0f' height='%.0f'/>", left, kTop, kSize, kSize);
  svg += formatted("<text class='name' x='%.0f' y='%.0f'>%s</text>", left, kTop - 8, projection.title);
  svg +=
      formatted("<text class='tick' x='%.0f' y='%.0f'>%s</text>", left + 6, kTop + kSize / 2 + 4, projection.left_side);
  for (const ProbePath::Stretch& stretch : path.stretches) {
    svg += formatted("<path class='path path%d' d='", int(stretch.step % 4));
    for (const glm::dvec3& p : stretch.points)
      svg += formatted("%c%.1f %.1f", &p == &stretch.points.front() ? 'M' : 'L', x(p), y(p));
    svg += "'/>";
  }
  // The word stands on the side where there is room.
  const bool is_right = x(path.start) > left + kSize / 2;
  svg += formatted(
      "<circle class='start' cx='%.1f' cy='%.1f' r='4'/><text class='tick' x='%.1f' y='%.1f' "
      "text-anchor='%s'>start</text>",
      x(path.start), y(path.start), x(path.start) + (is_right ? -7 : 7), std::max(y(path.start) - 5, kTop + 14),
      is_right ? "end" : "start");
  for (const ProbePath::Spot& spot : path.spots)
    svg += formatted("<circle class='spot %s' cx='%.1f' cy='%.1f' r='5'/>", spot.held ? "good" : "bad", x(spot.at),
                     y(spot.at));
  const double ruler_mm = round_step(path.across() * 1.5);
  svg += formatted("<line class='ruler' x1='%.1f' x2='%.1f' y1='%.1f' y2='%.1f'/>", left + 10,
                   left + 10 + ruler_mm * scale, kTop + kSize - 12, kTop + kSize - 12);
  svg += formatted("<text class='tick' x='%.1f' y='%.1f'>%g mm</text>", left + 10, kTop + kSize - 18, ruler_mm);
  return svg;
}

std::string triple(const glm::dvec3& p) {
  return formatted("%.1f,%.1f,%.1f", p.x, p.y, p.z);
}

/// Returns the path relative to its middle, mm, in the form that the script of the rotatable drawing reads.
std::string path_json(const ProbePath& path) {
  std::string stretches, spots;
  for (const ProbePath::Stretch& stretch : path.stretches) {
    stretches += formatted("%s[%d", stretches.empty() ? "" : ",", int(stretch.step % 4));
    for (const glm::dvec3& p : stretch.points) stretches += "," + triple(p - path.middle());
    stretches += "]";
  }
  for (const ProbePath::Spot& spot : path.spots)
    spots += (spots.empty() ? "[" : ",[") + triple(spot.at - path.middle()) + (spot.held ? ",1]" : ",0]");
  return "{half:[" + triple((path.high - path.low) / 2.0) + "],start:[" + triple(path.start - path.middle()) +
         "],stretches:[" + stretches + "],spots:[" + spots + "]}";
}

}  // namespace

std::string path_html(const ExamResult& result, std::span<const TracePoint> trace) {
  const std::optional<ProbePath> path = path_of(result, trace);
  if (!path) return "";
  // LPS: +x points to the patient's left, which is at the right of both drawings, as on a CT.
  const Projection front{"From the front", "R", {1, 0, 0}, {0, 0, 1}};
  const Projection feet{"From the feet", "R", {1, 0, 0}, {0, -1, 0}};
  const double width = 2 * kSize + kGap, height = kTop + kSize + 4;
  return "<div class='paths'>" +
         formatted("<svg class='chart' viewBox='-1 0 %.0f %.0f' role='img'>", width + 2, height) +
         projected(front, 0, *path) + projected(feet, kSize + kGap, *path) + "</svg>" +
         formatted("<svg class='chart turn' viewBox='-1 0 %.0f %.0f' role='img'></svg></div>", kSize + 2, height) +
         "<script>" + std::string(report_file("turn.js")) + "(" + path_json(*path) + ");</script>";
}

}  // namespace insonate
