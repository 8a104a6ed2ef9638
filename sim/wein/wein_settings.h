#pragma once

#include "sim/tissue/coupling.h"

namespace insonate {

/// All parameters by which model W, the model for registration, turns a CT, a pose and a probe into an image: W. Wein,
/// S. Brunke, A. Khamene, M. R. Callstrom, N. Navab, "Automatic CT-ultrasound registration for diagnostic imaging and
/// image-guided intervention", Medical Image Analysis 12 (2008).
///
/// With mu = HU + 1000, l the reflection length and g = l grad mu, each l of the path reflects the share dR = |d . g|
/// |g| / (2 mu)^2 back to the probe and transmits dT = 1 - (|g| / (2 mu))^2. |g| / (2 mu) is at most 1, and mu at least
/// that of air. An echo is an energy, so it counts the same whether mu rises or falls along the beam. With dr between
/// the samples
///     I(r + dr) = I(r) dT^(dr/l),  I(face) = 1
///     R = ln(1 + a I dR) / ln(1 + a)                                       reflection, 0 to 1
///     E = clamp((HU - dark_hu) / (bright_hu - dark_hu), 0, 1)              echogenicity, 0 to 1
/// so that neither depends on dr. The gradient is computed at the CT's voxels, from differences over l along the CT's
/// axes, and is interpolated between them as mu is. Outside the CT the gradient is 0.
struct WeinSettings {
  int samples = 96;                 ///< per line, 1 to 8192
  double reflection_length_mm = 2;  ///< l, 0.01 to 20
  double contact_mm = 6;  ///< nearer to the face than this, air counts as water and nothing reflects: 0 (none) to 100

  double compression = 1000;      ///< a of the reflection's logarithm, 0.001 to 1e6
  double dark_hu = -50;           ///< lower end of soft tissue's range, at fat, -1000 to 3000
  double bright_hu = 150;         ///< upper end, at enhanced parenchyma, -1000 to 3000; dark_hu + kMinHuRange or more
  bool shadows = true;            ///< E is also scaled by I, so that a shadow holds no echo; not so in the paper
  double reflection_share = 0.5;  ///< s in the image, s R + (1 - s) E, 0 to 1

  bool exact_filter = false;  ///< as in Settings

  int similarity_patch = 0;  ///< side of LC2's patches in pixels; patches are weighted by the ultrasound's
                             ///< variance in them; 0: the whole picture; else kMinPatch to kMaxPatch, with at most
                             ///< kMaxPatches in a picture

  int image_width = 128;  ///< 1 to 8192
  int image_height = 96;  ///< 1 to 8192
};

inline constexpr double kMinHuRange = 1;
inline constexpr int kMinPatch = 4, kMaxPatch = 128;
/// Most patches whose sums fit textures 16384 wide, which every device has: three texels each, in work groups of up to
/// 128.
inline constexpr int kMaxPatches = 5376;

// The least mu that counts is that of air, kAirMu: air's density is 1.2e-3 of water's, whose mu is 1000. Nearer to the
// face than contact_mm, air counts as water as coupling gel does in model S (sim/tissue/coupling.h).

}  // namespace insonate
