#pragma once

#include <array>

namespace insonate {

enum class TextSize { normal, large, largest };
enum class LengthUnit { cm, mm };
/// The side of the screen that shows the probe's marker: left is usual for the abdomen, right for the heart.
enum class MarkerSide { left, right };
/// The colour of the ultrasound's white.
enum class Tint { grey, warm, cool };

/// Which views are on the screen, and where: Layout draws it.
enum class LayoutName { standard, slices, four };
inline constexpr std::array<const char*, 3> kLayoutNames{"standard", "slices", "four"};  ///< as in settings files

/// How the screen looks to a person. None of it changes what is computed or scored.
struct Look {
  TextSize text_size = TextSize::normal;
  LengthUnit length_unit = LengthUnit::cm;
  MarkerSide marker = MarkerSide::left;
  Tint tint = Tint::grey;
  LayoutName layout = LayoutName::standard;
  bool landmarks = false;  ///< the case's landmarks with their names, in the 3D view

  bool operator==(const Look&) const = default;
};

}  // namespace insonate
