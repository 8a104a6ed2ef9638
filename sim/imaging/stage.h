#pragma once

#include <cstdint>

namespace insonate::gl {

/// The stages of model S in the order they run; each reads what the one before it wrote. Reverberation and clutter
/// follow from what the traversal found and are part of the beam's stage, all of whose samples count. Fusing goes on to
/// grey by itself where white is a fixed level: compressing is a stage of its own only where each frame sets its own.
enum class Stage { traverse, beam, scan_convert, smooth, fuse, compress };
inline constexpr int kStageCount = 6;

/// The stages of model W: comparing is LC2's, which converts the scan lines by itself and needs no image.
enum class WeinStage { traverse, scan_convert, compare };
inline constexpr int kWeinStageCount = 3;

/// The stages of model S where a sweep makes a volume. A volume is not smoothed as a picture is, so that R, T and the
/// rest are fused (6) on the lines and one number a sample is brought to the voxels. The maximum is looked for where
/// the volume's brightest voxel is white.
enum class SweepStage { traverse, beam, fuse, scan_convert, maximum, compress };
inline constexpr int kSweepStageCount = 6;

/// What a stage did.
struct StageCount {
  long runs = 0;                ///< since the simulator was made
  std::uint64_t evaluated = 0;  ///< samples (traverse, beam, a sweep's fuse), pixels or voxels, of its last run
  std::uint64_t possible = 0;   ///< of so many
};

}  // namespace insonate::gl
