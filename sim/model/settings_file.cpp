#include "sim/model/settings_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/toml_table.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestFile = 1u << 20;
constexpr const char* kPreset = "preset";
const std::vector<std::string> kPresets = {"paper", "trainer"};

/// A setting as files and messages know it.
struct Key {
  std::string name;
  std::string wanted;  ///< "a whole number from 1 to 8192"
  std::function<SettingValue(const Settings&)> get;
  std::function<void(Settings&, const SettingValue&)> set;  ///< of a value that is allowed
  std::function<bool(const SettingValue&)> allowed;         ///< of a value of the right kind
};

std::string with_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string from_to(double least, double most) {
  return "from " + with_number(least) + " to " + with_number(most);
}

Key flag(const char* name, bool Settings::*member) {
  return {name, "true or false", [=](const Settings& s) { return s.*member; },
          [=](Settings& s, const SettingValue& value) { s.*member = std::get<bool>(value); },
          [](const SettingValue&) { return true; }};
}

template <typename Integer>
Key whole(const char* name, Integer Settings::*member, Integer least, Integer most, bool odd = false) {
  // Written out: %g would round the largest.
  const std::string range = "from " + std::to_string(least) + " to " + std::to_string(most);
  return {name, (odd ? "an odd number " : "a whole number ") + range,
          [=](const Settings& s) { return std::int64_t(s.*member); },
          [=](Settings& s, const SettingValue& value) { s.*member = Integer(std::get<std::int64_t>(value)); },
          [=](const SettingValue& value) {
            const std::int64_t n = std::get<std::int64_t>(value);
            return n >= std::int64_t(least) && n <= std::int64_t(most) && (!odd || n % 2 != 0);
          }};
}

Key number(const char* name, double Settings::*member, double least, double most) {
  return {name, "a number " + from_to(least, most), [=](const Settings& s) { return s.*member; },
          [=](Settings& s, const SettingValue& value) { s.*member = std::get<double>(value); },
          [=](const SettingValue& value) {
            const double x = std::get<double>(value);
            return x >= least && x <= most;  // not so for NaN
          }};
}

template <std::size_t N>
Key numbers(const char* name, std::array<double, N> Settings::*member, double least, double most) {
  return {name, "a list of " + std::to_string(N) + " numbers " + from_to(least, most),
          [=](const Settings& s) { return std::vector<double>((s.*member).begin(), (s.*member).end()); },
          [=](Settings& s, const SettingValue& value) {
            std::copy_n(std::get<std::vector<double>>(value).begin(), N, (s.*member).begin());
          },
          [=](const SettingValue& value) {
            const auto& list = std::get<std::vector<double>>(value);
            return list.size() == N &&
                   std::all_of(list.begin(), list.end(), [&](double x) { return x >= least && x <= most; });
          }};
}

/// @param names  of the enumerators, in their order
template <typename Enum>
Key choice(const char* name, Enum Settings::*member, const std::vector<std::string>& names) {
  std::string wanted;
  for (std::size_t i = 0; i < names.size(); ++i)
    wanted += (i == 0 ? "'" : i + 1 == names.size() ? " or '" : ", '") + names[i] + "'";
  return {name, wanted,
          [=](const Settings& s) {
            const std::size_t index = std::size_t(s.*member);
            return index < names.size() ? names[index] : "number " + std::to_string(index);
          },
          [=](Settings& s, const SettingValue& value) {
            s.*member = Enum(std::find(names.begin(), names.end(), std::get<std::string>(value)) - names.begin());
          },
          [=](const SettingValue& value) {
            return std::find(names.begin(), names.end(), std::get<std::string>(value)) != names.end();
          }};
}

/// Every field of Settings, in its order; the ranges are those that its comments give.
const std::vector<Key>& keys() {
  using S = Settings;
  static const std::vector<Key> all = {
      whole("samples", &S::samples, 1, 8192),
      number("reflection_length_mm", &S::reflection_length_mm, 0.01, 20),
      number("frequency_mhz", &S::frequency_mhz, 0.5, 30),
      flag("absorption", &S::absorption),
      number("gel_mm", &S::gel_mm, 0, 100),
      flag("skipping", &S::skipping),
      choice("beam_window", &S::beam_window, {"box", "triangle", "hann"}),
      whole("beam_lines", &S::beam_lines, 1, 255, true),
      flag("focused_beam", &S::focused_beam),
      number("focus_mm", &S::focus_mm, 5, 400),
      number("f_number", &S::f_number, 0.5, 30),
      whole("slice_planes", &S::slice_planes, 1, 31, true),
      number("slice_thickness_mm", &S::slice_thickness_mm, 0.1, 20),
      flag("reverberation", &S::reverberation),
      number("face_reflection", &S::face_reflection, 0, 1),
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
      number("gain_db", &S::gain_db, -60, 60),
      numbers("tgc_db", &S::tgc_db, -kMostTimeGainDb, kMostTimeGainDb),
      number("dynamic_range_db", &S::dynamic_range_db, 1, 200),
      choice("reference_level", &S::reference_level, {"frame_maximum", "fixed"}),
      number("fixed_level", &S::fixed_level, 1e-12, 1e6),
      choice("grey_map", &S::grey_map, {"linear", "soft", "contrast", "s_curve"}),
      whole("image_width", &S::image_width, 1, 8192),
      whole("image_height", &S::image_height, 1, 8192),
  };
  return all;
}

std::string in_quotes(const std::string& text) {
  return "'" + text + "'";
}

std::string in_words(const SettingValue& value) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t n) const { return std::to_string(n); }
    std::string operator()(double x) const { return with_number(x); }
    std::string operator()(const std::string& text) const { return in_quotes(text); }
    std::string operator()(const std::vector<double>& list) const {
      std::string text;
      for (double x : list) text += (text.empty() ? "[" : ", ") + with_number(x);
      return text.empty() ? "[]" : text + "]";
    }
  } words;
  return std::visit(words, value);
}

/// What a TOML value is as a value of the kind that `kind` shows; empty when it is of another.
std::optional<SettingValue> value_of(const toml::node& node, const SettingValue& kind) {
  if (std::holds_alternative<bool>(kind)) {
    if (const auto* b = node.as_boolean()) return b->get();
  } else if (std::holds_alternative<std::int64_t>(kind)) {
    if (const auto* n = node.as_integer()) return n->get();
  } else if (std::holds_alternative<double>(kind)) {
    if (node.is_number()) return *node.value<double>();
  } else if (std::holds_alternative<std::string>(kind)) {
    if (const auto* text = node.as_string()) return text->get();
  } else if (const toml::array* array = node.as_array()) {
    std::vector<double> list;
    for (const toml::node& element : *array) {
      if (!element.is_number()) return std::nullopt;
      list.push_back(*element.value<double>());
    }
    return list;
  }
  return std::nullopt;
}

/// Notes what is wrong instead of stopping there.
class Problems {
public:
  template <typename Check>
  void note(Check&& check) {
    try {
      check();
    } catch (const InputError& error) {
      sentences_ += (sentences_.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  void throw_any() const {
    if (!sentences_.empty()) throw InputError(sentences_);
  }

private:
  std::string sentences_;
};

}  // namespace

Settings read_settings(const std::filesystem::path& toml_file, double frequency_mhz, double depth_mm) {
  const toml::table parsed = parse_toml(toml_file.string(), read_file(toml_file, kLargestFile));
  const TomlTable root(toml_file.string(), "", parsed);
  Problems problems;

  std::vector<std::string> known{kPreset};
  for (const Key& key : keys()) known.push_back(key.name);
  for (const std::string& name : root.keys())
    if (std::find(known.begin(), known.end(), name) == known.end())
      problems.note([&] { root.fail(name, "the key " + in_quotes(name) + " is unknown here", suggest(name, known)); });

  std::string preset = "trainer";
  if (root.has(kPreset))
    problems.note([&] {
      preset = root.text(kPreset);
      if (std::find(kPresets.begin(), kPresets.end(), preset) == kPresets.end())
        root.fail(kPreset, "there is no preset " + in_quotes(preset), suggest(preset, kPresets));
    });

  Settings written;  // what the file says; the rest is a default
  for (const Key& key : keys()) {
    if (!root.has(key.name)) continue;
    problems.note([&] {
      const auto value = value_of(*parsed.get(key.name), key.get(written));
      if (!value) root.fail(key.name, in_quotes(key.name) + " is of another kind", "give " + key.wanted);
      if (!key.allowed(*value))
        root.fail(key.name, in_quotes(key.name) + " is " + in_words(*value), "give " + key.wanted);
      key.set(written, *value);
    });
  }
  problems.throw_any();

  if (root.has("frequency_mhz")) frequency_mhz = written.frequency_mhz;
  Settings settings =
      preset == "paper" ? paper_settings(depth_mm, written.samples) : trainer_settings(frequency_mhz, depth_mm);
  settings.frequency_mhz = frequency_mhz;
  for (const Key& key : keys())
    if (root.has(key.name)) key.set(settings, key.get(written));
  if (const auto why = why_not_valid(settings))  // the paper's reflection length, of so many samples over such a depth
    root.fail(root.has(kPreset) ? kPreset : "", "with this preset " + *why, "give that key a value of its own");
  return settings;
}

std::optional<std::string> why_not_valid(const Settings& settings) {
  for (const Key& key : keys())
    if (const SettingValue value = key.get(settings); !key.allowed(value))
      return in_quotes(key.name) + " is " + in_words(value) + ", not " + key.wanted;
  return std::nullopt;
}

std::vector<std::pair<std::string, SettingValue>> named_settings(const Settings& settings) {
  std::vector<std::pair<std::string, SettingValue>> all;
  for (const Key& key : keys()) all.emplace_back(key.name, key.get(settings));
  return all;
}

}  // namespace insonate
