#pragma once

#include <algorithm>
#include <optional>

#include "sim/imaging/simulator.h"
#include "sim/reference/reference.h"
#include "tests/accuracy/stress_scene.h"
#include "tests/gl/test_context.h"

namespace insonate::test {

/// Counts pixels with an echo, and those of them whose U is known well enough to compare grey.
struct Compared {
  long with_echo = 0, in_grey = 0;

  double share() const { return double(in_grey) / double(std::max(with_echo, 1L)); }
  Compared& operator+=(const Compared& other) {
    with_echo += other.with_echo;
    in_grey += other.in_grey;
    return *this;
  }
};

/// Draws scenes with the shaders and with the reference. Checks that every stage returns numbers within its bounds, and
/// that both agree wherever single precision can.
class Stressed {
public:
  /// @param division  the work division; empty: the device's own
  explicit Stressed(const std::optional<gl::WorkDivision>& division = {})
      : simulator_({}, division ? *division : gl::WorkDivision::of_device()) {}

  Stages<float> shaders(const Scene& scene);
  Stages<double> reference(const Scene& scene, const MediumField& field) const;

  /// Checks bounds only. Returns the shaders' stages.
  Stages<float> check_shaders(const Scene& scene);
  /// Checks the bounds of both, and their agreement. Returns the shaders' stages.
  Stages<float> check(const Scene& scene);

  /// Returns the counts over all scenes passed to check().
  const Compared& compared() const { return compared_; }

private:
  test::TestContext context_;
  gl::Simulator simulator_;
  Compared compared_;
  TissueTable table_ = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
};

}  // namespace insonate::test
