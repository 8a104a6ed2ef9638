#pragma once

#include <cstdint>

namespace insonate::gl {

/// The stages of model S in the order they run; each reads what the one before it wrote. Reverberation and clutter
/// follow from the traversal's results and are part of the beam's stage, whose samples all count. Where white is a
/// fixed level, the fuse stage also maps to grey. Compress is a separate stage only where each frame sets its own
/// white. Enhance is the display filter (sim/model/display_filter.h), and maps to grey where it is on.
enum class Stage { traverse, beam, scan_convert, smooth, fuse, compress, enhance };
inline constexpr int kStageCount = 7;

/// The stages of model W. Compare computes LC2; it converts the scan lines itself and needs no image.
enum class WeinStage { traverse, scan_convert, compare };
inline constexpr int kWeinStageCount = 3;

/// The stages of model S where a sweep makes a volume. A volume is not smoothed as a picture is. So R, T and the rest
/// are fused (6) on the lines, and one number per sample is converted to the voxels. The maximum stage runs where the
/// volume's brightest voxel is white.
enum class SweepStage { traverse, beam, fuse, scan_convert, maximum, compress };
inline constexpr int kSweepStageCount = 6;

/// What a stage did.
struct StageCount {
  long runs = 0;                ///< since the simulator was created
  std::uint64_t evaluated = 0;  ///< samples (traverse, beam, a sweep's fuse), pixels or voxels of the last run
  std::uint64_t possible = 0;   ///< out of this many
};

}  // namespace insonate::gl
