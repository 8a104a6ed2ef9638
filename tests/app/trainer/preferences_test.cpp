// What a person sets once: kept in a file, taken where the command line is silent, refused where it makes no sense.
#include "app/trainer/preferences.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

Preferences unusual() {
  Preferences preferences;
  preferences.look = {TextSize::largest, LengthUnit::mm, MarkerSide::right, Tint::cool, LayoutName::four, true};
  preferences.ct = {{}, false, BlendColour::green, CrossHair::face};
  preferences.quality = "exact";
  preferences.igtl_server = "0.0.0.0:18950";
  preferences.out = "/srv/a \"quoted\" place/\u00e4";
  preferences.cases = "/srv/cases";
  preferences.results = "/srv/lab.db";
  preferences.patients = {"/srv/a \"quoted\" CT.nii.gz", "/srv/cases/7"};
  preferences.network_tracker = "igtl://plus:18944/ProbeToReference";
  return preferences;
}

}  // namespace

TEST_CASE("preferences are read as they were written, and without a file they are the defaults") {
  const TemporaryFolder folder;
  const auto file = folder.path / "new" / "settings.toml";
  CHECK(read_preferences(file) == Preferences());
  write_preferences(file, unusual());
  CHECK(read_preferences(file) == unusual());
  write_preferences(file, Preferences());
  CHECK(read_preferences(file) == Preferences());
}

TEST_CASE("a grey scale that an earlier version kept is read, and is not used") {
  const TemporaryFolder folder;
  const auto file = folder.path / "settings.toml";
  write_file(file, "format = 1\nct_window = 1500\nct_level = -600\n");
  CHECK(read_preferences(file) == Preferences());
}

TEST_CASE("a path is kept only if the file of preferences can hold it") {
  CHECK(can_be_kept("/srv/\u00e4 \"quoted\"\n\\ CT.nii"));
  CHECK_FALSE(can_be_kept("/srv/\xe4.nii"));  // Latin-1
}

TEST_CASE("a file of preferences that cannot be used is refused with its place, one key at a time") {
  const TemporaryFolder folder;
  const auto file = folder.path / "settings.toml";
  const auto refusal = [&](const std::string& text) -> std::string {
    write_file(file, text);
    try {
      read_preferences(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  CHECK(refusal("format = 1\n") == "taken");
  CHECK_THAT(refusal("text_size = \"large\"\n"), Catch::Contains("format"));
  CHECK_THAT(refusal("format = 2\n"), Catch::Contains("line 1"));
  CHECK_THAT(refusal("format = 1\nmarker = \"up\"\n"), Catch::Contains("line 2") && Catch::Contains("left"));
  CHECK_THAT(refusal("format = 1\nquality = \"best\"\n"), Catch::Contains("balanced"));
  CHECK_THAT(refusal("format = 1\nigtl_server = \"here\"\n"),
             Catch::StartsWith(file.string() + ": line 2, 'igtl_server': 'here' has no port"));
  CHECK_THAT(refusal("format = 1\ntint_ = \"warm\"\n"), Catch::Contains("tint"));
  CHECK_THAT(refusal("format = 1\nlayout = \"five\"\n"), Catch::Contains("slices"));
  CHECK_THAT(refusal("format = 1\nct_window = 0\n"), Catch::Contains("line 2") && Catch::Contains("4000"));
  CHECK_THAT(refusal("format = \n"), Catch::Contains("line 1"));
}

TEST_CASE("the command line comes before the preferences") {
  const Preferences preferences = unusual();
  const Options silent = with_preferences(Options(), preferences);
  CHECK(silent.quality == "exact");
  CHECK(silent.out == preferences.out);
  CLI::App arguments;
  Options named;
  declare(arguments, named);
  arguments.parse("practice --quality balanced --out out");  // the defaults, but named
  const Options kept = with_preferences(named, preferences);
  CHECK(kept.quality == "balanced");
  CHECK(kept.out == "out");
  CHECK(with_preferences(Options(), Preferences()).out == Options().out);
}

TEST_CASE("preferences are kept in the user's folder of settings") {
  const char* const set = std::getenv("XDG_CONFIG_HOME");
  const std::string before = set ? set : "";
  setenv("XDG_CONFIG_HOME", "/some/where", 1);
  CHECK(preferences_file() == "/some/where/insonate/settings.toml");
  unsetenv("XDG_CONFIG_HOME");
  const std::string home = std::getenv("HOME");
  CHECK(preferences_file() == std::filesystem::path(home) / ".config/insonate/settings.toml");
  unsetenv("HOME");
  CHECK_THROWS_WITH(preferences_file(), Catch::Contains("neither XDG_CONFIG_HOME nor HOME says where to keep"));
  setenv("HOME", home.c_str(), 1);
  if (set) setenv("XDG_CONFIG_HOME", before.c_str(), 1);
}
