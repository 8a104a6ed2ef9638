#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sim/core/grid.h"
#include "sim/reconstruction/tracked_picture.h"

namespace insonate {

/// Which voxels a pixel is written to.
enum class Insertion {
  nearest,    ///< the voxel that it lies in
  trilinear,  ///< the eight voxels around it, with trilinear weights
};

/// How a voxel that several pictures show gets its value.
enum class Compounding {
  mean,     ///< weighted mean of all pixels
  maximum,  ///< the largest of the pictures' values
  latest,   ///< the value of the last picture
};

/// What is known of a voxel.
enum class VoxelKnown : std::uint8_t {
  unseen = 0,    ///< no picture shows it
  filled = 1,    ///< interpolated between measured voxels
  measured = 2,  ///< at least one picture shows it
};

struct ReconstructionSettings {
  Insertion insertion = Insertion::trilinear;
  Compounding compounding = Compounding::mean;
  /// A voxel is filled if it lies between two measured voxels that are at most twice this far from each other, mm; 0
  /// fills nothing. Up to 20.
  double hole_radius_mm = 2;

  bool operator==(const ReconstructionSettings&) const = default;
};

/// A volume of grey levels, and what is known of each voxel.
struct ReconstructedVolume {
  Volume<std::uint8_t> grey;   ///< 0 where `known` is 0
  Volume<std::uint8_t> known;  ///< VoxelKnown, on the same grid

  bool empty() const { return grey.empty(); }
};

/// Reconstructs a volume from tracked pictures, one picture at a time. Each pixel of a picture's region is written to
/// the voxels at its place in the patient. A measured voxel has a pixel less than one voxel away along each axis, with
/// `nearest` less than half a voxel.
///
/// For `maximum` and `latest`, the pixels of one picture at a voxel count as their weighted mean. A voxel takes at most
/// 16,384 samples of the mean, so that a hand that rests does not exhaust single precision. Memory: 8 bytes per voxel,
/// 13 for `maximum` and `latest`, and 2 per voxel of each result. Work is divided among threads by voxels. So results
/// do not depend on their number, nor on whether the pictures come one by one or all at once.
///
///     Reconstruction reconstruction(choose_grid(pictures, 0.5).grid, {});
///     for (const TrackedPicture& picture : pictures) reconstruction.add(picture);
///     const ReconstructedVolume volume = reconstruction.filled();
class Reconstruction {
public:
  /// @param grid  sizes of 1 or more, orthonormal directions; sweep_extent.h chooses one
  explicit Reconstruction(const Grid& grid, const ReconstructionSettings& settings = {});

  /// Inserts a picture. Pixels beyond the grid are left out.
  void add(const TrackedPicture& picture);

  /// Extends the grid by voxels before its first and behind its last ones along each axis, 0 or more. Inserted
  /// pictures stay where they lie in the patient.
  void extend(const glm::ivec3& before, const glm::ivec3& behind);

  const Grid& grid() const { return grid_; }
  std::size_t pictures() const { return pictures_; }

  /// Returns the volume without filled voxels.
  ReconstructedVolume measured() const;
  /// Returns the volume with its holes filled (hole_filling.h).
  ReconstructedVolume filled() const;

private:
  struct Sum {
    float value = 0, weight = 0;
  };
  void insert_slab(const TrackedPicture& picture, int first_j, int end_j);
  void insert(std::size_t at, float value, float weight);
  std::uint8_t value_at(std::size_t at) const;
  std::uint8_t mean_of(const Sum& sum) const;

  Grid grid_;
  ReconstructionSettings settings_;
  std::size_t pictures_ = 0;
  std::vector<Sum> sums_;  ///< for maximum and latest: of the picture that touched the voxel last
  // For maximum and latest alone.
  std::vector<std::uint8_t> before_;       ///< the value of the pictures before that one
  std::vector<std::uint32_t> touched_by_;  ///< that picture's number, from 1; 0: none
};

/// Returns the names "nearest", "trilinear"; "mean", "maximum", "latest".
std::string_view to_string(Insertion insertion);
std::string_view to_string(Compounding compounding);

}  // namespace insonate
