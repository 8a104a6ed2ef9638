#include "devices/sequence/metaimage.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "devices/sequence/header_text.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::string_view kLayoutFields[] = {"ObjectType",
                                              "NDims",
                                              "DimSize",
                                              "Kinds",
                                              "BinaryData",
                                              "BinaryDataByteOrderMSB",
                                              "ElementByteOrderMSB",
                                              "CompressedData",
                                              "CompressedDataSize",
                                              "ElementType",
                                              "ElementNumberOfChannels"};

// Image elements by MetaIO's names (metaTypes.h, where a long has 4 bytes).
constexpr std::pair<std::string_view, PixelType> kTypes[] = {
    {"MET_CHAR", PixelType::int8},         {"MET_UCHAR", PixelType::uint8},   {"MET_ASCII_CHAR", PixelType::int8},
    {"MET_SHORT", PixelType::int16},       {"MET_USHORT", PixelType::uint16}, {"MET_INT", PixelType::int32},
    {"MET_UINT", PixelType::uint32},       {"MET_LONG", PixelType::int32},    {"MET_ULONG", PixelType::uint32},
    {"MET_LONG_LONG", PixelType::int64},   {"MET_FLOAT", PixelType::float32}, {"MET_DOUBLE", PixelType::float64},
    {"MET_ULONG_LONG", PixelType::uint64}, {"MET_OTHER", PixelType::uint8},   {"MET_NONE", PixelType::uint8}};

/// The fields of one header. Error messages name its file.
class Layout {
public:
  Layout(const HeaderFields& fields, const std::string& file) : fields_(fields), file_(file) {}

  SequenceLayout read(std::uint64_t bytes_after) const {
    if (has("ObjectType") && value("ObjectType") != "Image")
      fail("the object is " + quoted(value("ObjectType")) + " instead of an Image",
           "give a sequence file (.igs.mha, .seq.mha or .seq.nrrd)");
    if (!flag("BinaryData", true)) fail("the image data is text", "export the file with BinaryData = True");

    ClaimedImages claimed;
    claimed.sizes_name = "DimSize";
    claimed.sizes_text = value("DimSize");
    claimed.kinds_name = "Kinds";
    claimed.kinds_text = value("Kinds");
    claimed.kinds = words(claimed.kinds_text);
    read_sizes(claimed);
    claimed.type = pixel_type();
    claimed.big_endian = flag("BinaryDataByteOrderMSB", false) || flag("ElementByteOrderMSB", false);
    // If the colours are a dimension of their own, they are not counted as channels too.
    const bool coloured = !claimed.kinds.empty() && same_ignoring_case(claimed.kinds.front(), "vector");
    claimed.channels = coloured ? 1 : channels();
    claimed.compressed = flag("CompressedData", false);
    if (claimed.compressed) claimed.compressed_bytes = compressed_bytes();
    return sequence_layout(claimed, bytes_after, file_);
  }

private:
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw InputError(file_, "header", problem, remedy);
  }

  bool has(std::string_view name) const { return fields_.contains(name); }
  std::string_view value(std::string_view name) const { return has(name) ? fields_.at(name) : std::string_view{}; }

  bool flag(std::string_view name, bool otherwise) const {
    if (!has(name)) return otherwise;
    if (same_ignoring_case(value(name), "True")) return true;
    if (same_ignoring_case(value(name), "False")) return false;
    fail(std::string(name) + " is " + quoted(value(name)) + " instead of True or False", kExportAgain);
  }

  void read_sizes(ClaimedImages& claimed) const {
    bool numbers = true;
    for (const std::string_view word : words(claimed.sizes_text)) {
      const auto size = to_number<std::uint64_t>(word);
      numbers = numbers && size;
      claimed.sizes.push_back(size.value_or(0));
    }
    if (!numbers || claimed.sizes.size() > 5 || !dimensions_agree(to_number<std::size_t>(value("NDims")), claimed))
      fail("NDims is " + quoted(value("NDims")) + " and DimSize " + quoted(value("DimSize")) +
               ", where a sequence has 3 to 5 sizes, one of them its number of frames",
           kExportAgain);
  }

  PixelType pixel_type() const {
    if (!has("ElementType")) return PixelType::uint8;
    for (const auto& [name, type] : kTypes)
      if (name == value("ElementType")) return type;
    fail("ElementType is " + quoted(value("ElementType")) + ", which MetaImage does not know", kExportAgain);
  }

  std::uint64_t channels() const {
    if (!has("ElementNumberOfChannels")) return 1;
    const auto channels = to_number<std::uint64_t>(value("ElementNumberOfChannels"));
    if (!channels || *channels == 0)
      fail("ElementNumberOfChannels is " + quoted(value("ElementNumberOfChannels")) + " instead of 1 or more",
           kExportAgain);
    return *channels;
  }

  std::optional<std::uint64_t> compressed_bytes() const {
    const auto size = to_number<std::uint64_t>(value("CompressedDataSize"));
    if (has("CompressedDataSize") && !size)
      fail("CompressedDataSize is " + quoted(value("CompressedDataSize")) + " instead of a number of bytes",
           kExportAgain);
    return size;
  }

  const HeaderFields& fields_;
  const std::string& file_;
};

}  // namespace

std::size_t read_metaimage_header(
    std::string_view bytes, const std::string& file,
    const std::function<void(std::string_view name, std::string_view value, std::size_t line)>& field) {
  std::size_t line = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const std::string_view text = trimmed(bytes.substr(at, end - at));
    at = std::min(end + 1, bytes.size());
    ++line;
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string_view name = trimmed(text.substr(0, equals));
    if (line == 1 && name != "ObjectType" && name != "NDims")
      throw InputError(file, "line 1", "it names neither ObjectType nor NDims, with which a MetaImage begins",
                       "give a sequence file (.igs.mha, .seq.mha or .seq.nrrd)");
    if (text.empty()) continue;
    const std::string place = "line " + std::to_string(line);
    const bool is_text = std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
    if (name.empty() || equals == text.size() || !is_text)
      throw InputError(file, place, quoted(text) + " is not of the form 'name = value'", kExportAgain);
    const std::string_view value = trimmed(text.substr(equals + 1));
    if (name != "ElementDataFile") {
      field(name, value, line);
      continue;
    }
    if (value != "LOCAL")
      throw InputError(file, place, "the image data is said to lie in " + quoted(value) + " instead of in this file",
                       "save the sequence as one .igs.mha or .seq.mha file");
    return at;
  }
  throw InputError(file, "header", "it ends without the line 'ElementDataFile = LOCAL': the file is truncated",
                   "copy or record it again");
}

bool is_layout_field(std::string_view name) {
  return std::find(std::begin(kLayoutFields), std::end(kLayoutFields), name) != std::end(kLayoutFields);
}

SequenceLayout metaimage_layout(const HeaderFields& fields, std::uint64_t bytes_after, const std::string& file) {
  return Layout(fields, file).read(bytes_after);
}

}  // namespace insonate
