// Recomputes model W from the volume, as sim/registration/wein_settings.h defines it.

#include "tests/tools/render/recomputation.h"

namespace outsider {
namespace {

class Wein : public Recomputation {
public:
  Wein(const StageFolder& stages, bool single)
      : Recomputation(stages),
        single_(single),
        hu_(stages.hounsfield),
        outside_(about_.at("volume").at("outside_hu")) {}

  void all() {
    lines();
    pixels();
    picture();
  }

private:
  struct Medium {
    double hu;
    Vec3 gradient;  // over a reflection length
  };

  double voxel(const std::array<int, 3>& i) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (i[a] < 0 || i[a] >= hu_.size[a]) return outside_;
    return hu_.voxel(i[0], i[1], i[2]);
  }

  /// Interpolates linearly along one axis of the volume.
  double along(std::array<int, 3> i, std::size_t axis, double voxels) const {
    const double floor = std::floor(voxels), f = voxels - floor;
    i[axis] += int(floor);
    const double low = voxel(i);
    ++i[axis];
    return (1 - f) * low + f * voxel(i);
  }

  Medium medium(const Vec3& p) const {
    std::array<int, 3> first{};
    std::array<double, 3> f{};
    for (std::size_t a = 0; a < 3; ++a) {
      const double index = dot(p - hu_.origin, hu_.step[a]) / dot(hu_.step[a], hu_.step[a]);
      first[a] = int(std::floor(index));
      f[a] = index - first[a];
    }
    Medium met{0, {}};
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::array<int, 3> i = first;
      bool exists = true;
      for (std::size_t a = 0; a < 3; ++a) {
        const int up = corner >> a & 1;
        weight *= up ? f[a] : 1 - f[a];
        i[a] += up;
        exists = exists && i[a] >= 0 && i[a] < hu_.size[a];
      }
      met.hu += weight * voxel(i);
      for (std::size_t a = 0; a < 3 && exists; ++a) {
        const double side = length(hu_.step[a]), half = setting("reflection_length_mm") / 2 / side;
        met.gradient = met.gradient + weight * (along(i, a, half) - along(i, a, -half)) / side * hu_.step[a];
      }
    }
    return met;
  }

  void lines() {
    const double l = setting("reflection_length_mm"), a = setting("compression");
    // Each axis of the gradient is rounded to a sixteenth of a HU; positions and densities have single precision.
    const double gradient_error = single_ ? std::sqrt(3) / 16 + 0.02 : 1e-9, basic = single_ ? 1e-4 : 1e-6;
    double brightest = 0, least = 1;
    for (int line = 0; line < n_; ++line) {
      double intensity = 1, open = 0;  // relative uncertainty of I
      for (int k = 0; k < d_; ++k) {
        const double r = r_min_ + (k + 0.5) * dr_;
        const Vec3 d = directions_[std::size_t(line)];
        Medium met = medium(starts_[std::size_t(line)] + r * d);
        if (r < setting("contact_mm")) {
          const double tissue = value("contact_tissue_hu"), air = value("contact_air_hu");
          met.hu *= 1 - std::clamp((tissue - met.hu) / (tissue - air), 0.0, 1.0);
          met.gradient = {};
        }
        const double two_mu = 2 * std::max(met.hu + 1000, value("air_mu")), steepness = length(met.gradient);
        const double change = std::min(steepness / two_mu, 1.0), change_error = gradient_error / two_mu;
        const double reflected = steepness > 0 ? change * change * std::abs(dot(d, met.gradient)) / steepness : 0;
        const double error = 3 * change * change_error + change_error * change_error;
        compare("intensity", intensity, plane("intensity").at(line, k), (basic + open) * std::max(intensity, 1e-6));
        const auto compressed = [&](double share) { return std::log(1 + a * share) / std::log(1 + a); };
        const double echo = compressed(intensity * reflected);
        compare("scan_reflection", echo, plane("scan_reflection").at(line, k),
                basic + compressed(intensity * (reflected + error)) - echo + open);
        const double e =
            std::clamp((met.hu - setting("dark_hu")) / (setting("bright_hu") - setting("dark_hu")), 0.0, 1.0);
        compare("scan_echogenicity", on("shadows") ? intensity * e : e, plane("scan_echogenicity").at(line, k),
                basic + open);
        brightest = std::max(brightest, echo);
        least = std::min(least, intensity);
        intensity *= std::pow(1 - change * change, dr_ / l);
        open += error / std::max(1 - change * change, 1e-3) * dr_ / l;
      }
    }
    compare("brightest", 1, brightest > 0.1 && least < 0.998, 0.5);  // silence would agree with anything
  }

  void picture() {
    const double s = setting("reflection_share");
    const Plane reflection = converted(plane("scan_reflection")), echo = converted(plane("scan_echogenicity"));
    for (std::size_t i = 0; i < echo.values.size(); ++i) {
      const double grey = 255 * (s * reflection.values[i] + (1 - s) * echo.values[i]);
      // Half a level is rounding to whole levels. On the device positions are in eighths of a thousandth of a sample.
      compare("image", grey, plane("image").values[i], 0.55);
    }
  }

  const bool single_;
  const ShortVolume& hu_;
  const double outside_;
};

}  // namespace

std::map<std::string, double> wein_misfits(const StageFolder& stages, bool single) {
  Wein wein(stages, single);
  wein.all();
  return wein.worst();
}

}  // namespace outsider
