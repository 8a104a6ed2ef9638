#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "devices/record/append_only.h"
#include "sim/core/image.h"
#include "sim/core/probe_sample.h"

namespace insonate {

/// Writes a sequence file while a run goes on, so that a crash loses almost nothing.
///
/// A sequence file states its number of frames at its beginning and has its pictures at its end, so it cannot simply
/// grow. Instead a working file beside it grows, `FILE.recording`, and with pictures also `FILE.recording.images`. Both
/// are only appended to. Once flush() has returned, the operating system holds the data, so they survive a crash of the
/// program. They may not survive a power cut, because nothing is forced to the disk. finish() makes FILE from the
/// working files and removes them. After a crash, recover_recording() (recording_files.h) does the same, up to the last
/// complete frame.
///
/// The working file is text: a line `insonate recording 1 WIDTH HEIGHT`, and for each frame its lines of the sequence
/// file, followed by `frame BYTES ADLER`. BYTES is the end of this frame's picture in the images file, and ADLER is the
/// Adler-32 of all pictures up to there. The images file is a zlib stream that is aligned to a byte after every
/// picture. So it can be cut at any of those places and closed with that Adler-32.
///
/// Not thread-safe.
class SequenceRecorder {
public:
  /// Creates the working files. If width and height are above 0, every frame has a picture of that size; with 0 no
  /// frame has one. Throws InputError if `file` does not end in ".mha", if it or its working file already exists, or if
  /// the working file cannot be written.
  explicit SequenceRecorder(std::filesystem::path file, int width = 0, int height = 0);
  /// Finishes unless finish() was called. If that fails, the working files stay.
  ~SequenceRecorder();
  SequenceRecorder(const SequenceRecorder&) = delete;
  SequenceRecorder& operator=(const SequenceRecorder&) = delete;

  /// Adds a frame without a picture. Throws std::invalid_argument if the recorder has pictures, or if the sample could
  /// not be read back: its time is not after the previous one or is more than a day later, or its pose is ok but not
  /// rigid.
  /// @param actions  what was done since the previous sample (SequenceFrame::actions); one line of printable characters
  void add(const ProbeSample& sample, std::string_view actions = {});

  /// Adds a frame with its greyscale picture, which has the recorder's size. Row 0 is nearest to the probe, and columns
  /// run towards the marker. `probe_from_pixel` maps (column, row, 0), the centre of that pixel, to mm in the probe's
  /// frame. Throws std::invalid_argument if the picture has another size, or as the other add() does.
  void add(const ProbeSample& sample, const Image<std::uint8_t>& picture, const glm::dmat4& probe_from_pixel,
           std::string_view actions = {});

  /// Passes everything that was added to the operating system. Throws InputError if the disk is full.
  void flush();

  /// Makes the file; without a frame it makes none. Call nothing else afterwards. Throws InputError.
  void finish();

  const std::filesystem::path& file() const { return file_; }
  std::size_t frames() const { return frames_; }

private:
  class Pictures;
  void append(const ProbeSample& sample, const glm::dmat4* probe_from_pixel, std::string_view actions);

  std::filesystem::path file_;
  int width_, height_;
  std::unique_ptr<Pictures> pictures_;  ///< null without pictures
  std::unique_ptr<AppendOnlyFile> text_;
  std::string pending_;
  std::size_t frames_ = 0;
  double last_s_ = -std::numeric_limits<double>::infinity();
  bool finished_ = false;
};

}  // namespace insonate
