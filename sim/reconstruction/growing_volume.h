#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/reconstruction/reconstruction.h"

namespace insonate {

/// Reconstructs a volume while its sweep lasts, without knowing where that leads: the grid grows with the pictures. It
/// keeps the pictures, because a grid that becomes too large gets larger voxels, and one that lies askew of the whole
/// sweep's mean plane is replaced at the end.
///
/// Not thread-safe.
class GrowingVolume {
public:
  /// @param voxel_mm     0.05 to 20
  /// @param most_voxels  of the grid, at least 1000
  GrowingVolume(double voxel_mm, const ReconstructionSettings& settings, std::size_t most_voxels);

  /// Inserts a picture, whose region must not be empty.
  void add(TrackedPicture picture);

  /// Returns the volume of all pictures so far, with its holes filled: its grid is at most kMaxSkew_deg askew of their
  /// mean plane. Throws std::logic_error without a picture.
  ReconstructedVolume finish();
  static constexpr double kMaxSkew_deg = 5;

  const std::vector<TrackedPicture>& pictures() const { return pictures_; }
  /// Returns why voxels are larger than was asked for, as a sentence; empty if they are not.
  const std::string& remark() const { return remark_; }

private:
  bool make_room(const TrackedPicture& picture);
  void rebuild();

  double voxel_mm_;
  ReconstructionSettings settings_;
  std::size_t most_voxels_;
  std::vector<TrackedPicture> pictures_;
  std::optional<Reconstruction> reconstruction_;
  std::string remark_;
};

}  // namespace insonate
