#include "devices/sequence/metaimage.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/image_headers/metaimage_header.h"

namespace insonate {
namespace {

constexpr std::string_view kMetaImageLayout[] = {"ObjectType",
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

// Types that MetaIO does not call numbers; its readers take them as bytes.
constexpr std::string_view kByteTypes[] = {"MET_ASCII_CHAR", "MET_OTHER", "MET_NONE"};

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
    return has(name) ? metaimage_flag(file_, name, value(name)) : otherwise;
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

  ElementType pixel_type() const {
    const std::string_view name = value("ElementType");
    if (!has("ElementType") || std::find(std::begin(kByteTypes), std::end(kByteTypes), name) != std::end(kByteTypes))
      return ElementType::uint8;
    if (const auto type = metaimage_type(name)) return *type;
    fail("ElementType is " + quoted(name) + ", which MetaImage does not know", kExportAgain);
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

bool is_layout_field(std::string_view name) {
  return std::find(std::begin(kMetaImageLayout), std::end(kMetaImageLayout), name) != std::end(kMetaImageLayout);
}

SequenceLayout metaimage_layout(const HeaderFields& fields, std::uint64_t bytes_after, const std::string& file) {
  return Layout(fields, file).read(bytes_after);
}

}  // namespace insonate
