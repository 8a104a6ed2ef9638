#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "app/pictures/picture_reader.h"
#include "devices/record/sequence_recorder.h"
#include "scenarios/action.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// What the `part`-th of several files is called, from 1 on: scan.igs.mha, scan-2.igs.mha, scan-3.igs.mha...
std::filesystem::path part_of(const std::filesystem::path& file, int part);

/// The files of one recorded run.
///
/// FILE has the samples, to the bit, with what the learner did before each. With pictures there is a second file,
/// FILE-images: a frame for each picture, with the pose it was drawn at and the time on the source's clock. Its
/// pictures all have the size of the first one; one of another size, as of a window that was resized, is sampled anew.
///
/// A file's times rise, so whatever begins anew begins a file of its own: scan.igs.mha is followed by scan-2.igs.mha.
/// What has been added is safe from a crash of the program when add() has returned (SequenceRecorder). Whatever is
/// called throws InputError when a file cannot be written.
class RunFiles {
public:
  /// Makes the file's beginning at once. @param exactly  it has to be this name, else the next one that is free
  RunFiles(std::filesystem::path file, bool exactly, bool with_pictures);

  /// Makes the files so far and begins others.
  void begin_next();
  /// @param actions  what was done before them, by their times
  void add(const std::vector<PoseSample>& samples, const ActionLog& actions);
  void add(const DrawnPicture& picture);
  /// Makes the files.
  void finish();

  /// Where the samples go to.
  const std::filesystem::path& file() const { return poses_->file(); }

private:
  std::filesystem::path file_;
  bool with_pictures_;
  std::unique_ptr<SequenceRecorder> poses_, pictures_;
  int width_ = 0, height_ = 0;  ///< of the pictures
  double picture_s_ = 0;        ///< time of the last one
};

}  // namespace insonate
