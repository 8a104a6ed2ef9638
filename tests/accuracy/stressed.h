#pragma once

#include <algorithm>
#include <optional>

#include "sim/gl/simulator.h"
#include "sim/reference/reference.h"
#include "tests/accuracy/stress_scene.h"
#include "tests/gl/test_context.h"

namespace insonate::test {

/// Draws scenes with the shaders and with the reference, and checks that no stage lets out what is not a number or out
/// of its bounds, and that both agree wherever single precision can.
class Stressed {
public:
  /// @param scheme  the device's own when there is none
  explicit Stressed(const std::optional<gl::Scheme>& scheme = {})
      : simulator_({}, scheme ? *scheme : gl::Scheme::of_device()) {}

  Stages<float> shaders(const Scene& scene);
  Stages<double> reference(const Scene& scene, const MediumField& field) const;

  /// Bounds alone.
  Stages<float> check_shaders(const Scene& scene);
  /// Bounds of both, and agreement; what the shaders gave.
  Stages<float> check(const Scene& scene);

  /// Of all pixels in what check() was given that an echo comes from: of how many U is known well enough for grey.
  double share_compared() const { return double(compared_) / double(std::max(with_echo_, 1L)); }

private:
  test::TestContext context_;
  gl::Simulator simulator_;
  long with_echo_ = 0, compared_ = 0;
  TissueTable table_ = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
};

}  // namespace insonate::test
