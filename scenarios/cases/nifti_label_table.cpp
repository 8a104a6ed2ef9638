#include "scenarios/cases/nifti_label_table.h"

#include <pugixml.hpp>

#include <charconv>
#include <string_view>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/volume/nifti_volume.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& problem) {
  throw InputError(file.string(), "label table in the header", problem,
                   "write the file again, or name its labels with --label-table");
}

LabelNames parse_table(const fs::path& file, const std::string& xml) {
  pugi::xml_document document;
  if (const pugi::xml_parse_result result = document.load_buffer(xml.data(), xml.size()); !result)
    refuse(file, std::string("it is not well-formed XML (") + result.description() + ")");
  LabelNames names;
  for (const pugi::xml_node label :
       document.child("CaretExtension").child("VolumeInformation").child("LabelTable").children("Label")) {
    const std::string_view key = label.attribute("Key").value();
    int value = -1;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), value);
    if (error != std::errc() || end != key.data() + key.size() || value < 0 || value > 255)
      refuse(file, "it names the value '" + std::string(key) + "', which is not a whole number from 0 to 255");
    if (value == 0) continue;
    const std::string name(trimmed(label.child_value()));
    if (name.empty()) refuse(file, "the value " + std::to_string(value) + " has no name");
    if (!names.emplace(value, name).second) refuse(file, "it names the value " + std::to_string(value) + " twice");
  }
  return names;
}

}  // namespace

LabelNames read_nifti_label_table(const fs::path& file) {
  for (const std::string& extension : read_nifti_extensions(file)) {
    // TotalSegmentator leaves the extension's code at 0, "unknown", so that only the text identifies it.
    if (extension.find("<LabelTable") == std::string::npos) continue;
    return parse_table(file, extension.substr(0, extension.find('\0')));
  }
  return {};
}

}  // namespace insonate
