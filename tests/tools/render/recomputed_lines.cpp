// Recomputes from the volume what sound meets on its way and its effect: for each plane of the slice, and summed.

#include <array>

#include "tests/tools/render/lattice.h"
#include "tests/tools/render/recomputation.h"

namespace outsider {
namespace {

class Lines : public Recomputation {
public:
  Lines(const StageFolder& stages, const Tolerances& tolerances)
      : Recomputation(stages),
        tolerances_(tolerances),
        lattice_(about_),
        intensity_(blank()),
        reflection_(blank()),
        re_(blank()),
        im_(blank()),
        rounding_(blank()) {
    for (const auto& knot : about_.at("tissues"))
      knots_.push_back({knot.at("hu"), knot.at("impedance_mrayl"), knot.at("absorption_db_cm_mhz")});
    l_ = setting("reflection_length_mm");
    coupled_mm_ = value("coupling_depth_mm");
    coupling_air_hu_ = about_.at("coupling_air_hu");
    coupling_tissue_hu_ = about_.at("coupling_tissue_hu");
    silent_db_ = about_.at("silent_db");
  }

  void all() {
    double total = 0;
    for (const auto& slice : about_.at("slice_planes")) {
      offset_ = slice.at("offset");
      weight_ = slice.at("weight");
      const std::string folder = slice.at("folder");
      prefix_ = folder.empty() ? "" : folder + "/";
      total += weight_;
      tissue();
      walk();
      scatterers();
    }
    compare("slice_planes", 1, total, 1e-12);
    middle();
    summed();
  }

private:
  Plane blank() const { return {n_, d_, std::vector<double>(std::size_t(n_) * std::size_t(d_), 0.0)}; }
  const Plane& met(const char* name) const { return plane(prefix_ + name); }

  struct Knot {
    double hu, impedance, absorption;
  };
  /// Returns the tissue table's entry: linear between knots, constant beyond.
  Knot tabled(double hu) const {
    if (hu <= knots_.front().hu) return knots_.front();
    for (std::size_t i = 1; i < knots_.size(); ++i) {
      const Knot &a = knots_[i - 1], &b = knots_[i];
      const double t = (hu - a.hu) / (b.hu - a.hu);
      if (t <= 1)
        return {hu, a.impedance + t * (b.impedance - a.impedance), a.absorption + t * (b.absorption - a.absorption)};
    }
    return knots_.back();
  }
  double hu_in_volume(const Vec3& p) const { return stages_.hounsfield.at(p, value_outside("hu")); }
  double share_of_gel(double hu, double r) const {
    const double in_air = (hu - coupling_tissue_hu_) / (coupling_air_hu_ - coupling_tissue_hu_);
    return r < coupled_mm_ ? std::clamp(in_air, 0.0, 1.0) : 0;
  }
  double hu_at(const Vec3& p, double r) const {
    const double hu = hu_in_volume(p);
    return hu - share_of_gel(hu, r) * hu;
  }
  double value_outside(const char* of) const { return about_.at("volume").at(std::string("outside_") + of); }

  /// Returns the place on the line, or beside it in elevation, by a number of thicknesses of the slice there.
  Vec3 place(int line, double r) const {
    const auto& slice = about_.at("slice");
    const double thickness = std::hypot(slice.at("thickness_mm").get<double>(),
                                        (r - slice.at("focus_mm").get<double>()) * slice.at("spread").get<double>());
    return starts_[std::size_t(line)] + r * directions_[std::size_t(line)] +
           offset_ * thickness * vec3(slice.at("elevation"));
  }

  /// Recomputes Hounsfield units, impedance, absorption, alpha and the angle of incidence from the volume.
  void tissue() {
    for (int line = 0; line < n_; ++line) {
      const Vec3 along = directions_[std::size_t(line)];
      const Vec3 lateral = beside(along), elevation = cross(along, lateral);
      for (int k = 0; k < d_; ++k) {
        const double r = r_min_ + (k + 0.5) * dr_;
        const Vec3 p = place(line, r);
        const double hu = hu_at(p, r);
        compare("hounsfield", hu, met("hounsfield").at(line, k), std::max(1000.0, std::abs(hu)) * kFloat + 1e-9);
        // Rounding of the float itself, and of the Hounsfield units on the steepest ramps of the table.
        const double seen = met("hounsfield").at(line, k), hu_error = kFloat * std::abs(seen);
        const double z = met("impedance").at(line, k);
        compare("impedance", tabled(seen).impedance, z, 0.041 * hu_error + kFloat * z + 1e-12);
        const double a = met("absorption").at(line, k);
        compare("absorption", tabled(seen).absorption, a, 0.2 * hu_error + kFloat * a + 1e-12);

        // (1) where half a reflection length is a whole number of samples: from the impedances alone.
        const double alpha = met("alpha").at(line, k);
        const double rounding = 4 * kFloat;  // two impedances, in both sum and difference
        const double tolerated = 2 * std::sqrt(alpha) * rounding + rounding * rounding + kFloat * alpha;
        const int m = int(std::lround(l_ / 2 / dr_));
        if (std::abs(m * dr_ - l_ / 2) > 1e-9)
          throw std::runtime_error("half a reflection length is no whole number of samples");
        if (k >= m && k + m < d_ && !bends()) {
          const double before = met("impedance").at(line, k - m), behind = met("impedance").at(line, k + m);
          compare("alpha", std::pow((behind - before) / (behind + before), 2), alpha, tolerated);
        }
        // At every sample from the volume, with the angle.
        const double hu_before = hu_at(place(line, r - l_ / 2), r - l_ / 2),
                     hu_behind = hu_at(place(line, r + l_ / 2), r + l_ / 2);
        const double before = tabled(hu_before).impedance, behind = tabled(hu_behind).impedance;
        compare("alpha from the volume", std::pow((behind - before) / (behind + before), 2), alpha, tolerated);
        const double rise[] = {hu_behind - hu_before, hu_at(p + l_ / 2 * lateral, r) - hu_at(p - l_ / 2 * lateral, r),
                               hu_at(p + l_ / 2 * elevation, r) - hu_at(p - l_ / 2 * elevation, r)};
        const double steepness = std::sqrt(rise[0] * rise[0] + rise[1] * rise[1] + rise[2] * rise[2]);
        // If the slope is below what position errors of 1e-12 mm can cause, there is no angle to compare.
        if (steepness > 1e-5)
          compare("incidence", std::abs(rise[0]) / steepness, met("incidence").at(line, k),
                  2 * kFloat + 1e-9 / steepness);
      }
    }
  }

  /// Returns whether the planes of the slice are bent, so that a step along them is not a step along the line.
  bool bends() const { return offset_ != 0 && about_.at("slice").at("spread") != 0; }

  /// Returns how far sound is refracted in a step, in rad across the line. The logarithm of the speed of sound is
  /// linear in density below and above water, and its slope is taken over a reflection length.
  double rise_of_speed(const Vec3& p, const Vec3& across, double r) const {
    const auto& refraction = about_.at("refraction");
    const auto log_speed = [&](double hu) {
      hu = std::clamp(hu, refraction.at("least_hu").get<double>(), refraction.at("most_hu").get<double>());
      return hu * refraction.at(hu < 0 ? "log_speed_below_water" : "log_speed_above_water").get<double>();
    };
    const Vec3 half = l_ / 2 * across;
    return (log_speed(hu_at(p + half, r)) - log_speed(hu_at(p - half, r))) * dr_ / l_;
  }

  /// Recomputes (5) and (3) along each line from alpha, the absorption and the angle, and the refraction loss from the
  /// volume.
  void walk() {
    const double f = on("absorption") ? setting("frequency_mhz") : 0;
    const bool refracts = on("edge_shadow");
    const auto& refraction = about_.at("refraction");
    const double turn_mm = refraction.at("turn_mm"), turn_rad = refraction.at("turn_rad");
    double most_refracted_db = 0;
    for (int line = 0; line < n_; ++line) {
      double db = 0;        // of the remaining I
      double rounding = 0;  // relative, of 1 - alpha over all steps so far
      double turn[] = {0, 0}, refracted_db = 0;
      const Vec3 along = directions_[std::size_t(line)], lateral = beside(along), elevation = cross(along, lateral);
      for (int k = 0; k < d_; ++k) {
        const double step_db = met("absorption").at(line, k) * f * dr_ / 10;
        if (k == 0) db = -step_db / 2;
        const double intensity = std::pow(10, db / 10), alpha = met("alpha").at(line, k);
        const double echo = alpha * intensity * intensity * met("incidence").at(line, k);
        intensity_.at(line, k) += weight_ * intensity;
        reflection_.at(line, k) += weight_ * echo;
        if (!prefix_.empty()) {  // always computed by the reference
          compare("transmission of a plane", intensity, met("transmission").at(line, k),
                  (1e-6 + rounding) * std::max(intensity, 1e-6));
          compare("reflection of a plane", echo, met("reflection").at(line, k), (1e-6 + 2 * rounding) * alpha + 1e-12);
        }
        rounding_.at(line, k) = std::max(rounding_.at(line, k), rounding);
        most_refracted_db = std::max(most_refracted_db, refracted_db);
        db += 10 * std::log10(1 - alpha) * dr_ / l_ - step_db;
        rounding += kFloat * alpha / (1 - alpha) * dr_ / l_;
        if (!refracts) continue;
        const double r = r_min_ + (k + 0.5) * dr_;
        const Vec3 p = place(line, r);
        const double kept = std::exp(-dr_ / turn_mm);
        turn[0] = kept * turn[0] + rise_of_speed(p, lateral, r);
        turn[1] = kept * turn[1] + rise_of_speed(p, elevation, r);
        const double q = std::pow(std::hypot(turn[0], turn[1]) / turn_rad, 4);
        const double lost_db = 10 * std::log10(std::exp(1)) * 2 * q / (2 + q) * dr_ / turn_mm;
        db -= lost_db;
        refracted_db += lost_db;
      }
    }
    if (refracts) compare("refracted", 1, most_refracted_db > 1, 0.5);  // ensures that the effect is visible
  }

  /// Returns the direction across a line in the imaging plane. Lines of a fan diverge in it; those of a linear array
  /// are parallel.
  Vec3 beside(const Vec3& along) const {
    Vec3 lateral = starts_.back() - starts_.front();
    lateral = lateral - dot(lateral, along) * along;
    return 1 / length(lateral) * lateral;
  }

  /// Recomputes the scatterers' echo from the volume's echogenicity and the lattice.
  void scatterers() {
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k) {
        const double r = r_min_ + (k + 0.5) * dr_;
        const Vec3 p = place(line, r);
        const double of_tissue = stages_.echogenicity.at(p, 100 * value_outside("echogenicity_db")) / 100;
        const double db = of_tissue + share_of_gel(hu_in_volume(p), r) * (-60 - of_tissue);
        compare("echogenicity", db, met("echogenicity").at(line, k), 60 * kFloat + 1e-9);
        const double amplitude = std::max(std::pow(10, db / 10) - std::pow(10, silent_db_ / 10), 0.0);
        const std::array<double, 2> drawn = on("speckle") ? lattice_.at(p) : std::array<double, 2>{1, 0};
        re_.at(line, k) += weight_ * amplitude * drawn[0];
        im_.at(line, k) += weight_ * amplitude * drawn[1];
      }
  }

  /// Checks the imaging plane, whose data lie beside the sums of all planes.
  void middle() {
    const auto& slices = about_.at("slice_planes");
    const std::string folder = slices.at(slices.size() / 2).at("folder");
    if (folder.empty()) return;
    for (const char* name : {"impedance", "alpha"})
      for (int line = 0; line < n_; ++line)
        for (int k = 0; k < d_; ++k)
          compare("the middle plane", plane(folder + "/" + name).at(line, k), plane(name).at(line, k), 1e-12);
  }

  /// Compares the sum of the planes.
  void summed() {
    const double brightest = *std::max_element(plane("reflection").values.begin(), plane("reflection").values.end());
    compare("brightest", 1, brightest > 1e-6, 0.5);  // a frame without echo would agree with anything
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k) {
        const double i = intensity_.at(line, k);
        compare("transmission", i, plane("transmission").at(line, k),
                (tolerances_.intensity + rounding_.at(line, k)) * std::max(i, 1e-6));
        compare("reflection", reflection_.at(line, k), plane("reflection").at(line, k),
                (tolerances_.reflection + 2 * rounding_.at(line, k)) * brightest);
        // The echo's place in the lattice is uncertain by 1e-12 mm; two of its values differ by up to 4.
        const double amplitude = std::hypot(re_.at(line, k), im_.at(line, k));
        compare("echo_re", re_.at(line, k), plane("echo_re").at(line, k), 2 * kFloat * amplitude + 1e-9);
        compare("echo_im", im_.at(line, k), plane("echo_im").at(line, k), 2 * kFloat * amplitude + 1e-9);
      }
  }

  const Tolerances tolerances_;
  const Lattice lattice_;
  std::vector<Knot> knots_;
  double l_ = 0, coupled_mm_ = 0, coupling_air_hu_ = 0, coupling_tissue_hu_ = 0, silent_db_ = 0;
  double offset_ = 0, weight_ = 1;  // of the current plane of the slice
  std::string prefix_;
  Plane intensity_, reflection_, re_, im_, rounding_;  // rounding_: relative rounding of alpha's file, in any plane
};

}  // namespace

std::map<std::string, double> line_misfits(const StageFolder& stages, const Tolerances& tolerances) {
  Lines lines(stages, tolerances);
  lines.all();
  return lines.worst();
}

}  // namespace outsider
