#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace insonate::view {

/// The range of a transfer function, in Hounsfield units: what 12 bits of a CT can store.
inline constexpr int kFirstTransfer_hu = -1024, kLastTransfer_hu = 3071;

/// The greatest opacity of a point. Full opacity of 1 mm would need infinite extinction.
inline constexpr double kMaxOpacity = 0.995;

/// A corner of a transfer function.
struct TransferPoint {
  double hu = 0;           ///< kFirstTransfer_hu to kLastTransfer_hu
  glm::dvec3 colour{1.0};  ///< sRGB, 0 to 1
  double opacity = 0;      ///< of 1 mm of tissue, 0 to kMaxOpacity
  bool operator==(const TransferPoint&) const = default;
};

/// Says how the tissue of a CT looks by its Hounsfield units: the transfer function of direct volume rendering.
///
/// Between two points, colour and opacity are linear in HU. Below the first point and above the last, they are those of
/// that point. Tissue of opacity a has the extinction -ln(1 - a) per mm, and emits its colour in proportion to it
/// (emission and absorption: equations 8 and 9 of Kutter, Shams, Navab 2009).
struct TransferFunction {
  std::string name;                   ///< shown to the user
  std::vector<TransferPoint> points;  ///< by rising HU; none: nothing is drawn
  bool operator==(const TransferFunction&) const = default;

  /// Returns colour and opacity at `hu`.
  TransferPoint at(double hu) const;

  /// Returns the function with its points moved: HU h becomes centre + (h - centre) * scale + shift, `centre` being the
  /// middle between the first and the last point. Points that leave the range stay at its end.
  /// @param scale  > 0
  TransferFunction moved(double shift_hu, double scale) const;
};

/// A transfer function in a table, as the shader and the reference read it.
///
/// Between whole HU, `value` and `integral` are linear. The mean of the function over the range from f to b is
/// (integral(b) - integral(f)) / (b - f). This makes pre-integration cheap: where the paper looks up a table of front
/// and back values, a sample takes the mean between its own value and the previous one's (integral functions: Engel,
/// Kraus, Ertl 2001, "High-Quality Pre-Integrated Volume Rendering"). Nothing has to be recomputed while a function is
/// edited. The attenuation within one segment is that of its mean, so a segment's colours are not in order of depth.
struct TransferTable {
  static constexpr int kEntries = kLastTransfer_hu - kFirstTransfer_hu + 1;

  std::vector<glm::vec4> values;  ///< per whole HU from kFirstTransfer_hu on: colour times extinction, extinction, 1/mm
  std::vector<glm::vec4> integrals;  ///< of `values` over HU, from kFirstTransfer_hu on

  explicit TransferTable(const TransferFunction& function);

  /// Returns the value at `hu`, clamped to the range.
  glm::dvec4 value(double hu) const;
  /// Returns the mean of the function between two values, by the integrals; the value for equal ones.
  glm::dvec4 mean(double front_hu, double back_hu) const;
};

/// Answers in constant time whether a function shows anything of a range of HU.
class VisibleRanges {
public:
  explicit VisibleRanges(const TransferTable& table);

  /// Returns whether the extinction is above 0 anywhere from `low` to `high`, or in the whole HU beside them.
  bool shows(int low, int high) const;

private:
  std::vector<int> visible_below_;  ///< number of visible entries before each entry
};

}  // namespace insonate::view
