#include "sim/wein/wein_settings_file.h"

#include "sim/files/files.h"
#include "sim/model/setting_keys.h"

namespace insonate {
namespace {

using namespace keys;

/// All fields of WeinSettings, in their order; the ranges are those of their comments.
const std::vector<Key<WeinSettings>>& all_keys() {
  using W = WeinSettings;
  static const std::vector<Key<W>> all = {
      whole("samples", &W::samples, 1, 8192),
      number("reflection_length_mm", &W::reflection_length_mm, 0.01, 20),
      number("contact_mm", &W::contact_mm, 0, 100),
      number("compression", &W::compression, 0.001, 1e6),
      number("dark_hu", &W::dark_hu, -1000, 3000),
      number("bright_hu", &W::bright_hu, -1000, 3000),
      flag("shadows", &W::shadows),
      number("reflection_share", &W::reflection_share, 0, 1),
      flag("exact_filter", &W::exact_filter),
      whole("similarity_patch", &W::similarity_patch, 0, kMaxPatch),
      whole("image_width", &W::image_width, 1, 8192),
      whole("image_height", &W::image_height, 1, 8192),
  };
  return all;
}

std::optional<std::string> why_no_patch(const WeinSettings& settings) {
  const int patch = settings.similarity_patch;
  if (patch == 0) return std::nullopt;
  const auto along = [&](int pixels) { return std::int64_t((pixels + patch - 1) / patch); };
  if (patch >= kMinPatch && along(settings.image_width) * along(settings.image_height) <= kMaxPatches)
    return std::nullopt;
  return "a patch is " + std::to_string(patch) + " pixels wide, neither 0 nor 4 or more with at most " +
         std::to_string(kMaxPatches) + " of them in the picture";
}

std::optional<std::string> why_no_range(const WeinSettings& settings) {
  if (settings.bright_hu - settings.dark_hu >= kMinHuRange) return std::nullopt;
  return "'bright_hu' is " + in_words(settings.bright_hu) + ", not 1 or more above 'dark_hu', which is " +
         in_words(settings.dark_hu);
}

}  // namespace

WeinSettings read_wein_settings(const std::filesystem::path& toml_file) {
  const TomlDocument document(toml_file.string(), read_file(toml_file, kLargestFile), OnMistake::collect);
  const TomlTable root = document.root();
  WeinSettings settings;
  read_keys(root, all_keys(), settings);
  root.refuse_unknown_keys();
  document.throw_mistakes();
  if (const auto why = why_no_range(settings))
    root.fail(root.has("bright_hu") ? "bright_hu" : "dark_hu", *why, "move them apart");
  if (const auto why = why_no_patch(settings))
    root.fail("similarity_patch", "'similarity_patch': " + *why, "make it larger");
  return settings;
}

std::optional<std::string> why_not_valid(const WeinSettings& settings) {
  const auto why = first_not_valid(all_keys(), settings);
  if (why) return why;
  const auto no_range = why_no_range(settings);
  return no_range ? no_range : why_no_patch(settings);
}

std::vector<std::pair<std::string, SettingValue>> named_settings(const WeinSettings& settings) {
  return named(all_keys(), settings);
}

}  // namespace insonate
