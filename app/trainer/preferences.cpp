#include "app/trainer/preferences.h"

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "app/pictures/igtl_feed.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"
#include "sim/files/toml_value.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestFile = 1 << 20;

const std::vector<std::string> kTextSizes{"normal", "large", "largest"}, kLengthUnits{"cm", "mm"},
    kMarkers{"left", "right"}, kTints{"grey", "warm", "cool"}, kBlendColours{"grey", "amber", "green"},
    kCrossHairs{"fan", "face"};

template <typename Word>
Word choice(const TomlTable& table, const char* key, const std::vector<std::string>& words) {
  return Word(table.choice(key, words, 0));
}

}  // namespace

fs::path preferences_file() {
  for (const auto& [variable, folder] : {std::pair{"XDG_CONFIG_HOME", "insonate"}, {"HOME", ".config/insonate"}})
    if (const char* base = std::getenv(variable); base && *base) return fs::path(base) / folder / "settings.toml";
  throw InputError("environment", "", "neither XDG_CONFIG_HOME nor HOME says where to keep settings", "set HOME");
}

bool can_be_kept(const fs::path& path) {
  try {
    return TomlDocument("settings", "path = " + toml_value(path.string())).root().text("path") == path.string();
  } catch (const InputError&) {
    return false;
  }
}

Preferences read_preferences(const fs::path& file) {
  Preferences read;
  std::error_code error;
  if (!fs::exists(file, error)) return read;
  const TomlDocument document(file.string(), read_file(file, kLargestFile));
  const TomlTable table = document.root();
  table.whole_number("format", 1, 1);
  read.look.text_size = choice<TextSize>(table, "text_size", kTextSizes);
  read.look.length_unit = choice<LengthUnit>(table, "lengths", kLengthUnits);
  read.look.marker = choice<MarkerSide>(table, "marker", kMarkers);
  read.look.tint = choice<Tint>(table, "tint", kTints);
  read.look.layout = choice<LayoutName>(table, "layout", {kLayoutNames.begin(), kLayoutNames.end()});
  read.look.landmarks = table.boolean("landmarks", read.look.landmarks);
  // Accepted and not used, so that settings of earlier versions can be read: the grey scale is a patient's.
  table.number("ct_window", {WindowLevel::kMinWindow, WindowLevel::kMaxWindow}, 0);
  table.number("ct_level", {WindowLevel::kMinLevel, WindowLevel::kMaxLevel}, 0);
  read.ct.outlines = table.boolean("ct_outlines", read.ct.outlines);
  read.ct.blend_colour = choice<BlendColour>(table, "blend_colour", kBlendColours);
  read.ct.cross_hair = choice<CrossHair>(table, "cross_hair", kCrossHairs);
  const std::vector<std::string> qualities = quality_names();
  read.quality = qualities[table.choice("quality", qualities, std::size_t(quality_named(read.quality)))];
  read.igtl_server = table.text("igtl_server", "");
  if (!read.igtl_server.empty())
    parse_server_address(read.igtl_server, file.string(),
                         "line " + std::to_string(table.place("igtl_server").line) + ", 'igtl_server'");
  read.out = table.text("out", "");
  read.cases = table.text("cases", "");
  read.results = table.text("results", "");
  const std::vector<std::string> patients = table.texts("patients", 0, Preferences::kMaxPatients);
  read.patients.assign(patients.begin(), patients.end());
  read.network_tracker = table.text("network_tracker", "");
  table.refuse_unknown_keys();
  return read;
}

void write_preferences(const fs::path& file, const Preferences& preferences) {
  std::string text = "# Insonate's settings; the window's page of that name writes them.\nformat = 1\n";
  const auto line = [&](const char* key, const std::string& value) {
    text += std::string(key) + " = " + toml_value(value) + "\n";
  };
  const auto yes_or_no = [](bool yes) { return std::string(yes ? "true" : "false") + "\n"; };
  line("text_size", kTextSizes[std::size_t(preferences.look.text_size)]);
  line("lengths", kLengthUnits[std::size_t(preferences.look.length_unit)]);
  line("marker", kMarkers[std::size_t(preferences.look.marker)]);
  line("tint", kTints[std::size_t(preferences.look.tint)]);
  line("layout", kLayoutNames[std::size_t(preferences.look.layout)]);
  text += "landmarks = " + yes_or_no(preferences.look.landmarks);
  text += "ct_outlines = " + yes_or_no(preferences.ct.outlines);
  line("blend_colour", kBlendColours[std::size_t(preferences.ct.blend_colour)]);
  line("cross_hair", kCrossHairs[std::size_t(preferences.ct.cross_hair)]);
  line("quality", preferences.quality);
  line("igtl_server", preferences.igtl_server);
  line("out", preferences.out.string());
  line("cases", preferences.cases.string());
  line("results", preferences.results.string());
  text +=
      "patients = " + toml_value(std::vector<std::string>(preferences.patients.begin(), preferences.patients.end())) +
      "\n";
  line("network_tracker", preferences.network_tracker);
  write_file(file, text);
}

Options with_preferences(Options options, const Preferences& preferences) {
  if (!options.quality_named) options.quality = preferences.quality;
  if (!options.out_named && !preferences.out.empty()) options.out = preferences.out;
  return options;
}

}  // namespace insonate
