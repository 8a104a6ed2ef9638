// Recomputes how the picture's pixels lie among the scan lines, in both models.

#include "tests/tools/render/recomputation.h"

namespace outsider {

// Computes where each pixel lies among the lines, from the lines' own places.
void Recomputation::pixels() {
  const auto& image = about_.at("image");
  const auto& pose = about_.at("patient_from_probe");
  const Vec3 d0 = directions_.front(), d1 = directions_.back();
  const bool fan = length(cross(d0, d1)) > 1e-9;
  // The point where the outer lines meet: start + t d on either line, with t from the sine rule.
  const double opening = std::atan2(length(cross(d0, d1)), dot(d0, d1));
  const double t = fan ? length(starts_.back() - starts_.front()) / 2 / std::sin(opening / 2) : 0;
  const Vec3 apex = starts_.front() - t * d0;
  const Vec3 across = starts_.back() - starts_.front();
  Plane line_at = plane("pixel_line");
  for (int y = 0; y < line_at.height; ++y)
    for (int x = 0; x < line_at.width; ++x) {
      const double in_probe[] = {
          image.at("top_left_mm").at(0).get<double>() + x * image.at("mm_per_pixel").get<double>(),
          image.at("top_left_mm").at(1).get<double>() + y * image.at("mm_per_pixel").get<double>()};
      Vec3 p{};
      for (std::size_t row = 0; row < 3; ++row)
        p[row] = pose.at(4 * row).get<double>() * in_probe[0] + pose.at(4 * row + 1).get<double>() * in_probe[1] +
                 pose.at(4 * row + 3).get<double>();
      double line = 0, r = 0;
      if (fan) {
        const Vec3 from_apex = p - apex, normal = cross(d0, d1);
        const double angle = std::atan2(dot(cross(d0, from_apex), normal) / length(normal), dot(d0, from_apex));
        line = angle / opening * (n_ - 1);
        r = length(from_apex) - t;
      } else {
        line = dot(p - starts_.front(), across) / dot(across, across) * (n_ - 1);
        r = dot(p - starts_.front(), d0);
      }
      const double sample = (r - r_min_) / dr_ - 0.5;
      const double to_edge = std::min({line + 0.5, n_ - 0.5 - line, sample + 0.5, d_ - 0.5 - sample});
      if (std::abs(to_edge) < 1e-6) continue;  // on the edge rounding decides
      compare("pixel_line", to_edge > 0 ? line : -2, line_at.at(x, y), kFloat * n_ + 1e-9);
      compare("pixel_sample", to_edge > 0 ? sample : -2, plane("pixel_sample").at(x, y), kFloat * d_ + 1e-9);
    }
}

// Interpolates linearly between lines and between samples. Beyond the middles of the outer ones the value is constant.
Plane Recomputation::converted(const Plane& from) const {
  Plane to = plane("pixel_line");
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      if (!inside(x, y)) {
        to.at(x, y) = 0;
        continue;
      }
      const double line = std::clamp(plane("pixel_line").at(x, y), 0.0, n_ - 1.0);
      const double sample = std::clamp(plane("pixel_sample").at(x, y), 0.0, d_ - 1.0);
      const int i = std::min(int(line), n_ - 2), k = std::min(int(sample), d_ - 2);
      const double u = line - i, v = sample - k;
      to.at(x, y) = (1 - u) * (1 - v) * from.at(i, k) + u * (1 - v) * from.at(i + 1, k) +
                    (1 - u) * v * from.at(i, k + 1) + u * v * from.at(i + 1, k + 1);
    }
  return to;
}

}  // namespace outsider
