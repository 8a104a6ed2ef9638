#include "devices/record/recording_files.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "devices/record/append_only.h"
#include "devices/sequence/sequence_text.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/image_headers/header_text.h"

namespace insonate {
namespace {

constexpr std::string_view kHead = "insonate recording 1 ", kFrameEnd = "frame ";
/// No screen is wider.
constexpr int kLargestPicture = 16384;

/// Longer than any line of a recording: a frame's line has 16 numbers.
constexpr std::size_t kLongestLine = 4096;

/// Reads the lines of a working file one by one, because the file may be larger than the memory.
class Lines {
public:
  explicit Lines(const std::filesystem::path& file) : stream_(file, std::ios::binary), buffer_(kLongestLine) {}

  /// Returns false if there is no further complete line.
  bool next() {
    stream_.getline(buffer_.data(), std::streamsize(buffer_.size()));
    if (!stream_ || stream_.eof()) return false;
    line_ = std::string_view(buffer_.data(), std::size_t(stream_.gcount()) - 1);
    return true;
  }
  std::string_view line() const { return line_; }

private:
  std::ifstream stream_;
  std::vector<char> buffer_;
  std::string_view line_;
};

/// Content of the first line: the size of a picture.
struct Head {
  int width = 0, height = 0;
  bool with_images() const { return width > 0 && height > 0; }
};

/// Throws InputError if the file does not begin like a working file.
Head read_head(Lines& lines, const std::filesystem::path& working) {
  const bool any = lines.next();
  const auto parts = words(any ? lines.line() : std::string_view());
  const auto width = parts.size() == 5 ? to_number<int>(parts[3]) : std::nullopt;
  const auto height = parts.size() == 5 ? to_number<int>(parts[4]) : std::nullopt;
  const auto is_size = [](std::optional<int> number) { return number && *number >= 0 && *number <= kLargestPicture; };
  if (!any || !lines.line().starts_with(kHead) || !is_size(width) || !is_size(height))
    throw InputError(working.string(), "line 1", "it is not the working file of a recording", "name the recording");
  return {*width, *height};
}

/// The complete part of a recording.
struct Whole {
  std::size_t frames = 0, lines = 0;  ///< `lines` counts the frames' lines, including their end lines
  std::uint64_t image_bytes = 0;
  std::uint32_t adler = 1;
};

/// Counts the frames whose lines are all present and whose pictures lie within the first `images` bytes.
Whole whole_frames(Lines& lines, std::uint64_t images) {
  Whole whole;
  for (std::size_t count = 1; lines.next(); ++count) {
    if (!lines.line().starts_with(kFrameEnd)) continue;
    const auto parts = words(lines.line());
    const auto bytes = parts.size() == 3 ? to_number<std::uint64_t>(parts[1]) : std::nullopt;
    const auto adler = parts.size() == 3 ? to_number<std::uint32_t>(parts[2]) : std::nullopt;
    if (!bytes || !adler || *bytes > images || *bytes < whole.image_bytes) break;
    whole = {whole.frames + 1, count, *bytes, *adler};
  }
  return whole;
}

/// Copies the lines that whole_frames() counted, without the frames' end lines.
void copy_lines(const std::filesystem::path& working, std::size_t count, std::ofstream& to) {
  Lines lines(working);
  bool there = lines.next();
  for (std::size_t i = 0; i < count && (there = there && lines.next()); ++i)
    if (!lines.line().starts_with(kFrameEnd)) to << lines.line() << '\n';
  if (!there)
    throw InputError(working.string(), "", "it cannot be read again, or has changed meanwhile",
                     "close other programs, and try again");
}

/// Returns the last bytes of a zlib stream that is cut at the end of a picture: an empty last block, and the checksum.
std::string stream_end(std::uint32_t adler) {
  std::string end("\x01\x00\x00\xff\xff", 5);
  for (int shift = 24; shift >= 0; shift -= 8) end += char(adler >> shift & 0xff);
  return end;
}

void copy(const std::filesystem::path& from, std::uint64_t bytes, std::ofstream& to) {
  std::ifstream stream(from, std::ios::binary);
  std::array<char, 1 << 16> part;
  while (bytes > 0 && stream) {
    stream.read(part.data(), std::streamsize(std::min<std::uint64_t>(part.size(), bytes)));
    to.write(part.data(), stream.gcount());
    bytes -= std::uint64_t(stream.gcount());
  }
  if (bytes > 0) throw InputError(from.string(), "", "it cannot be read", "check its permissions");
}

/// Returns whether the file is not being written. A killed program still holds it for a moment until it has ended, so
/// this waits for up to 1 s.
bool let_go(const std::filesystem::path& working) {
  constexpr std::chrono::milliseconds kPatience(1000), kPause(20);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (is_being_written(working)) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(kPause);
  }
  return true;
}

struct TemporaryFile {
  std::filesystem::path path;
  explicit TemporaryFile(std::filesystem::path file) : path(std::move(file)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// Returns whether a file begins with the bytes of another, or, unless `may_go_on`, has exactly the same bytes.
bool begins_with(const std::filesystem::path& file, const std::filesystem::path& beginning, bool may_go_on) {
  std::error_code error;
  if (!may_go_on && std::filesystem::file_size(file, error) != std::filesystem::file_size(beginning, error))
    return false;
  std::ifstream whole(file, std::ios::binary), first(beginning, std::ios::binary);
  std::array<char, 1 << 16> a, b;
  do {
    first.read(b.data(), std::streamsize(b.size()));
    whole.read(a.data(), first.gcount());
    if (whole.gcount() != first.gcount() || !std::equal(b.data(), b.data() + first.gcount(), a.data())) return false;
  } while (first);
  return first.eof();
}

std::filesystem::path with_ending(const std::filesystem::path& file, const char* ending) {
  std::filesystem::path named = file;
  return named += ending;
}

}  // namespace

std::filesystem::path working_file(const std::filesystem::path& file) {
  return with_ending(file, ".recording");
}

std::filesystem::path images_file(const std::filesystem::path& file) {
  return with_ending(file, ".recording.images");
}

std::string working_head(int width, int height) {
  return std::string(kHead) + std::to_string(width) + " " + std::to_string(height) + "\n";
}

std::string frame_end(std::uint64_t image_bytes, unsigned long adler) {
  return std::string(kFrameEnd) + std::to_string(image_bytes) + " " + std::to_string(adler) + "\n";
}

void refuse_existing(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error))
    throw InputError(file.string(), "", "there is such a file already", "name another, or move that one away");
  for (const std::filesystem::path& working : {working_file(file), images_file(file)})
    if (std::filesystem::exists(working, error))
      throw is_being_written(working)
          ? InputError(working.string(), "", "another recording is under way to it", "name another file")
          : InputError(working.string(), "", "a recording that was not finished has left it behind",
                       "run insonate-devices recover " + shell_word(file.string()) + " or remove it");
}

void remove_working_files(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(images_file(file), error);
  std::filesystem::remove(working_file(file), error);
}

std::size_t recover_recording(const std::filesystem::path& file) {
  std::error_code error;
  const bool is_there = std::filesystem::exists(file, error);
  const auto refuse_file = [&] { throw InputError(file.string(), "", "there is such a file already", "move it away"); };
  const std::filesystem::path working = working_file(file), images = images_file(file);
  if (is_there && !std::filesystem::exists(working, error)) refuse_file();
  check_is_file(working);
  if (!let_go(working))
    throw InputError(working.string(), "", "it is still being recorded to", "end the recording, which makes its file");
  Lines lines(working);
  const Head head = read_head(lines, working);
  const bool with_images = head.with_images();
  // The images file is removed first. So beside a finished file, a working file may have lost its images.
  const bool without_its_images = is_there && with_images && !std::filesystem::exists(images, error);
  std::uintmax_t image_bytes = with_images ? std::filesystem::file_size(images, error) : 0;
  if (without_its_images)
    image_bytes = std::numeric_limits<std::uintmax_t>::max();
  else if (error)
    image_bytes = 0;
  const Whole whole = whole_frames(lines, image_bytes);
  if (whole.frames == 0)
    throw InputError(working.string(), "", "it holds no whole frame", "record again, and remove this one");

  const std::string dimensions =
      std::to_string(head.width) + " " + std::to_string(head.height) + " " + std::to_string(whole.frames);
  const std::string tail = with_images ? stream_end(whole.adler) : "";
  const auto write = [&](const std::filesystem::path& temporary) {
    errno = 0;
    std::ofstream stream(temporary, std::ios::binary);
    stream << sequence_head(dimensions, with_images);
    if (with_images) stream << "CompressedDataSize = " << whole.image_bytes + tail.size() << "\n";
    copy_lines(working, whole.lines, stream);
    stream << kSequenceEnd;
    if (with_images && !without_its_images) copy(images, whole.image_bytes, stream);
    if (!without_its_images) stream << tail;
    stream.close();
    const std::string why = errno == 0 ? "" : std::string(" (") + std::strerror(errno) + ")";
    if (!stream)
      throw InputError(file.string(), "", "it cannot be written" + why,
                       "check the folder's permissions and free space");
  };
  if (is_there) {
    const TemporaryFile again(temporary_beside(file));
    write(again.path);
    if (!begins_with(file, again.path, without_its_images)) refuse_file();
  } else {
    write_atomically(file, write);
  }
  remove_working_files(file);
  return whole.frames;
}

}  // namespace insonate
