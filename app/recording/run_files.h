#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "app/pictures/picture_reader.h"
#include "devices/record/sequence_recorder.h"
#include "scenarios/action.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// Returns the name of the `part`-th of several files, counted from 1: scan.igs.mha, scan-2.igs.mha, scan-3.igs.mha...
std::filesystem::path part_of(const std::filesystem::path& file, int part);

/// Returns the file of a recording's pictures, FILE-images, which need not exist.
std::filesystem::path images_of(const std::filesystem::path& file);

/// Writes the files of one recorded run.
///
/// FILE contains the samples, bit-exact, with the learner's actions before each. With pictures there is a second file,
/// FILE-images: one frame per picture, with the pose it was drawn at and the time on the source's clock. All its
/// pictures have the size of the first one. A picture of another size, as after the window was resized, is resampled.
///
/// The times in a file increase, so every restart begins a new file: scan.igs.mha is followed by scan-2.igs.mha. What
/// has been added survives a crash of the program once add() has returned (SequenceRecorder). Every function throws
/// InputError if a file cannot be written.
class RunFiles {
public:
  /// Creates the working file at once.
  /// @param exactly  whether to use this very name; otherwise the next free one
  RunFiles(std::filesystem::path file, bool exactly, bool with_pictures);

  /// Finishes the current files and begins the next ones.
  void begin_next();
  /// @param actions  the actions before the samples, keyed by the samples' times
  void add(const std::vector<ProbeSample>& samples, const ActionLog& actions);
  void add(const DrawnPicture& picture);
  /// Finishes the files.
  void finish();

  /// Returns the file that receives the samples.
  const std::filesystem::path& file() const { return poses_->file(); }

private:
  std::filesystem::path file_;
  bool with_pictures_;
  std::unique_ptr<SequenceRecorder> poses_, pictures_;
  int width_ = 0, height_ = 0;  ///< of the pictures
  double picture_s_ = 0;        ///< time of the last one
};

}  // namespace insonate
