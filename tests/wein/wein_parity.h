#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "sim/core/hash.h"
#include "sim/wein/wein_reference.h"
#include "tests/imaging/parity.h"

/// Compares the stages of model W with its reference.
namespace insonate::test {

/// The reference's stages of one picture, exact and over fields that are known in single precision.
struct ReferenceWeinStages {
  WeinStages<double> exact;
  std::array<WeinStages<double>, 4> uncertain;
};

inline ReferenceWeinStages reference_wein_stages(const WeinField& field, const Probe& probe, double depth_mm,
                                                 const WeinSettings& settings, const Pose& pose) {
  ReferenceWeinStages stages;
  stages.exact = wein_reference(field, probe, depth_mm, settings, pose);
  // Positions and densities have single precision, see parity.h; the stored gradient is rounded to 1/16 HU.
  for (std::uint32_t i = 0; i < stages.uncertain.size(); ++i)
    stages.uncertain[i] = wein_reference(
        [&field, i, count = std::uint32_t(0)](const glm::dvec3& p) mutable {
          const auto random = [&] { return 2.0 * unit_float(hash(i, count++)) - 1.0; };
          WeinMedium medium = field(p + 3e-5 * glm::dvec3(random(), random(), random()));
          medium.hu += 2e-4 * random();
          medium.gradient_hu += glm::dvec3(random(), random(), random()) / 16.0;
          return medium;
        },
        probe, depth_mm, settings, pose);
  return stages;
}

/// Checks the stages on the scan lines and the picture.
inline void check_wein_stages(const ReferenceWeinStages& reference, const WeinStages<float>& got) {
  const WeinStages<double>& expected = reference.exact;
  const auto check = [&](const char* what, Image<double> WeinStages<double>::*stage, const Image<float>& image,
                         auto&& basic) {
    const Worst found = worst(expected.*stage, image, tolerated(expected, reference.uncertain, stage, basic));
    INFO(described(what, found));
    CHECK(found.error < 1);
  };
  // I: 1e-4 relative, or 1e-10 below 1e-6. R and E: 1e-4 of 1.
  check("I", &WeinStages<double>::intensity, got.intensity, [](double i) { return 1e-4 * std::max(i, 1e-6); });
  check("R", &WeinStages<double>::scan_reflection, got.scan_reflection, [](double) { return 1e-4; });
  check("E", &WeinStages<double>::scan_echogenicity, got.scan_echogenicity, [](double) { return 1e-4; });
  int worst_grey = 0, brightest = 0;
  REQUIRE(got.grey.pixels.size() == expected.grey.pixels.size());
  for (std::size_t i = 0; i < got.grey.pixels.size(); ++i) {
    worst_grey = std::max(worst_grey, std::abs(int(expected.grey.pixels[i]) - int(got.grey.pixels[i])));
    brightest = std::max(brightest, int(got.grey.pixels[i]));
  }
  CHECK(worst_grey <= 1);  // 1e-4 of each term is far below one grey level, but can cross the border between two
  CHECK(brightest > 60);   // a black image would agree as well
}

}  // namespace insonate::test
