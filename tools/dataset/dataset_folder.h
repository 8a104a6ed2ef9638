#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/tissue/tissue.h"
#include "tools/dataset/patients.h"
#include "tools/dataset/study.h"

namespace insonate {

/// The folder of a dataset: manifest.json, and shards/00000.h5 and so on. A shard under its name is finished and is
/// never written again. Processes on several machines may work in one folder at once.
class DatasetFolder {
public:
  explicit DatasetFolder(std::filesystem::path path) : path_(std::move(path)) {}

  /// Makes the folder and writes the manifest, without shards. If there is one already, it stays. Throws InputError if
  /// it is that of another study or another version of the program, or if the folder cannot be written.
  void begin(const Study& study, const std::vector<StudyPatient>& patients) const;
  /// Throws InputError if a dataset cannot begin here: the folder holds other files, or cannot be written.
  void check_may_begin() const;
  /// Returns whether the folder has a manifest.
  bool has_begun() const;
  /// Throws InputError if the folder's manifest is not that of this study and program.
  void check_is_of(const Study& study) const;

  /// Returns the name of a shard's file, and whether it is there.
  std::filesystem::path shard_file(std::uint32_t shard) const;
  bool has_shard(std::uint32_t shard) const;
  /// Returns a new name for the file of a shard that is being written (temporary_beside()).
  std::filesystem::path temporary_for(std::uint32_t shard) const;
  /// Gives a finished shard its name. If another process was faster, its shard stays and this one is removed. Throws
  /// InputError if the name cannot be taken.
  void put_in_place(const std::filesystem::path& temporary, std::uint32_t shard) const;

  /// Returns how many shards the manifest lists, and those that are not there. Throws InputError if there is no
  /// manifest or it cannot be read.
  std::uint32_t shards() const;
  std::vector<std::uint32_t> missing() const;

  /// Completes the manifest by the digests of all shards, and removes what killed processes left: shards that were not
  /// finished, and manifests that are a day old. Call it when none is missing. Every process that does so writes the
  /// same bytes.
  void complete() const;
  bool is_complete() const;

  /// Moves the shards of another folder of the same study here, unless they are there. Returns how many. Throws
  /// InputError if it is of another study, or a shard cannot be moved.
  std::uint32_t take_shards_of(const DatasetFolder& other) const;

  /// Returns one sentence for each shard that is damaged or is not the one that the manifest lists.
  std::vector<std::string> damage() const;

private:
  std::filesystem::path manifest_file() const { return path_ / "manifest.json"; }

  std::filesystem::path path_;
};

/// The tissue table that all datasets are made with, and its text.
struct DatasetTissues {
  TissueTable table;
  std::string text, digest;
};
DatasetTissues dataset_tissues();

}  // namespace insonate
