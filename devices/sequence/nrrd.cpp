#include "devices/sequence/nrrd.h"

#include <algorithm>

#include "sim/core/input_error.h"
#include "sim/image_headers/nrrd_header.h"

namespace insonate {
namespace {

constexpr std::string_view kNrrdLayout[] = {"type",   "dimension", "sizes",    "kinds",     "encoding",
                                            "endian", "byte skip", "byteskip", "line skip", "lineskip"};

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

ElementType pixel_type(const HeaderFields& fields, const std::string& file) {
  if (const auto type = nrrd_type(value(fields, "type"))) return *type;
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
  constexpr std::size_t kMin = 18;  // header and trailer
  if (data.size < kMin || !data.front.starts_with("\x1f\x8b")) return false;
  std::uint32_t size = 0;
  for (int i = 0; i < 4; ++i)
    size |= std::uint32_t(std::uint8_t(data.back[data.back.size() - 4 + std::size_t(i)])) << (8 * i);
  return size == std::uint32_t(raw_bytes);
}

}  // namespace

bool is_nrrd_layout_field(std::string_view name) {
  return std::find(std::begin(kNrrdLayout), std::end(kNrrdLayout), name) != std::end(kNrrdLayout);
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
    throw InputError(file, "image data", "it is not a gzip stream of " + std::to_string(raw) + " bytes, or truncated",
                     "copy or record the file again");
  layout.image_bytes = data.size;
  return layout;
}

}  // namespace insonate
