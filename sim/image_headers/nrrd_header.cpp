// Format: https://teem.sourceforge.net/nrrd/format.html.
#include "sim/image_headers/nrrd_header.h"

#include <utility>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

// All names that the format defines.
constexpr std::pair<std::string_view, ElementType> kTypes[] = {
    {"signed char", ElementType::int8},
    {"int8", ElementType::int8},
    {"int8_t", ElementType::int8},
    {"uchar", ElementType::uint8},
    {"unsigned char", ElementType::uint8},
    {"uint8", ElementType::uint8},
    {"uint8_t", ElementType::uint8},
    {"short", ElementType::int16},
    {"short int", ElementType::int16},
    {"signed short", ElementType::int16},
    {"signed short int", ElementType::int16},
    {"int16", ElementType::int16},
    {"int16_t", ElementType::int16},
    {"ushort", ElementType::uint16},
    {"unsigned short", ElementType::uint16},
    {"unsigned short int", ElementType::uint16},
    {"uint16", ElementType::uint16},
    {"uint16_t", ElementType::uint16},
    {"int", ElementType::int32},
    {"signed int", ElementType::int32},
    {"int32", ElementType::int32},
    {"int32_t", ElementType::int32},
    {"uint", ElementType::uint32},
    {"unsigned int", ElementType::uint32},
    {"uint32", ElementType::uint32},
    {"uint32_t", ElementType::uint32},
    {"longlong", ElementType::int64},
    {"long long", ElementType::int64},
    {"long long int", ElementType::int64},
    {"signed long long", ElementType::int64},
    {"signed long long int", ElementType::int64},
    {"int64", ElementType::int64},
    {"int64_t", ElementType::int64},
    {"ulonglong", ElementType::uint64},
    {"unsigned long long", ElementType::uint64},
    {"unsigned long long int", ElementType::uint64},
    {"uint64", ElementType::uint64},
    {"uint64_t", ElementType::uint64},
    {"float", ElementType::float32},
    {"double", ElementType::float64},
};

// "NRRD00.01" is the name of version 1 in files before 2004.
bool is_version(std::string_view magic) {
  return magic == "NRRD00.01" ||
         (magic.size() == 8 && magic.starts_with("NRRD000") && magic[7] >= '1' && magic[7] <= '5');
}

}  // namespace

bool is_nrrd(std::string_view bytes) {
  return bytes.starts_with("NRRD");
}

std::size_t read_nrrd_header(std::string_view bytes, const std::string& file, const std::string& right_file,
                             const TakeField& field, const TakeField& key) {
  HeaderLines lines(bytes, file);
  if (!lines.next() || !is_version(lines.text()))
    throw InputError(file, "line 1",
                     "this is not an NRRD file of version 1 to 5: it begins with " + quoted(lines.text()), right_file);
  bool detached = false;
  while (lines.next()) {
    if (lines.text().empty()) return lines.end();
    if (lines.text().front() == '#') continue;
    const std::string_view name = lines.name(':', "'name: value' or 'key:=value'");
    const std::string_view rest = lines.text().substr(lines.text().find(':') + 1);
    if (rest.starts_with('=')) {
      key(name, trimmed(rest.substr(1)), lines.number());
      continue;
    }
    detached = detached || is_nrrd_data_file(name);
    field(name, trimmed(rest), lines.number());
  }
  if (detached) return bytes.size();
  throw InputError(file, "header", "the header does not end: the empty line behind it is missing",
                   "copy the file again, or check that it is the right file");
}

bool is_nrrd_data_file(std::string_view name) {
  return same_ignoring_case(name, "data file") || same_ignoring_case(name, "datafile");
}

std::optional<ElementType> nrrd_type(std::string_view name) {
  for (const auto& [known, type] : kTypes)
    if (same_ignoring_case(known, name)) return type;
  return std::nullopt;
}

}  // namespace insonate
