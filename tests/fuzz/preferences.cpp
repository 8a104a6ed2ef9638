// The settings file of a person.
#include "app/trainer/preferences.h"

#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target preferences_target("preferences", [](std::string_view bytes) -> std::string {
  const Preferences preferences = read_preferences(file_with("settings.toml", bytes));
  const WindowLevel& grey = preferences.ct.grey;
  if (!(grey.window_hu >= WindowLevel::kMinWindow && grey.window_hu <= WindowLevel::kMaxWindow) ||
      !(grey.level_hu >= WindowLevel::kMinLevel && grey.level_hu <= WindowLevel::kMaxLevel))
    return "a grey scale is out of range";
  quality_named(preferences.quality);
  const std::filesystem::path again = file_with("again.toml", "");
  write_preferences(again, preferences);
  return read_preferences(again) == preferences ? "" : "written and read again they are others";
});

}  // namespace
}  // namespace insonate::fuzz
