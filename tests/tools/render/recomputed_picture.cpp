// Where pixels lie among the lines, what they fuse, and how that becomes grey.

#include "tests/tools/render/recomputation.h"

namespace outsider {
namespace {

class Picture : public Recomputation {
public:
  using Recomputation::Recomputation;

  void all() {
    pixels();
    fusion();
    compression();
  }

private:
  /// Where each pixel lies among the lines, from the lines' own places.
  void pixels() {
    const auto& image = about_.at("image");
    const auto& pose = about_.at("patient_from_probe");
    const Vec3 d0 = directions_.front(), d1 = directions_.back();
    const bool fan = length(cross(d0, d1)) > 1e-9;
    // The point where the outer lines meet: start + t d on either, t by the sine rule.
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
        if (std::abs(to_edge) < 1e-6) continue;  // on the edge, where rounding decides
        compare("pixel_line", to_edge > 0 ? line : -2, line_at.at(x, y), kFloat * n_ + 1e-9);
        compare("pixel_sample", to_edge > 0 ? sample : -2, plane("pixel_sample").at(x, y), kFloat * d_ + 1e-9);
      }
  }

  /// Bilinear among the lines, which end in their middles.
  Plane converted(const Plane& from) const {
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

  /// A Gaussian over what lies inside the fan, out to three sigma.
  Plane smoothed(Plane from, double sigma_mm) const {
    const double sigma = sigma_mm / about_.at("image").at("mm_per_pixel").get<double>();
    if (sigma < 0.05) return from;
    const int radius = int(std::ceil(3 * sigma));
    const auto pass = [&](const Plane& source, bool vertical) {
      Plane to = source;
      for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
          to.at(x, y) = 0;
          for (int j = -radius; j <= radius && inside(x, y); ++j) {
            const int u = vertical ? x : x + j, v = vertical ? y + j : y;
            if (u >= 0 && v >= 0 && u < to.width && v < to.height)
              to.at(x, y) += std::exp(-j * j / (2 * sigma * sigma)) * source.at(u, v);
          }
        }
      return to;
    };
    Plane within = from;
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x) within.at(x, y) = inside(x, y);
    from = pass(pass(from, false), true);
    within = pass(pass(within, false), true);
    for (std::size_t i = 0; i < from.values.size(); ++i)
      if (within.values[i] > 0) from.values[i] /= within.values[i];
    return from;
  }

  static void add(Plane& to, const Plane& what, double factor) {
    for (std::size_t i = 0; i < to.values.size(); ++i) to.values[i] += factor * what.values[i];
  }

  /// The scatterers' echo at each depth as all lines have it in the mean, fading into the depths behind.
  Plane mean_echo(const Plane& transmission) const {
    Plane mean = transmission;
    double before = 0;
    const double kept = std::exp(-dr_ / value("clutter_tail_mm"));
    for (int k = 0; k < d_; ++k) {
      double sum = 0;
      for (int line = 0; line < n_; ++line) sum += transmission.at(line, k) * plane("speckle").at(line, k);
      const double here = setting("blend") * sum / n_;
      before = k == 0 ? here : kept * before + (1 - kept) * here;
      for (int line = 0; line < n_; ++line) mean.at(line, k) = before;
    }
    return mean;
  }

  /// (6) from R behind the beam, I, S and what adds to them.
  void fusion() {
    Plane transmission = plane("transmission");
    if (on("two_way"))
      for (double& i : transmission.values) i *= i;
    const Plane r = smoothed(converted(plane("reflection_beam")), setting("reflection_sigma_mm"));
    const Plane t = smoothed(converted(transmission), setting("transmission_sigma_mm"));
    const Plane s = converted(plane("speckle"));
    Plane expected = r;
    for (std::size_t i = 0; i < r.values.size(); ++i)
      expected.values[i] = (r.values[i] + setting("blend") * t.values[i]) * s.values[i];
    if (planes_.count("repeated")) add(expected, converted(plane("repeated")), 1);
    if (on("electronic_noise")) add(expected, converted(plane("noise")), value("noise_level"));
    if (on("clutter")) {
      Plane beside = converted(mean_echo(transmission));
      const Plane noise = converted(plane("noise"));
      for (std::size_t i = 0; i < noise.values.size(); ++i) beside.values[i] *= noise.values[i];
      add(expected, beside, value("clutter_share"));
    }
    for (int y = 0; y < r.height; ++y)
      for (int x = 0; x < r.width; ++x) {
        double brightest = 1e-20;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, r.height - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, r.width - 1); ++u)
            brightest = std::max(brightest, expected.at(u, v));
        compare("fused", expected.at(x, y), plane("fused").at(x, y), tolerances_.fused * brightest);
      }
  }

  /// (7) from U.
  void compression() {
    const Plane& u = plane("fused");
    const auto& tgc = set_.at("tgc_db");
    Plane db = u;  // of the echo behind gain
    double brightest = -HUGE_VAL;
    for (int y = 0; y < u.height; ++y)
      for (int x = 0; x < u.width; ++x) {
        const double depth = std::clamp((plane("pixel_sample").at(x, y) + 0.5) / d_, 0.0, 1.0) * double(tgc.size() - 1);
        const std::size_t below = std::min(std::size_t(depth), tgc.size() - 2);
        const double low = tgc.at(below), high = tgc.at(below + 1);
        db.at(x, y) = inside(x, y) && u.at(x, y) > 0 ? 10 * std::log10(u.at(x, y)) + low +
                                                           (high - low) * (depth - double(below)) + setting("gain_db")
                                                     : -HUGE_VAL;
        brightest = std::max(brightest, db.at(x, y));
      }
    const double white =
        set_.at("reference_level") == "frame_maximum" ? brightest : 10 * std::log10(setting("fixed_level"));
    for (std::size_t i = 0; i < db.values.size(); ++i) {
      const double grey = 255 * std::clamp(1 + (db.values[i] - white) / setting("dynamic_range_db"), 0.0, 1.0);
      // Half a level is rounding to whole ones; the hundredth is single precision's, whose logarithms of factors of
      // 10^30 are good to about 1e-5 dB.
      compare("image", grey, plane("image").values[i], 0.51);
    }
  }
};

}  // namespace

std::map<std::string, double> picture_misfits(const StageFolder& stages, const Tolerances& tolerances) {
  Picture picture(stages, tolerances);
  picture.all();
  return picture.worst();
}

}  // namespace outsider
