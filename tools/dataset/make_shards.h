#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tools/dataset/dataset_folder.h"
#include "tools/dataset/dataset_image.h"
#include "tools/dataset/study.h"

namespace insonate {

/// Opens each patient of a study and draws the first image of each of its shards. Throws InputError for poses that a
/// patient does not have.
void check_patients(const Study& study, const std::vector<StudyPatient>& patients);

/// A shard that make_shards() has made.
struct MadeShard {
  std::uint32_t shard = 0, images = 0;
  std::string patient;
  double seconds = 0;  ///< from the first drawn shot to the finished file, without opening the patient
};

/// Makes those of `shards` that are not finished. Opens an OpenGL context, and a thread that computes the truth and
/// writes while the next pictures are drawn. Throws InputError.
/// @param made  called after each shard
void make_shards(const Study& study, const std::vector<StudyPatient>& patients, const DatasetFolder& folder,
                 const std::vector<std::uint32_t>& shards, const std::function<void(const MadeShard&)>& made);

/// An image that was made alone, and the attributes of its shard.
struct SingleImage {
  DatasetImage image;
  std::vector<std::pair<std::string, std::string>> about;  ///< name and text; `options` and `labels` are JSON
};

/// Makes one image of a study again, the same as in its shard. Throws InputError.
SingleImage make_image(const Study& study, const std::vector<StudyPatient>& patients, std::uint32_t index);

}  // namespace insonate
