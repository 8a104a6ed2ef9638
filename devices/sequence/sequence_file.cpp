#include "devices/sequence/sequence_file.h"

#include <algorithm>
#include <fstream>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/image_headers/nrrd_header.h"

namespace insonate {
namespace {

constexpr std::size_t kReadAtOnce = 1 << 16;
/// Bytes of the images that show whether a compressed stream is complete: its magic number at the front, its size at
/// the end.
constexpr std::size_t kEnds = 64;

/// Finds the end of a header that arrives in pieces.
class HeaderEnd {
public:
  /// Returns whether the header ends in `text`; examines only new lines.
  bool is_in(const std::string& text) {
    for (std::size_t end; !found_ && (end = text.find('\n', at_)) != std::string::npos; at_ = end + 1) {
      const std::string_view line = trimmed(std::string_view(text).substr(at_, end - at_));
      const std::string_view name = trimmed(line.substr(0, std::min(line.find('='), line.size())));
      found_ = is_nrrd(text) ? line.empty() : name == "ElementDataFile";
    }
    return found_;
  }
  std::size_t offset() const { return at_; }

private:
  std::size_t at_ = 0;
  bool found_ = false;
};

}  // namespace

SequenceFile read_sequence_file(const std::filesystem::path& file, std::size_t most_header) {
  check_is_file(file);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string(), "", "it cannot be read", "check its permissions");
  SequenceFile read;
  Digest digest;
  HeaderEnd end;
  std::vector<char> buffer(kReadAtOnce);
  while (stream.read(buffer.data(), kReadAtOnce), stream.gcount() > 0) {
    const std::string_view piece(buffer.data(), std::size_t(stream.gcount()));
    digest.add(piece);
    read.size += piece.size();
    if (!end.is_in(read.front)) {
      if (read.front.size() > most_header)
        throw InputError(file.string(), "header", "it does not end within " + std::to_string(most_header) + " bytes",
                         "check that it is the right file");
      read.front += piece;
    } else if (const std::size_t needed = end.offset() + kEnds; read.front.size() < needed) {
      read.front += piece.substr(0, needed - read.front.size());
    }
    read.back.append(piece.substr(piece.size() - std::min(piece.size(), kEnds)));
    if (read.back.size() > kEnds) read.back.erase(0, read.back.size() - kEnds);
  }
  if (stream.bad()) throw InputError(file.string(), "", "it cannot be read to its end", "copy it again");
  read.digest = digest.text();
  return read;
}

}  // namespace insonate
