#pragma once

namespace insonate {

/// Everything that decides how model W, the one for registration, turns a CT, a pose and a probe into an image: W.
/// Wein, S. Brunke, A. Khamene, M. R. Callstrom, N. Navab, "Automatic CT-ultrasound registration for diagnostic imaging
/// and image-guided intervention", Medical Image Analysis 12 (2008).
///
/// With mu = HU + 1000, l the reflection length and g = l grad mu, each l of the way reflects the share
/// dR = |d . g| |g| / (2 mu)^2 back to the probe and lets dT = 1 - (|g| / (2 mu))^2 pass; |g| / (2 mu) is at most 1,
/// and mu at least that of air. An echo is an energy, so it counts alike whether mu rises or falls along the beam. With
/// dr between the samples
///     I(r + dr) = I(r) dT^(dr/l),  I(face) = 1
///     R = ln(1 + a I dR) / ln(1 + a)                                       reflection, 0 to 1
///     E = the share of the way that HU has gone from dark_hu to bright_hu   echogenicity, 0 to 1
/// so that neither depends on dr. The gradient is taken on the CT's voxels, as differences over l along the CT's axes,
/// and is interpolated between them as mu itself is; outside the CT there is none.
struct WeinSettings {
  int samples = 96;                 ///< a line, 1 to 8192
  double reflection_length_mm = 2;  ///< l, 0.01 to 20
  double contact_mm = 6;  ///< nearer to the face than this, air counts as water and nothing reflects: 0 (none) to 100

  double compression = 1000;      ///< a of the reflection's logarithm, 0.001 to 1e6
  double dark_hu = -50;           ///< soft tissue's range, between fat, -1000 to 3000 ...
  double bright_hu = 150;         ///< ... and enhanced parenchyma, as much; kLeastHuRange or more above dark_hu
  bool shadows = true;            ///< E too is scaled by I, so that a shadow holds no echo; the paper leaves E as it is
  double reflection_share = 0.5;  ///< s in the image, s R + (1 - s) E, 0 to 1

  bool exact_filter = false;  ///< as in Settings

  int similarity_patch = 0;  ///< pixels: LC2 of patches of so many squared, weighted by the ultrasound's variance in
                             ///< them; 0 (of the whole picture), or kLeastPatch to kMostPatch with at
                             ///< most kMostPatches in a picture

  int image_width = 128;  ///< 1 to 8192
  int image_height = 96;  ///< 1 to 8192
};

inline constexpr double kLeastHuRange = 1;
inline constexpr int kLeastPatch = 4, kMostPatch = 128;
/// What textures 16384 wide, as every device has, hold the sums of: three texels each, in work groups of up to 128.
inline constexpr int kMostPatches = 5376;

/// The mu of air, below which none counts: its density is 1.2e-3 of water's, whose mu is 1000.
inline constexpr double kAirMu = 1.2;

/// Nearer to the face than WeinSettings::contact_mm, what is no denser than kContactAirHu counts as water, what is as
/// dense as kContactTissueHu as itself, and what lies between as its share of both: HU. Were there a density at which
/// tissue turned into water at once, the picture would jump while the probe moves.
inline constexpr double kContactTissueHu = -150, kContactAirHu = -301;

}  // namespace insonate
