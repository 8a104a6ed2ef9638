// Format: https://teem.sourceforge.net/nrrd/format.html.
#include "sim/image_headers/nrrd_header.h"

#include <array>
#include <utility>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

// All names that the format defines.
constexpr std::pair<ElementType, std::array<std::string_view, 7>> kNrrdTypes[] = {
    {ElementType::int8, {"signed char", "int8", "int8_t"}},
    {ElementType::uint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
    {ElementType::int16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
    {ElementType::uint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
    {ElementType::int32, {"int", "signed int", "int32", "int32_t"}},
    {ElementType::uint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
    {ElementType::int64,
     {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"}},
    {ElementType::uint64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
    {ElementType::float32, {"float"}},
    {ElementType::float64, {"double"}},
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
  for (const auto& [type, all] : kNrrdTypes)
    for (const std::string_view known : all)
      if (!known.empty() && same_ignoring_case(known, name)) return type;
  return std::nullopt;
}

}  // namespace insonate
