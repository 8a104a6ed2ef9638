#include "devices/record/sequence_recorder.h"

#include <zlib.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "devices/record/recording_files.h"
#include "devices/sequence/sequence_text.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {

/// The zlib stream of the pictures. Each picture ends on a whole byte, so that the stream can be cut after it.
class SequenceRecorder::Pictures {
public:
  Pictures(const std::filesystem::path& file, std::string when_full) : file_(file, std::move(when_full)) {
    // The fastest level, because the pictures are compressed during the run.
    if (deflateInit(&stream_, Z_BEST_SPEED) != Z_OK) throw std::runtime_error("zlib cannot be set up");
  }
  ~Pictures() { deflateEnd(&stream_); }

  void add(const Image<std::uint8_t>& picture) {
    stream_.next_in = const_cast<Bytef*>(picture.pixels.data());  // zlib only reads them
    stream_.avail_in = uInt(picture.pixels.size());
    do {
      stream_.next_out = buffer_.data();
      stream_.avail_out = uInt(buffer_.size());
      deflate(&stream_, Z_SYNC_FLUSH);
      pending_.append(reinterpret_cast<const char*>(buffer_.data()), buffer_.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

  void flush() {
    file_.append(pending_);
    pending_.clear();
  }

  std::uint64_t bytes() const { return file_.size() + pending_.size(); }
  unsigned long adler() const { return stream_.adler; }

private:
  AppendOnlyFile file_;
  z_stream stream_{};
  std::vector<Bytef> buffer_ = std::vector<Bytef>(1 << 16);
  std::string pending_;
};

SequenceRecorder::SequenceRecorder(std::filesystem::path file, int width, int height)
    : file_(std::move(file)), width_(width), height_(height) {
  if (!file_.string().ends_with(".mha"))
    throw InputError(file_.string(), "", "a recording is a sequence file, and its name does not end in .igs.mha",
                     "name it as in 'scan.igs.mha'");
  refuse_existing(file_);
  const std::string when_full =
      "make room on the disk and run insonate-devices recover " + shell_word(file_.string()) + " to keep what is whole";
  text_ = std::make_unique<AppendOnlyFile>(working_file(file_), when_full);
  text_->append(working_head(width_, height_));
  if (width_ > 0 && height_ > 0) pictures_ = std::make_unique<Pictures>(images_file(file_), when_full);
}

SequenceRecorder::~SequenceRecorder() {
  try {
    finish();
  } catch (const std::exception&) {
    // The working files stay and can be recovered.
  }
}

void SequenceRecorder::append(const ProbeSample& sample, const glm::dmat4* probe_from_pixel, std::string_view actions) {
  append_frame(pending_, frames_, sample, probe_from_pixel, actions);
  pending_ += frame_end(pictures_ ? pictures_->bytes() : 0, pictures_ ? pictures_->adler() : 0);
  last_s_ = sample.time_s;
  ++frames_;
}

void SequenceRecorder::add(const ProbeSample& sample, std::string_view actions) {
  if (pictures_) throw std::invalid_argument("each frame of this recording has a picture");
  if (const std::string why = why_not_recordable(sample, last_s_); !why.empty()) throw std::invalid_argument(why);
  append(sample, nullptr, actions);
}

void SequenceRecorder::add(const ProbeSample& sample, const Image<std::uint8_t>& picture,
                           const glm::dmat4& probe_from_pixel, std::string_view actions) {
  if (!pictures_ || picture.width != width_ || picture.height != height_)
    throw std::invalid_argument("the picture is not of the recording's size");
  if (const std::string why = why_not_recordable(sample, last_s_); !why.empty()) throw std::invalid_argument(why);
  pictures_->add(picture);
  append(sample, &probe_from_pixel, actions);
}

void SequenceRecorder::flush() {
  // The pictures come first, because a frame's line states that its picture is present.
  if (pictures_) pictures_->flush();
  text_->append(pending_);
  pending_.clear();
}

void SequenceRecorder::finish() {
  if (std::exchange(finished_, true)) return;
  flush();
  pictures_.reset();
  text_.reset();
  if (frames_ > 0)
    recover_recording(file_);
  else
    remove_working_files(file_);
}

}  // namespace insonate
