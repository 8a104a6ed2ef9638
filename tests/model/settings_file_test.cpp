#include "sim/model/settings_file.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/wein/wein_settings_file.h"

using namespace insonate;

namespace {

struct SettingsFile {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("insonate_settings_" + std::to_string(getpid()) + ".toml");
  explicit SettingsFile(const std::string& text) { write_file(path, text); }
  ~SettingsFile() { std::filesystem::remove(path); }
};

constexpr double kFrequency = 4, kDepth = 120;

Settings read(const std::string& text) {
  return read_settings(SettingsFile(text).path, kFrequency, kDepth);
}

WeinSettings read_wein(const std::string& text) {
  return read_wein_settings(SettingsFile(text).path);
}

template <typename Read>
std::string why_refused(const std::string& text, Read&& read_text) {
  try {
    read_text(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// As many fields as can be given a value of their own in braces.
struct AnyField {
  template <typename T>
  operator T() const;
};
template <typename T, typename... Fields>
constexpr std::size_t fields_of() {
  if constexpr (requires { T{Fields{}..., AnyField{}}; })
    return fields_of<T, Fields..., AnyField>();
  else
    return sizeof...(Fields);
}

std::string with_all_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string as_toml(const SettingValue& value) {
  struct {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t n) const { return std::to_string(n); }
    std::string operator()(double x) const { return with_all_digits(x); }
    std::string operator()(const std::string& text) const { return "'" + text + "'"; }
    std::string operator()(const std::vector<double>& list) const {
      std::string text = "[";
      for (double x : list) text += with_all_digits(x) + ", ";
      return text + "]";
    }
  } words;
  return std::visit(words, value);
}

}  // namespace

TEST_CASE("every field of Settings is a key of settings files") {
  CHECK(named_settings(Settings{}).size() == fields_of<Settings>());
}

TEST_CASE("a settings file is a preset and what is written over it") {
  CHECK(named_settings(read("preset = 'trainer'")) == named_settings(trainer_settings(kFrequency, kDepth)));
  CHECK(named_settings(read("# nothing")) == named_settings(trainer_settings(kFrequency, kDepth)));

  // The preset is that of the file's own samples and frequency, whichever line they are on.
  Settings paper = paper_settings(kDepth, 300);
  paper.frequency_mhz = 2.5;
  CHECK(named_settings(read("frequency_mhz = 2.5\npreset = 'paper'\nsamples = 300")) == named_settings(paper));
  CHECK(named_settings(read("frequency_mhz = 2")) == named_settings(trainer_settings(2, kDepth)));

  const Settings own = read(
      "preset = 'paper'\nreflection_length_mm = 0.5\nbeam_window = 'triangle'\nspeckle = false\nspeckle_seed = "
      "4294967295\n"
      "tgc_db = [0, 1, 2, 3, 4, 5, 6, 7.5]\nreference_level = 'fixed'\ngain_db = 3");
  CHECK(own.reflection_length_mm == 0.5);
  CHECK(own.beam_window == BeamWindow::triangle);
  CHECK_FALSE(own.speckle);
  CHECK(own.speckle_seed == 4294967295u);
  CHECK(own.tgc_db == std::array<double, 8>{0, 1, 2, 3, 4, 5, 6, 7.5});
  CHECK(own.reference_level == ReferenceLevel::fixed);
  CHECK(own.gain_db == 3);
  CHECK_FALSE(own.absorption);
}

TEST_CASE("each effect beyond the paper is off in the paper's own mode and on in the trainer") {
  const Settings paper = paper_settings(kDepth, 300), trainer = trainer_settings(kFrequency, kDepth);
  using S = Settings;
  for (const auto effect : {&S::absorption, &S::two_way, &S::focused_beam, &S::reverberation, &S::edge_shadow,
                            &S::clutter, &S::electronic_noise}) {
    CHECK_FALSE(paper.*effect);
    CHECK(trainer.*effect);
  }
  for (const auto amount : {&S::gel_mm, &S::face_reflection, &S::mirror_image}) {
    CHECK(paper.*amount == 0);
    CHECK(trainer.*amount > 0);
  }
  CHECK(paper.slice_planes == 1);
  CHECK(trainer.slice_planes > 1);
  CHECK(paper.reference_level == ReferenceLevel::frame_maximum);
  CHECK(trainer.reference_level == ReferenceLevel::fixed);
  CHECK(paper.tgc_db == std::array<double, 8>{});
  CHECK(trainer.tgc_db.back() == Approx(2 * 0.5 * kFrequency * kDepth / 10));
  CHECK(paper.reflection_length_mm == kDepth / 300);  // l = dr
  // The user's own, at rest in both.
  CHECK(paper.gain_db == 0);
  CHECK(trainer.gain_db == 0);
  CHECK(paper.grey_map == GreyMap::linear);
  CHECK(trainer.grey_map == GreyMap::linear);
  // Off unless a machine's knobs ask for them.
  for (const Settings& settings : {paper, trainer}) {
    CHECK(settings.steering_angles == 1);
    CHECK(settings.persistence == 0);
    CHECK(settings.edge_enhancement == 0);
    CHECK(settings.speckle_reduction == 0);
    CHECK(settings.ring_down == 0);
  }
  CHECK(with_usual_display(trainer).ring_down == kUsualRingDown);
}

TEST_CASE("what settings hold reads back as it was") {
  Settings settings = trainer_settings(5, 90);
  settings.beam_window = BeamWindow::box;
  settings.reference_level = ReferenceLevel::frame_maximum;
  settings.two_way = false;
  settings.fixed_level = 0.25;
  settings.blend = 0.5;
  std::string text;
  for (const auto& [name, value] : named_settings(settings)) text += name + " = " + as_toml(value) + "\n";
  INFO(text);
  CHECK(named_settings(read(text)) == named_settings(settings));
}

TEST_CASE("a settings file that cannot be used is refused with every place and reason") {
  const struct {
    std::string text, place, problem;
  } cases[] = {
      {"samples = \n", "line 1, column", "not TOML"},
      {"\nsample = 3\n", "line 2, column 1", "did you mean 'samples'?"},
      {"preset = 'papper'\n", "line 1, column 10", "did you mean 'paper'?"},
      {"preset = 3\n", "line 1", "'preset' is not a text"},
      {"samples = 0\n", "line 1, column 11", "'samples' is 0; give a whole number from 1 to 8192."},
      {"samples = 9999999999999\n", "line 1", "'samples' is 9999999999999"},
      {"samples = 3.5\n", "line 1", "'samples' is not a whole number; give a whole number"},
      {"speckle_seed = -1\n", "line 1", "give a whole number from 0 to 4294967295"},
      {"beam_lines = 4\n", "line 1", "'beam_lines' is 4; give an odd number from 1 to 255"},
      {"absorption = 1\n", "line 1", "'absorption' is neither true nor false"},
      {"frequency_mhz = 'high'\n", "line 1", "give a number from 0.5 to 30"},
      {"frequency_mhz = nan\n", "line 1", "'frequency_mhz' is nan"},
      {"gain_db = inf\n", "line 1", "'gain_db' is inf"},
      {"beam_window = 'Hann'\n", "line 1", "'beam_window' is 'Hann'; did you mean 'hann'?"},
      {"tgc_db = [1, 2]\n", "line 1", "'tgc_db' has 2 numbers; write 8 numbers from -300 to 300 in square brackets"},
      {"tgc_db = [0, 0, 0, 0, 0, 0, 0, 301]\n", "line 1", "'tgc_db' holds 301; write 8 numbers"},
      {"tgc_db = [0, 0, 0, 0, 0, 0, 0, 'a']\n", "line 1, column 32", "something that is not a number"},
      {"preset = 'paper'\nsamples = 2\n", "line 1, column 10", "with this preset 'reflection_length_mm' is 60, not a"},
      // all at once
      {"sampels = 3\nblend = 1\nblend_ = 2\ngain_db = 99\n", "line 1", "line 3, column 1: the key 'blend_' is unknown"},
      {"sampels = 3\nblend = 1\nblend_ = 2\ngain_db = 99\n", "line 4, column 11", "'gain_db' is 99"},
  };
  for (const auto& bad : cases) {
    const std::string why = why_refused(bad.text, [](const std::string& text) { return read(text); });
    INFO(bad.text << " -> " << why);
    CHECK(why.find(bad.place) != std::string::npos);
    CHECK(why.find(bad.problem) != std::string::npos);
  }
}

TEST_CASE("of a file that is wrong throughout a hundred places are reported") {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "key" + std::to_string(i) + " = 1\n";
  for (const std::string& said :
       {why_refused(text, [](const std::string& t) { read(t); }), why_refused(text, read_wein)})
    CHECK(std::count(said.begin(), said.end(), '\n') == 101);
}

TEST_CASE("settings that no file could hold are reported by name") {
  CHECK_FALSE(why_not_valid(Settings{}));
  CHECK_FALSE(why_not_valid(paper_settings(160, 512)));
  CHECK_FALSE(why_not_valid(trainer_settings(30, 400)));  // whose absorption no gain makes up for
  Settings settings;
  settings.samples = 0;
  CHECK(why_not_valid(settings) == "'samples' is 0, not a whole number from 1 to 8192");
  settings = {};
  settings.reflection_sigma_mm = std::numeric_limits<double>::quiet_NaN();
  CHECK(why_not_valid(settings) == "'reflection_sigma_mm' is nan, not a number from 0 to 1000");
  settings = {};
  settings.beam_window = BeamWindow(7);
  CHECK(why_not_valid(settings) == "'beam_window' is 'number 7', not 'box', 'triangle' or 'hann'");
  settings = {};
  settings.tgc_db[3] = 1e9;
  CHECK(why_not_valid(settings).value_or("").find("'tgc_db' is [0, 0, 0, 1000000000") == 0);
}

TEST_CASE("every setting can be set by its name, and keeps its value if the new one cannot be used") {
  // Each differs between the two.
  Settings from = trainer_settings(kFrequency, kDepth), to = paper_settings(kDepth, 300);
  from.speckle_seed = 7;
  for (const auto& [name, value] : named_settings(from)) {
    CAPTURE(name);
    CHECK_FALSE(set_setting(to, name, value));
  }
  CHECK(to == from);
  CHECK_FALSE(set_setting(to, "gain_db", std::int64_t(3)));
  CHECK(to.gain_db == 3);

  const Settings before = to;
  CHECK(set_setting(to, "gain_db", 61.0) == "'gain_db' is 61, not a number from -60 to 60");
  CHECK(set_setting(to, "gain_db", true) == "'gain_db' is true, not a number from -60 to 60");
  CHECK(set_setting(to, "samples", 100.0) == "'samples' is 100, not a whole number from 1 to 8192");
  CHECK(set_setting(to, "beam_lines", std::int64_t(4)) == "'beam_lines' is 4, not an odd number from 1 to 255");
  CHECK(set_setting(to, "grey_map", std::string("soggy")) ==
        "'grey_map' is 'soggy', not 'linear', 'soft', 'contrast' or 's_curve'");
  CHECK(set_setting(to, "tgc_db", std::vector<double>{1, 2}) ==
        "'tgc_db' is [1, 2], not a list of 8 numbers from -300 to 300");
  CHECK_THROWS_AS(set_setting(to, "gian_db", 1.0), std::invalid_argument);
  CHECK(to == before);
}

TEST_CASE("model W's settings: every field is a key, and what is not written stays as it is") {
  CHECK(named_settings(WeinSettings{}).size() == fields_of<WeinSettings>());
  CHECK(named_settings(read_wein("# nothing")) == named_settings(WeinSettings{}));
  const WeinSettings own = read_wein("samples = 300\ndark_hu = -20\nshadows = false\nreflection_share = 0.25");
  CHECK(own.samples == 300);
  CHECK(own.dark_hu == -20);
  CHECK_FALSE(own.shadows);
  CHECK(own.reflection_share == 0.25);
  CHECK(own.bright_hu == WeinSettings{}.bright_hu);
  std::string text;
  for (const auto& [name, value] : named_settings(own)) text += name + " = " + as_toml(value) + "\n";
  CHECK(named_settings(read_wein(text)) == named_settings(own));
}

TEST_CASE("model W's settings that cannot be used are refused with place and reason") {
  const struct {
    std::string text, place, problem;
  } cases[] = {
      {"\ngel_mm = 3\n", "line 2, column 1", "the key 'gel_mm' is unknown here"},  // which is model S's
      {"contact_mm = -1\n", "line 1, column 14", "'contact_mm' is -1; give a number from 0 to 100"},
      {"compression = 0\n", "line 1", "'compression' is 0; give a number from 0.001 to 1000000"},
      {"samples = 2.5\n", "line 1", "'samples' is not a whole number; give a whole number"},
      {"dark_hu = 149.5\n", "line 1, column 11", "'bright_hu' is 150, not 1 or more above 'dark_hu', which is 149.5"},
      {"dark_hu = 20\nbright_hu = 20\n", "line 2, column 13", "'bright_hu' is 20, not 1 or more above 'dark_hu'"},
      {"image_width = 0\nshadows = 1\n", "line 2", "'shadows' is neither true nor false"},
      {"similarity_patch = 3\n", "line 1, column 20",
       "'similarity_patch': a patch is 3 pixels wide, neither 0 nor 4 or more"},
      {"similarity_patch = 4\nimage_width = 640\nimage_height = 480\n", "line 1, column 20",
       "at most 5376 of them in the picture"},
  };
  for (const auto& bad : cases) {
    const std::string why = why_refused(bad.text, read_wein);
    INFO(bad.text << " -> " << why);
    CHECK(why.find(bad.place) != std::string::npos);
    CHECK(why.find(bad.problem) != std::string::npos);
  }
  CHECK_FALSE(why_not_valid(WeinSettings{}));
  WeinSettings settings;
  settings.reflection_share = std::numeric_limits<double>::quiet_NaN();
  CHECK(why_not_valid(settings) == "'reflection_share' is nan, not a number from 0 to 1");
  settings = {};
  settings.dark_hu = 200;
  CHECK(why_not_valid(settings) == "'bright_hu' is 150, not 1 or more above 'dark_hu', which is 200");
}
