#include "devices/record/recording_files.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "devices/sequence/header_text.h"
#include "devices/sequence/sequence_text.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::string_view kHead = "insonate recording 1 ", kFrameEnd = "frame ";
/// No screen is wider.
constexpr int kLargestPicture = 16384;

/// What of a recording is there as a whole.
struct Whole {
  std::size_t frames = 0;
  std::uint64_t image_bytes = 0;
  std::uint32_t adler = 1;
  std::string lines;  ///< of those frames
};

/// Reads the frames whose lines are all there, and whose pictures lie within `images` bytes.
Whole whole_frames(std::string_view text, std::uint64_t images) {
  Whole whole;
  std::string lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;
    const std::string_view line = text.substr(0, end + 1);
    text.remove_prefix(end + 1);
    if (!line.starts_with(kFrameEnd)) {
      lines += line;
      continue;
    }
    const auto parts = words(line.substr(0, end));
    const auto bytes = parts.size() == 3 ? to_number<std::uint64_t>(parts[1]) : std::nullopt;
    const auto adler = parts.size() == 3 ? to_number<std::uint32_t>(parts[2]) : std::nullopt;
    if (!bytes || !adler || *bytes > images || *bytes < whole.image_bytes) break;
    whole.lines += lines;
    lines.clear();
    whole.image_bytes = *bytes;
    whole.adler = *adler;
    ++whole.frames;
  }
  return whole;
}

/// The last bytes of a zlib stream that is cut where a picture ends: an empty last block, and the checksum.
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
      throw InputError(working.string(), "", "a recording that was not finished has left it behind",
                       "run 'insonate-devices recover " + file.string() + "' or remove it");
}

void remove_working_files(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(working_file(file), error);
  std::filesystem::remove(images_file(file), error);
}

std::size_t recover_recording(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error))
    throw InputError(file.string(), "", "there is such a file already", "move it away");
  const std::filesystem::path working = working_file(file), images = images_file(file);
  const std::string text = read_file(working);
  const std::size_t first = std::min(text.find('\n'), text.size());
  const auto size = words(std::string_view(text).substr(0, first));
  const auto width = size.size() == 5 ? to_number<int>(size[3]) : std::nullopt;
  const auto height = size.size() == 5 ? to_number<int>(size[4]) : std::nullopt;
  const auto is_size = [](std::optional<int> number) { return number && *number >= 0 && *number <= kLargestPicture; };
  if (!text.starts_with(kHead) || first == text.size() || !is_size(width) || !is_size(height))
    throw InputError(working.string(), "line 1", "it is not the working file of a recording", "name the recording");

  const bool with_images = *width > 0 && *height > 0;
  std::uintmax_t image_bytes = with_images ? std::filesystem::file_size(images, error) : 0;
  if (error) image_bytes = 0;
  const Whole whole = whole_frames(std::string_view(text).substr(first + 1), image_bytes);
  if (whole.frames == 0)
    throw InputError(working.string(), "", "it holds no whole frame", "record again, and remove this one");

  const std::string dimensions =
      std::to_string(*width) + " " + std::to_string(*height) + " " + std::to_string(whole.frames);
  const std::string tail = with_images ? stream_end(whole.adler) : "";
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream << sequence_head(dimensions, with_images);
    if (with_images) stream << "CompressedDataSize = " << whole.image_bytes + tail.size() << "\n";
    stream << whole.lines << kSequenceEnd;
    if (with_images) copy(images, whole.image_bytes, stream);
    stream << tail;
    stream.close();
    if (!stream)
      throw InputError(file.string(), "", "it cannot be written", "check the folder's permissions and free space");
  });
  remove_working_files(file);
  return whole.frames;
}

}  // namespace insonate
