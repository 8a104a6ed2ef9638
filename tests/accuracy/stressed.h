#pragma once

#include <algorithm>
#include <optional>

#include "sim/imaging/simulator.h"
#include "sim/reference/reference.h"
#include "tests/accuracy/stress_scene.h"
#include "tests/gl/test_context.h"

namespace insonate::test {

/// Pixels that an echo comes from, and those of them of which U is known well enough for grey to be compared.
struct Compared {
  long with_echo = 0, in_grey = 0;

  double share() const { return double(in_grey) / double(std::max(with_echo, 1L)); }
  Compared& operator+=(const Compared& other) {
    with_echo += other.with_echo;
    in_grey += other.in_grey;
    return *this;
  }
};

/// Draws scenes with the shaders and with the reference, and checks that no stage lets out what is not a number or out
/// of its bounds, and that both agree wherever single precision can.
class Stressed {
public:
  /// @param work division  the device's own when there is none
  explicit Stressed(const std::optional<gl::WorkDivision>& division = {})
      : simulator_({}, division ? *division : gl::WorkDivision::of_device()) {}

  Stages<float> shaders(const Scene& scene);
  Stages<double> reference(const Scene& scene, const MediumField& field) const;

  /// Bounds alone.
  Stages<float> check_shaders(const Scene& scene);
  /// Bounds of both, and agreement; what the shaders gave.
  Stages<float> check(const Scene& scene);

  /// Of all that check() was given.
  const Compared& compared() const { return compared_; }

private:
  test::TestContext context_;
  gl::Simulator simulator_;
  Compared compared_;
  TissueTable table_ = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
};

}  // namespace insonate::test
