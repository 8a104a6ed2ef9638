// Format: https://itk.org/Wiki/ITK/MetaIO/Documentation.
#include "sim/image_headers/metaimage_header.h"

#include <utility>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

// MetaIO's names (metaTypes.h). A long has 4 bytes on every machine.
constexpr std::pair<std::string_view, ElementType> kMetaTypes[] = {
    {"MET_CHAR", ElementType::int8},         {"MET_UCHAR", ElementType::uint8},   {"MET_SHORT", ElementType::int16},
    {"MET_USHORT", ElementType::uint16},     {"MET_INT", ElementType::int32},     {"MET_UINT", ElementType::uint32},
    {"MET_LONG", ElementType::int32},        {"MET_ULONG", ElementType::uint32},  {"MET_LONG_LONG", ElementType::int64},
    {"MET_ULONG_LONG", ElementType::uint64}, {"MET_FLOAT", ElementType::float32}, {"MET_DOUBLE", ElementType::float64}};

}  // namespace

std::size_t read_metaimage_header(std::string_view bytes, const std::string& file, const std::string& right_file,
                                  const TakeField& field) {
  HeaderLines lines(bytes, file);
  for (bool begun = false; lines.next();) {
    if (lines.text().empty()) continue;
    if (!begun && lines.text().find('=') == std::string_view::npos)
      lines.refuse("this is not a MetaImage file: it begins with " + quoted(lines.text()), right_file);
    begun = true;
    const std::string_view name = lines.name('=', "'name = value'");
    field(name, trimmed(lines.text().substr(lines.text().find('=') + 1)), lines.number());
    if (name == "ElementDataFile") return lines.end();
  }
  throw InputError(file, "header", "the header does not end: the line 'ElementDataFile = ...' is missing",
                   "copy the file again, or check that it is the right file");
}

bool metaimage_flag(const std::string& file, std::string_view name, std::string_view value) {
  if (same_ignoring_case(value, "True")) return true;
  if (same_ignoring_case(value, "False")) return false;
  throw InputError(file, "header", std::string(name) + " is " + quoted(value) + " instead of True or False",
                   "correct it, or export the file again");
}

std::optional<ElementType> metaimage_type(std::string_view name) {
  for (const auto& [known, type] : kMetaTypes)
    if (known == name) return type;
  return std::nullopt;
}

}  // namespace insonate
