#pragma once

#include <cstdint>
#include <vector>

#include "sim/view/body/transfer_function.h"

namespace insonate::view {

/// How a sample of the CT becomes colour and opacity.
enum class Classification {
  post,            ///< the transfer function at each sample; thin layers of it are missed between samples
  pre_integrated,  ///< its mean between one sample and the next
};

/// How the CT itself is drawn in the volume view, by direct volume rendering.
struct CtVolumeStyle {
  TransferFunction function;
  Classification classification = Classification::pre_integrated;
  double step = 0.5;        ///< between samples, in sides of the CT's smallest voxel side, > 0
  bool shaded = true;       ///< lights surfaces (Blinn-Phong, by gradients of the CT)
  bool jittered = true;     ///< turns rings into fine noise
  bool skips_empty = true;  ///< the picture is the same without, but for rounding
  bool body_only = true;    ///< leaves out the scanner's table, which is not connected to the body
  /// Labelled structures whose surfaces are drawn within the CT: label values, 1 to 255; nothing without labels.
  std::vector<std::uint8_t> structures = {};
  double structure_opacity = 0.9;  ///< of a surface, 0 to 1
  bool operator==(const CtVolumeStyle&) const = default;
};

}  // namespace insonate::view
