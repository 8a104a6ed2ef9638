#include "devices/sequence/nrrd.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::string_view kMagic = "NRRD000";
constexpr std::string_view kLayoutFields[] = {"type",   "dimension", "sizes",    "kinds",     "encoding",
                                              "endian", "byte skip", "byteskip", "line skip", "lineskip"};

// Elements by all names that the format defines (teem.sourceforge.net/nrrd/format.html).
constexpr std::pair<std::string_view, PixelType> kTypes[] = {
    {"signed char", PixelType::int8},
    {"int8", PixelType::int8},
    {"int8_t", PixelType::int8},
    {"uchar", PixelType::uint8},
    {"unsigned char", PixelType::uint8},
    {"uint8", PixelType::uint8},
    {"uint8_t", PixelType::uint8},
    {"short", PixelType::int16},
    {"short int", PixelType::int16},
    {"signed short", PixelType::int16},
    {"signed short int", PixelType::int16},
    {"int16", PixelType::int16},
    {"int16_t", PixelType::int16},
    {"ushort", PixelType::uint16},
    {"unsigned short", PixelType::uint16},
    {"unsigned short int", PixelType::uint16},
    {"uint16", PixelType::uint16},
    {"uint16_t", PixelType::uint16},
    {"int", PixelType::int32},
    {"signed int", PixelType::int32},
    {"int32", PixelType::int32},
    {"int32_t", PixelType::int32},
    {"uint", PixelType::uint32},
    {"unsigned int", PixelType::uint32},
    {"uint32", PixelType::uint32},
    {"uint32_t", PixelType::uint32},
    {"longlong", PixelType::int64},
    {"long long", PixelType::int64},
    {"long long int", PixelType::int64},
    {"signed long long", PixelType::int64},
    {"signed long long int", PixelType::int64},
    {"int64", PixelType::int64},
    {"int64_t", PixelType::int64},
    {"ulonglong", PixelType::uint64},
    {"unsigned long long", PixelType::uint64},
    {"unsigned long long int", PixelType::uint64},
    {"uint64", PixelType::uint64},
    {"uint64_t", PixelType::uint64},
    {"float", PixelType::float32},
    {"double", PixelType::float64},
};

[[noreturn]] void fail(const std::string& file, const std::string& problem, const std::string& remedy = kExportAgain) {
  throw InputError(file, "header", problem, remedy);
}

std::string_view value(const HeaderFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string_view{} : found->second;
}

void read_sizes(const HeaderFields& fields, ClaimedImages& claimed, const std::string& file) {
  bool numbers = true;
  for (const std::string_view word : words(claimed.sizes_text)) {
    const auto size = to_number<std::uint64_t>(word);
    numbers = numbers && size;
    claimed.sizes.push_back(size.value_or(0));
  }
  // Columns and rows, optionally slices and colours, and the frames.
  if (!numbers || claimed.sizes.size() > 5 ||
      !dimensions_agree(to_number<std::size_t>(value(fields, "dimension")), claimed))
    fail(file, "dimension is " + quoted(value(fields, "dimension")) + " and sizes " + quoted(value(fields, "sizes")) +
                   ", where a sequence has 3 to 5 sizes, one of them its number of frames");
}

PixelType pixel_type(const HeaderFields& fields, const std::string& file) {
  for (const auto& [name, type] : kTypes)
    if (same_ignoring_case(name, value(fields, "type"))) return type;
  fail(file, "type is " + quoted(value(fields, "type")) + ", which NRRD does not know");
}

bool is_compressed(const HeaderFields& fields, const std::string& file) {
  const std::string_view encoding = value(fields, "encoding");
  if (same_ignoring_case(encoding, "raw")) return false;
  if (same_ignoring_case(encoding, "gzip") || same_ignoring_case(encoding, "gz")) return true;
  fail(file, "encoding is " + quoted(encoding) + ", which is not read", "save the sequence as gzip or raw");
}

/// Returns whether the bytes begin like gzip and end with the size of their content (RFC 1952: modulo 2^32).
bool is_whole_gzip(const CutBytes& data, std::uint64_t raw_bytes) {
  constexpr std::size_t kLeast = 18;  // header and trailer
  if (data.size < kLeast || !data.front.starts_with("\x1f\x8b")) return false;
  std::uint32_t size = 0;
  for (int i = 0; i < 4; ++i)
    size |= std::uint32_t(std::uint8_t(data.back[data.back.size() - 4 + std::size_t(i)])) << (8 * i);
  return size == std::uint32_t(raw_bytes);
}

}  // namespace

bool is_nrrd(std::string_view bytes) {
  return bytes.starts_with("NRRD");
}

std::size_t read_nrrd_header(std::string_view bytes, const std::string& file, const HeaderLine& field,
                             const HeaderLine& key) {
  std::size_t line = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string_view::npos) break;
    const std::string_view text = trimmed(bytes.substr(at, end - at));
    at = end + 1;
    ++line;
    const std::string place = "line " + std::to_string(line);
    if (line == 1) {
      if (!text.starts_with(kMagic) || text.size() != kMagic.size() + 1 || text.back() < '1' || text.back() > '5')
        throw InputError(file, place, quoted(text) + " is no NRRD version from NRRD0001 to NRRD0005", kExportAgain);
      continue;
    }
    if (text.empty()) return at;
    if (text.front() == '#') continue;
    const std::size_t colon = text.find(':');
    const std::string_view name = trimmed(text.substr(0, std::min(colon, text.size())));
    const bool is_text = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
    if (colon == std::string_view::npos || name.empty() || !is_text)
      throw InputError(file, place, quoted(text) + " is not of the form 'name: value' or 'key:=value'", kExportAgain);
    const bool is_key = text.substr(colon).starts_with(":=");
    const std::string_view value = trimmed(text.substr(colon + (is_key ? 2 : 1)));
    if (!is_key && (same_ignoring_case(name, "data file") || same_ignoring_case(name, "datafile")))
      throw InputError(file, place, "the image data is said to lie in " + quoted(value) + " instead of in this file",
                       "save the sequence as one .seq.nrrd file");
    (is_key ? key : field)(name, value, line);
  }
  throw InputError(file, "header", "it ends without the empty line behind it: the file is truncated",
                   "copy or record it again");
}

bool is_nrrd_layout_field(std::string_view name) {
  return std::find(std::begin(kLayoutFields), std::end(kLayoutFields), name) != std::end(kLayoutFields);
}

SequenceLayout nrrd_layout(const HeaderFields& fields, const CutBytes& data, const std::string& file) {
  for (const std::string_view skip : {"byte skip", "byteskip", "line skip", "lineskip"})
    if (fields.contains(skip) && value(fields, skip) != "0")
      fail(file, std::string(skip) + " is " + quoted(value(fields, skip)) + ", which is not read");
  ClaimedImages claimed;
  claimed.kinds_name = "kinds";
  claimed.kinds_text = value(fields, "kinds");
  claimed.kinds = words(claimed.kinds_text);
  claimed.sizes_name = "sizes";
  claimed.sizes_text = value(fields, "sizes");
  read_sizes(fields, claimed, file);
  claimed.type = pixel_type(fields, file);
  claimed.big_endian = same_ignoring_case(value(fields, "endian"), "big");
  claimed.compressed = is_compressed(fields, file);
  SequenceLayout layout = sequence_layout(claimed, data.size, file);
  if (!claimed.compressed || !layout.has_images) return layout;

  std::uint64_t raw = bytes_of(claimed.type);
  for (const std::uint64_t size : claimed.sizes) raw *= size;
  if (!is_whole_gzip(data, raw))
    throw InputError(file, "image data", "it is no gzip stream of " + std::to_string(raw) + " bytes, or truncated",
                     "copy or record the file again");
  layout.image_bytes = data.size;
  return layout;
}

}  // namespace insonate
