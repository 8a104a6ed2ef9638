// Recomputes the fusion of the pixels, and grey from it.

#include "tests/tools/render/recomputation.h"

namespace outsider {
namespace {

class Picture : public Recomputation {
public:
  Picture(const StageFolder& stages, const Tolerances& tolerances) : Recomputation(stages), tolerances_(tolerances) {}

  void all() {
    pixels();
    fusion();
    compression();
  }

private:
  /// Returns a Gaussian smoothing over what lies inside the fan, out to three sigma.
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

  /// Returns the mean of the scatterers' echo over all lines at each depth, fading into the depths behind.
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

  /// Recomputes (6) from R after the beam, I, S and the effects that add to them.
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

  /// Recomputes (7) from U.
  void compression() {
    const Plane& u = plane("fused");
    const auto& tgc = set_.at("tgc_db");
    const double least_echo = about_.at("least_echo");
    Plane db = u;  // of the echo after gain
    double brightest = -HUGE_VAL;
    for (int y = 0; y < u.height; ++y)
      for (int x = 0; x < u.width; ++x) {
        const double depth = std::clamp((plane("pixel_sample").at(x, y) + 0.5) / d_, 0.0, 1.0) * double(tgc.size() - 1);
        const std::size_t below = std::min(std::size_t(depth), tgc.size() - 2);
        const double low = tgc.at(below), high = tgc.at(below + 1);
        db.at(x, y) =
            inside(x, y) && u.at(x, y) > least_echo
                ? 10 * std::log10(u.at(x, y)) + low + (high - low) * (depth - double(below)) + setting("gain_db")
                : -HUGE_VAL;
        brightest = std::max(brightest, db.at(x, y));
      }
    const double white =
        set_.at("reference_level") == "frame_maximum" ? brightest : 10 * std::log10(setting("fixed_level"));
    for (std::size_t i = 0; i < db.values.size(); ++i) {
      const double grey = 255 * std::clamp(1 + (db.values[i] - white) / setting("dynamic_range_db"), 0.0, 1.0);
      // Half a level is rounding to whole levels. The hundredth is that of single precision, whose logarithms of
      // factors of 10^30 are accurate to about 1e-5 dB.
      compare("image", grey, plane("image").values[i], 0.51);
    }
  }

  const Tolerances tolerances_;
};

}  // namespace

std::map<std::string, double> picture_misfits(const StageFolder& stages, const Tolerances& tolerances) {
  Picture picture(stages, tolerances);
  picture.all();
  return picture.worst();
}

}  // namespace outsider
