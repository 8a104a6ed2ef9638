#include "sim/model/settings_file.h"

#include <limits>

#include "sim/files/files.h"
#include "sim/model/setting_keys.h"

namespace insonate {
namespace {

using namespace keys;

constexpr const char* kPreset = "preset";

/// Returns the keys of all fields of Settings, in their order. The ranges are those that its comments give.
const std::vector<Key<Settings>>& all_keys() {
  using S = Settings;
  static const std::vector<Key<Settings>> all = {
      whole("samples", &S::samples, 1, 8192),
      number("reflection_length_mm", &S::reflection_length_mm, 0.01, 20),
      number("frequency_mhz", &S::frequency_mhz, 0.5, 30),
      flag("edge_shadow", &S::edge_shadow),
      flag("absorption", &S::absorption),
      number("gel_mm", &S::gel_mm, 0, 100),
      flag("exact_filter", &S::exact_filter),
      flag("skipping", &S::skipping),
      choice("beam_window", &S::beam_window, {"box", "triangle", "hann"}),
      whole("beam_lines", &S::beam_lines, 1, 255, true),
      flag("focused_beam", &S::focused_beam),
      number("focus_mm", &S::focus_mm, 5, 400),
      number("f_number", &S::f_number, 0.5, 30),
      whole("slice_planes", &S::slice_planes, 1, 31, true),
      number("slice_thickness_mm", &S::slice_thickness_mm, 0.1, 20),
      number("elevation_focus_mm", &S::elevation_focus_mm, 0, 400),
      flag("reverberation", &S::reverberation),
      number("face_reflection", &S::face_reflection, 0, 1),
      flag("waves", &S::waves),
      number("specular_exponent", &S::specular_exponent, 1, 64),
      number("mirror_image", &S::mirror_image, 0, 1),
      whole("steering_angles", &S::steering_angles, 1, 9, true),
      number("steering_deg", &S::steering_deg, 1, 20),
      flag("speckle", &S::speckle),
      whole("speckle_seed", &S::speckle_seed, 0u, std::numeric_limits<std::uint32_t>::max()),
      number("speckle_cell_mm", &S::speckle_cell_mm, 0.05, 10),
      number("reflection_sigma_mm", &S::reflection_sigma_mm, 0, 1000),
      number("transmission_sigma_mm", &S::transmission_sigma_mm, 0, 1000),
      number("blend", &S::blend, 0, 1000),
      flag("two_way", &S::two_way),
      flag("clutter", &S::clutter),
      number("clutter_db", &S::clutter_db, -100, 0),
      flag("electronic_noise", &S::electronic_noise),
      number("noise_db", &S::noise_db, -200, 0),
      number("ring_down", &S::ring_down, 0, 10),
      number("gain_db", &S::gain_db, -60, 60),
      numbers("tgc_db", &S::tgc_db, -kMaxTimeGain_db, kMaxTimeGain_db),
      number("dynamic_range_db", &S::dynamic_range_db, 1, 200),
      choice("reference_level", &S::reference_level, {"frame_maximum", "fixed"}),
      number("fixed_level", &S::fixed_level, 1e-12, 1e6),
      choice("grey_map", &S::grey_map, {"linear", "soft", "contrast", "s_curve"}),
      number("persistence", &S::persistence, 0, 0.95),
      number("edge_enhancement", &S::edge_enhancement, 0, 4),
      number("speckle_reduction", &S::speckle_reduction, 0, 1),
      whole("image_width", &S::image_width, 1, 8192),
      whole("image_height", &S::image_height, 1, 8192),
  };
  return all;
}

}  // namespace

Settings read_settings(const std::filesystem::path& toml_file, double frequency_mhz, double depth_mm) {
  const TomlDocument document(toml_file.string(), read_file(toml_file, kLargestFile), OnMistake::collect);
  const TomlTable root = document.root();
  const bool is_paper = root.choice(kPreset, {"paper", "trainer"}, 1) == 0;
  Settings written;
  read_keys(root, all_keys(), written);
  root.refuse_unknown_keys();
  document.throw_mistakes();

  if (root.has("frequency_mhz")) frequency_mhz = written.frequency_mhz;
  Settings settings = is_paper ? paper_settings(depth_mm, written.samples) : trainer_settings(frequency_mhz, depth_mm);
  settings.frequency_mhz = frequency_mhz;
  read_keys(root, all_keys(), settings);
  if (const auto why = why_not_valid(settings))  // the paper's reflection length follows from `samples` and the depth
    root.fail(root.has(kPreset) ? kPreset : "", "with this preset " + *why, "give that key a value of its own");
  return settings;
}

std::optional<std::string> why_not_valid(const Settings& settings) {
  return first_not_valid(all_keys(), settings);
}

std::optional<std::string> set_setting(Settings& settings, const std::string& name, const SettingValue& value) {
  return set_named(all_keys(), settings, name, value);
}

std::vector<std::pair<std::string, SettingValue>> named_settings(const Settings& settings) {
  return named(all_keys(), settings);
}

}  // namespace insonate
