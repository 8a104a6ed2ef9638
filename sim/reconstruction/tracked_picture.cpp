#include "sim/reconstruction/tracked_picture.h"

#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace insonate {
namespace {

std::vector<PictureRegion::Span> spans_of(const Image<std::uint8_t>& inside) {
  std::vector<PictureRegion::Span> spans(std::size_t(inside.height));
  for (int y = 0; y < inside.height; ++y) {
    PictureRegion::Span& span = spans[std::size_t(y)];
    while (span.begin < inside.width && !inside.at(span.begin, y)) ++span.begin;
    span.end = inside.width;
    while (span.end > span.begin && !inside.at(span.end - 1, y)) --span.end;
  }
  return spans;
}

/// Returns the first and last pixel of every `step`-th row, of the first and of the last. The outlines of fans are so
/// smooth that the rows between lie less than a tenth of a pixel beyond their hull.
std::vector<glm::dvec2> outline_of(const std::vector<PictureRegion::Span>& spans) {
  constexpr std::size_t kStep = 4;
  std::vector<glm::dvec2> outline;
  const auto begin = std::find_if(spans.begin(), spans.end(), [](const auto& s) { return s.begin < s.end; });
  const auto end = std::find_if(spans.rbegin(), spans.rend(), [](const auto& s) { return s.begin < s.end; }).base();
  if (begin == spans.end()) return outline;
  const auto first = std::size_t(begin - spans.begin()), behind = std::size_t(end - spans.begin());
  for (std::size_t y = first; y < behind; ++y) {
    const PictureRegion::Span& span = spans[y];
    if (span.begin == span.end || ((y - first) % kStep != 0 && y + 1 != behind)) continue;
    outline.emplace_back(span.begin, y);
    outline.emplace_back(span.end - 1, y);
  }
  return outline;
}

}  // namespace

std::shared_ptr<const PictureRegion> region_where(int width, int height,
                                                  const std::function<bool(int x, int y)>& inside) {
  auto region = std::make_shared<PictureRegion>();
  region->inside = Image<std::uint8_t>(width, height);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) region->inside.at(x, y) = inside(x, y);
  });
  region->spans = spans_of(region->inside);
  region->outline = outline_of(region->spans);
  return region;
}

std::shared_ptr<const PictureRegion> fan_region(const Probe& probe, double depth_mm, const ImageGeometry& geometry) {
  return region_where(geometry.width, geometry.height, [&](int x, int y) {
    return line_position(probe, depth_mm, geometry.plane_mm(x, y)).has_value();
  });
}

std::shared_ptr<const PictureRegion> rectangle_region(int width, int height, const PixelRectangle& part) {
  return region_where(width, height, [&](int x, int y) {
    return x >= part.x && y >= part.y && x < part.x + part.width && y < part.y + part.height;
  });
}

glm::dmat4 patient_from_pixel(const Pose& patient_from_probe, const ImageGeometry& geometry) {
  glm::dmat4 probe_from_pixel(1.0);
  probe_from_pixel[0][0] = probe_from_pixel[1][1] = geometry.mm_per_pixel;
  probe_from_pixel[3] = glm::dvec4(geometry.top_left_mm, 0, 1);
  return patient_from_probe.matrix() * probe_from_pixel;
}

Pose plane_of(const glm::dmat4& patient_from_pixel) {
  const glm::dvec3 x = glm::normalize(glm::dvec3(patient_from_pixel[0]));
  const glm::dvec3 z = glm::normalize(glm::cross(x, glm::dvec3(patient_from_pixel[1])));
  return {glm::dmat3(x, glm::cross(z, x), z), glm::dvec3(patient_from_pixel[3])};
}

}  // namespace insonate
