#pragma once

#include <glm/vec2.hpp>

#include <array>

namespace insonate {

/// The grey scale of a CT picture, Hounsfield units.
struct WindowLevel {
  static constexpr double kMinWindow = 1, kMaxWindow = 4000, kMinLevel = -1024, kMaxLevel = 3071;

  double window_hu = 400;  ///< width, kMinWindow to kMaxWindow
  double level_hu = 40;    ///< middle, kMinLevel to kMaxLevel

  bool operator==(const WindowLevel&) const = default;
};

struct WindowPreset {
  const char* name;
  WindowLevel grey;
};
/// The usual grey scales of radiology.
inline constexpr std::array<WindowPreset, 4> kWindowPresets{
    {{"Soft tissue", {400, 40}}, {"Lung", {1500, -600}}, {"Bone", {2000, 400}}, {"Liver", {150, 60}}}};

/// Returns the grey scale after a drag that began at `from`: to the right widens the window, upwards raises the level.
/// Whole units; wide windows change faster.
/// @param by  of the pointer since then, to the right and down, in pixels of a screen 1280 wide
WindowLevel dragged(const WindowLevel& from, const glm::dvec2& by);

/// The colour of the ultrasound over the grey CT.
enum class BlendColour { grey, amber, green };
/// Where the slices along the patient's axes cross: at the middle of the fan, or of the probe's face. A slice along the
/// skin shows little where the face lies on it, so the fan comes first.
enum class CrossHair { fan, face };

/// How the CT is shown. None of it changes what is computed or scored.
struct CtLook {
  WindowLevel grey;      ///< of all CT pictures; a patient that is opened begins with the usual one
  bool outlines = true;  ///< the labels' edges in their organs' colours
  BlendColour blend_colour = BlendColour::grey;
  CrossHair cross_hair = CrossHair::fan;

  bool operator==(const CtLook&) const = default;
};

}  // namespace insonate
