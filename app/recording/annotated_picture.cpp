#include "app/recording/annotated_picture.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include "app/session/plane_on_screen.h"
#include "scenarios/caliper.h"

namespace insonate {
namespace {

/// A colour that no echo has: the report shows pictures smaller than they are.
constexpr Rgba8 kInk{255, 214, 64, 255}, kEdge{0, 0, 0, 255};
/// Of a picture 480 pixels high; they grow with it.
constexpr double kArm = 14, kDotDistance = 14, kReferenceHeight = 480;

/// Fills a square with a dark edge, so that it is seen on bright echoes.
class Pen {
public:
  Pen(Image<Rgba8>& picture, double scale) : picture_(picture), half_(int(std::round(1.5 * scale))) {}

  void edge(const glm::dvec2& at) { fill(at, half_ + 1, kEdge); }
  void ink(const glm::dvec2& at) { fill(at, half_, kInk); }

private:
  void fill(const glm::dvec2& at, int half, const Rgba8& colour) {
    const int x = int(std::floor(at.x)), y = int(std::floor(at.y));
    for (int j = std::max(0, y - half); j <= std::min(picture_.height - 1, y + half); ++j)
      for (int i = std::max(0, x - half); i <= std::min(picture_.width - 1, x + half); ++i) picture_.at(i, j) = colour;
  }

  Image<Rgba8>& picture_;
  int half_;
};

void add_cross(std::vector<glm::dvec2>& dots, const glm::dvec2& at, double arm) {
  for (double d = -arm; d <= arm; d += 0.5) {
    dots.push_back(at + glm::dvec2(d, 0));
    dots.push_back(at + glm::dvec2(0, d));
  }
}

void add_line(std::vector<glm::dvec2>& dots, const glm::dvec2& from, const glm::dvec2& to, double distance) {
  const double length = glm::distance(from, to);
  for (double along = distance; along < length; along += distance)
    dots.push_back(from + (to - from) * (along / length));
}

}  // namespace

void draw_annotations(Image<Rgba8>& picture, const ImageGeometry& geometry, const std::vector<Action>& placed) {
  const PlaneOnScreen plane({0, 0}, {double(picture.width), double(picture.height)}, geometry);
  const double scale = picture.height / kReferenceHeight;
  std::vector<glm::dvec2> dots;
  for (const Action& action : placed) {
    if (action.kind == ActionKind::point || action.kind == ActionKind::label) {
      add_cross(dots, plane.screen(action.point(0)), kArm * scale);
      continue;
    }
    const std::vector<glm::dvec2> ends = handles(action);
    for (const glm::dvec2& end : ends) add_cross(dots, plane.screen(end), kArm * scale);
    if (action.kind == ActionKind::caliper) {
      add_line(dots, plane.screen(ends[0]), plane.screen(ends[1]), kDotDistance * scale);
    } else {
      const double around = 3.14 * (caliper_length_mm(action) / 2 + action.numbers[5]) * plane.pixels_per_mm();
      const double points = std::clamp(around / (kDotDistance * scale), 12.0, 400.0);
      for (const glm::dvec2& dot : outline(action, std::size_t(points))) dots.push_back(plane.screen(dot));
    }
  }
  Pen pen(picture, scale);
  for (const glm::dvec2& dot : dots) pen.edge(dot);
  for (const glm::dvec2& dot : dots) pen.ink(dot);
}

}  // namespace insonate
