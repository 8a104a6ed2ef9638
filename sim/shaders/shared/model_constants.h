// The models' numbers that shaders and C++ share; both include this file. sim/model explains them and names the sources.
#ifdef __cplusplus
#pragma once
namespace insonate {
#define INSONATE_REAL inline constexpr double
#define INSONATE_INT inline constexpr int
#else
#define INSONATE_REAL const float
#define INSONATE_INT const int
#endif

// Coupling (sim/tissue/coupling.h), Hounsfield units.
INSONATE_REAL kCouplingTissue_hu = -150.0, kCouplingAir_hu = -301.0, kFreeGelShare = 1e-3;
INSONATE_REAL kMinGel_mm = 2e-5;  // beyond half the reflection length

// Where the CT ends (sim/tissue/acoustic_volume.h): dB, and dB/(cm MHz) per square dB.
INSONATE_REAL kEndless_db = -61.0, kEndAbsorption = 0.006;

// The weakest echo that counts (sim/model/stages.h).
INSONATE_REAL kMinEcho = 1e-30;

// Refraction (sim/model/refraction.h): Hounsfield units, and the logarithm of the speed of sound per unit.
INSONATE_REAL kMinRefracting_hu = -150.0, kMaxRefracting_hu = 150.0, kLogSpeedBelowWater = 5e-4, kLogSpeedAboveWater = 7.6e-4;

// Reverberation (sim/model/reverberation.h).
INSONATE_REAL kMinRound = 1e-3, kMinFromFace = 1e-2, kMinReverberant = 1e-12;
INSONATE_INT kMaxRepeats = 16, kMaxReflectors = 64;

// Clutter from the body wall (sim/model/noise.h).
INSONATE_REAL kWallReturn = 0.4, kLayerShare = 0.003, kMinLayerEcho = 1e-18;

// Mirror images (sim/model/mirror_image.h).
INSONATE_REAL kMinMirror = 0.6, kFullMirror = 0.9, kMaxMirrored = 3.0, kOwnPlace = 1e-2, kMinOfFace = 1e-3;

// Shares of an interface's amplitude (sim/model/waves.h).
INSONATE_REAL kMirrorShare = 0.8, kRoughShare = 0.6;

// What a stored number of the scatterers' lattice is multiplied by (sim/model/scatterers.h).
INSONATE_REAL kScattererScale = 4.0;

// The mu of air in model W (sim/wein/wein_settings.h).
INSONATE_REAL kAirMu = 1.2;

#undef INSONATE_REAL
#undef INSONATE_INT
#ifdef __cplusplus
}  // namespace insonate
#endif
