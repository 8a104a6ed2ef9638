#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tools/dataset/dataset_image.h"

namespace insonate {

/// The size of all images of a shard.
struct ShardShape {
  std::uint32_t images = 0;
  int width = 0, height = 0;
  int most_lines = 0;  ///< of the study's probes
};

/// Writes one shard as an HDF5 file. It has one row per image, in the order of their indices (docs/datasets.md lists
/// the datasets). Equal images give equal bytes if they are put in the same order. Throws InputError, under the final
/// name, if the file cannot be written.
class ShardWriter {
public:
  /// @param temporary  the file to write
  /// @param shown      its name in error sentences
  /// @param about      attributes of the file: names and texts
  ShardWriter(const std::filesystem::path& temporary, const std::filesystem::path& shown, const ShardShape& shape,
              const std::vector<std::pair<std::string, std::string>>& about);
  ~ShardWriter();
  ShardWriter(const ShardWriter&) = delete;
  ShardWriter& operator=(const ShardWriter&) = delete;

  /// Writes one image into its row.
  void put(std::uint32_t row, const DatasetImage& image);
  /// Writes what is left, and waits until the file is on the disk. All rows must be put.
  void finish();

private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Waits until a file is on the disk. Returns false if that fails.
bool flush_to_disk(const std::filesystem::path& file);

/// What a shard states of itself.
struct ShardSummary {
  std::string study_digest, case_digest, device;
  std::string digest;  ///< of the digests of its images
};

/// Reads that. Throws InputError for a file that is not a shard.
ShardSummary read_shard_summary(const std::filesystem::path& file);

/// Reads all of a shard and returns what is damaged, as the problem part of an InputError; empty if it is sound. HDF5
/// checks each image by its checksum.
std::string damage_of_shard(const std::filesystem::path& file);

}  // namespace insonate
