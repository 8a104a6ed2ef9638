// Tests what the recursion converges to and how fast. It compares the double-precision reference on continuous media
// and on voxels with the integrals of the continuous model, I(r) = exp(integral of ln(1 - alpha)/l) and R = alpha I^2
// |d . n|.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cstdio>
#include <functional>
#include <vector>

#include "tests/accuracy/media.h"
#include "tests/accuracy/quadrature.h"

using namespace insonate;
using namespace insonate::test;

namespace {

using Density = std::function<double(const glm::dvec3& patient_mm)>;

/// The continuous model along the line from the origin along +y.
class Continuous {
public:
  Continuous(Density density, const TissueTable& table, double l, double absorption_mhz)
      : density_(std::move(density)), table_(table), l_(l), absorption_mhz_(absorption_mhz) {}

  double alpha(double r) const {
    return alpha_between(table_.at(density_({0, r - l_ / 2, 0})).impedance_mrayl,
                         table_.at(density_({0, r + l_ / 2, 0})).impedance_mrayl);
  }
  /// Returns |d . n| from differences over the reflection length.
  double cosine(double r) const {
    const auto difference = [&](const glm::dvec3& step) {
      return density_(glm::dvec3(0, r, 0) + step) - density_(glm::dvec3(0, r, 0) - step);
    };
    const glm::dvec3 gradient(difference({l_ / 2, 0, 0}), difference({0, l_ / 2, 0}), difference({0, 0, l_ / 2}));
    const double steepness = glm::length(gradient);
    return steepness > 0 ? std::abs(gradient.y) / steepness : 0;
  }
  /// Returns what interfaces subtract from ln I between a and b.
  double reflected(double a, double b) const {
    const auto rate = [&](double r) { return -std::log1p(-alpha(r)) / l_; };
    return Simpson(rate, 1e-10)(a, b);
  }
  /// Returns what absorption subtracts from ln I between a and b.
  double absorbed(double a, double b) const {
    const auto rate = [&](double r) {
      return absorption_mhz_ * std::log(10.0) / 100 * table_.at(density_({0, r, 0})).absorption_db_cm_mhz;
    };
    return Simpson(rate, 1e-10)(a, b);
  }

private:
  Density density_;
  const TissueTable& table_;
  double l_, absorption_mhz_;
};

struct Errors {
  double intensity = 0;    ///< of I, absolute
  double half_before = 0;  ///< of I compared with the loss up to half a sample in front of its place, and the face's
                           ///< absorption over that half
  double reflection = 0;   ///< of R, relative to its maximum
};

/// Compares the reference with `samples` per line with the continuous model. Returns the worst errors over all samples.
Errors errors(const MediumField& field, const Continuous& model, const TissueTable& table, double depth_mm, int samples,
              const Settings& settings) {
  const ScanLines lines = one_line(depth_mm, samples);
  const double dr = lines.dr_mm();
  const auto scan = traverse_reference(field, table, lines, settings, {});
  Errors worst;
  double reflected = 0, absorbed = 0, strongest = 0;
  for (int k = 0; k < samples; ++k) {
    const double r = (k + 0.5) * dr;
    const double half_before = reflected + absorbed + model.absorbed(0, dr / 2);
    reflected += model.reflected(r - dr / 2, r);
    absorbed += model.absorbed(r - dr / 2, r);
    const double intensity = std::exp(-reflected - absorbed);
    const double reflection = model.alpha(r) * intensity * intensity * model.cosine(r);
    worst.intensity = std::max(worst.intensity, std::abs(scan.intensity.at(0, k) - intensity));
    worst.half_before = std::max(worst.half_before, std::abs(scan.intensity.at(0, k) - std::exp(-half_before)));
    worst.reflection = std::max(worst.reflection, std::abs(scan.reflection.at(0, k) - reflection));
    strongest = std::max(strongest, reflection);
    reflected += model.reflected(r, r + dr / 2);
    absorbed += model.absorbed(r, r + dr / 2);
  }
  REQUIRE(strongest > 0);
  worst.reflection /= strongest;
  return worst;
}

double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

/// Returns two densities sampled into voxels. They meet in a plane 6 mm in front of the origin, across +y and tilted by
/// `tilt_deg` about an axis that is parallel to no axis of the grid.
Volume<std::int16_t> plane_in_voxels(const glm::dvec3& spacing, double tilt_deg, double hu_before, double hu_behind) {
  Volume<std::int16_t> ct;
  Grid& grid = ct.grid;
  grid.spacing = spacing;
  grid.size = glm::ivec3(glm::ceil(30.0 / spacing)) + 2;
  const glm::dmat3 turned(glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(0.3, 1, -0.5))));
  grid.direction = glm::dmat3(-turned[0], turned[1], turned[2]);
  grid.origin = glm::dvec3(0, 6, 0) - grid.direction * (grid.spacing * (glm::dvec3(grid.size) - 1.0) / 2.0);
  const glm::dvec3 normal(glm::rotate(glm::dmat4(1.0), glm::radians(tilt_deg), glm::normalize(glm::dvec3(0.4, 0, 1))) *
                          glm::dvec4(0, 1, 0, 0));
  for (int k = 0; k < grid.size.z; ++k)
    for (int j = 0; j < grid.size.y; ++j)
      for (int i = 0; i < grid.size.x; ++i) {
        const glm::dvec3 p = grid.patient_from_index({i, j, k});
        const double behind = glm::dot(p - glm::dvec3(0, 6, 0), normal);
        ct.voxels.push_back(std::int16_t(behind > 0 ? hu_behind : hu_before));
      }
  return ct;
}

AcousticVolume as_acoustic(const Volume<std::int16_t>& ct) {
  AcousticVolume volume;
  volume.grid = ct.grid;
  for (const std::int16_t hu : ct.voxels) volume.voxels.push_back({hu, 0});
  return volume;
}

}  // namespace

TEST_CASE("halving the sample distance halves the error of I and of R, at least") {
  const auto density = [](const glm::dvec3& p) { return 400 + 300 * std::sin(p.y / 3 + p.x) * std::sin(p.y / 7); };
  const MediumField field = [&](const glm::dvec3& p) { return Medium{density(p), 0}; };
  const TissueTable table = plain_table();
  Settings settings = without_absorption(0.6);
  settings.absorption = true;
  const Continuous model(density, table, 0.6, settings.frequency_mhz);
  Errors previous;
  for (int samples = 250; samples <= 8000; samples *= 2) {
    const Errors now = errors(field, model, table, 60, samples, settings);
    if (samples > 250) {
      const double of_intensity = order(previous.intensity, now.intensity);
      const double of_reflection = order(previous.reflection, now.reflection);
      std::printf("smooth medium, %4d samples: I off by %.2e (order %.2f), R by %.2e (order %.2f)\n", samples,
                  now.intensity, of_intensity, now.reflection, of_reflection);
      // The order approaches 1 from either side; the finest of these samplings is within 1 % of it.
      CHECK(of_intensity > 0.9);
      CHECK(of_reflection > 0.9);
    }
    previous = now;
  }
}

TEST_CASE("an interface in voxels, at any obliquity and spacing, converges to the continuous model") {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  struct Media {
    const char* name;
    double before, behind;
    int samples;  // at which the first-order error, proportional to alpha, is below the limit of the contract
  };
  for (const Media& media : {Media{"fat to liver", -100, 60, 2000}, Media{"liver to bone", 60, 1000, 40000}})
    for (const glm::dvec3& spacing : {glm::dvec3(1), glm::dvec3(0.5, 0.7, 3)})
      for (const double tilt : {0.0, 35.0, 60.0}) {
        const Volume<std::int16_t> ct = plane_in_voxels(spacing, tilt, media.before, media.behind);
        const AcousticVolume volume = as_acoustic(ct);
        const MediumField field = trilinear_field(volume);
        // sample_trilinear does not share code with trilinear_field: an error would have to occur in both.
        const Density density = [&](const glm::dvec3& p) {
          return sample_trilinear(ct, ct.grid.index_from_patient(p));
        };
        Settings settings = without_absorption(0.6);
        settings.absorption = true;
        const Continuous model(density, table, 0.6, settings.frequency_mhz);
        INFO(media.name << ", spacing " << spacing.x << " " << spacing.y << " " << spacing.z << ", tilt " << tilt);
        const Errors coarse = errors(field, model, table, 8, media.samples / 4, settings);
        const Errors fine = errors(field, model, table, 8, media.samples, settings);
        std::printf(
            "%-13s spacing %.1f %.1f %.1f, %2.0f deg, dr %.1f um: I off by %.2e (order %.2f), half a sample before "
            "%.2e (order %.2f), R %.2e (order %.2f)\n",
            media.name, spacing.x, spacing.y, spacing.z, tilt, 8000.0 / media.samples, fine.intensity,
            order(coarse.intensity, fine.intensity) / 2, fine.half_before,
            order(coarse.half_before, fine.half_before) / 2, fine.reflection,
            order(coarse.reflection, fine.reflection) / 2);
        CHECK(fine.intensity < 1e-4);
        CHECK(order(coarse.intensity, fine.intensity) / 2 > 0.9);
        CHECK(order(coarse.reflection, fine.reflection) / 2 > 0.9);
        // The recursion gives a sample everything in front of its own step. Otherwise it is a midpoint rule.
        CHECK(fine.half_before < 0.02 * fine.intensity);
      }
}
