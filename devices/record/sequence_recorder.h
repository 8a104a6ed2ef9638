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
#include "sim/core/pose_sample.h"

namespace insonate {

/// Writes a sequence file as a run goes on, so that a crash loses next to nothing.
///
/// A sequence file says at its beginning how many frames it has and has its pictures at its end, so it cannot just
/// grow. What grows is a working file beside it, `FILE.recording`, and with pictures `FILE.recording.images`; both are
/// only ever appended to, and what flush() has returned from is the operating system's to keep, whatever becomes of the
/// program (a power cut is another matter: nothing is forced to the disk). finish() makes FILE of them and removes
/// them. After a crash recover_recording() (recording_files.h) does the same, up to the last frame that is there as a
/// whole.
///
/// The working file is text: a line `insonate recording 1 WIDTH HEIGHT`, and for each frame its lines of the sequence
/// file followed by `frame BYTES ADLER`: how many bytes of the other file reach to the end of this frame's picture, and
/// the Adler-32 of all pictures up to there. The other file is a zlib stream, brought to a byte's end behind every
/// picture; so it may be cut at any of those places and closed with that Adler-32.
///
/// Not thread-safe.
class SequenceRecorder {
public:
  /// Makes the working files. With a picture's width and height each frame has a picture; with 0 none has.
  /// Throws InputError when `file` does not end in ".mha", when it or its working file is there already, and when the
  /// working file cannot be written.
  explicit SequenceRecorder(std::filesystem::path file, int width = 0, int height = 0);
  /// Finishes if that has not been done; if it fails, the working files stay.
  ~SequenceRecorder();
  SequenceRecorder(const SequenceRecorder&) = delete;
  SequenceRecorder& operator=(const SequenceRecorder&) = delete;

  /// A frame without a picture. Throws std::invalid_argument when nobody could read the sample back: its time is not
  /// after the one before, or its pose is ok but not rigid.
  /// @param actions  what was done since the sample before (SequenceFrame::actions); one line of printable characters
  void add(const PoseSample& sample, std::string_view actions = {});

  /// A frame with its picture of the recorder's size, grey, row 0 nearest to the probe and the columns towards the
  /// marker. `probe_from_pixel` takes (column, row, 0), which is that pixel's centre, to mm in the probe's frame.
  void add(const PoseSample& sample, const Image<std::uint8_t>& picture, const glm::dmat4& probe_from_pixel,
           std::string_view actions = {});

  /// Hands what was added over to the operating system. Throws InputError when the disk is full.
  void flush();

  /// Makes the file; without a frame there is none. Call nothing else afterwards. Throws InputError.
  void finish();

  const std::filesystem::path& file() const { return file_; }
  std::size_t frames() const { return frames_; }

private:
  class Pictures;
  void append(const PoseSample& sample, const glm::dmat4* probe_from_pixel, std::string_view actions);

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
