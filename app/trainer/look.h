#pragma once

namespace insonate {

enum class TextSize { normal, large, largest };
enum class LengthUnit { cm, mm };
/// The side of the screen that shows the probe's marker: left is usual for the abdomen, right for the heart.
enum class MarkerSide { left, right };
/// The colour of the ultrasound's white.
enum class Tint { grey, warm, cool };

/// How the screen looks to a person. None of it changes what is computed or scored.
struct Look {
  TextSize text_size = TextSize::normal;
  LengthUnit length_unit = LengthUnit::cm;
  MarkerSide marker = MarkerSide::left;
  Tint tint = Tint::grey;

  bool operator==(const Look&) const = default;
};

}  // namespace insonate
