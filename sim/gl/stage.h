#pragma once

namespace insonate::gl {

/// The stages of model S in the order they run; each reads what the one before it wrote. Fusing goes on to grey by
/// itself where white is a fixed level: compressing is a stage of its own only where each frame sets its own.
enum class Stage { traverse, beam, scan_convert, smooth, fuse, compress };
inline constexpr int kStageCount = 6;

}  // namespace insonate::gl
