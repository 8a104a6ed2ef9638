#include <algorithm>
#include <limits>
#include <set>

#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/phantom/phantom.h"
#include "tools/dataset/setting_ranges.h"
#include "tools/dataset/study.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestFile = 1u << 20;
constexpr std::size_t kMaxTables = 1000;
constexpr NumberRange kWeight{1e-6, 1e6};

/// Reads one number, or the least and the most in square brackets.
NumberRange read_range(const TomlTable& table, std::string_view key, const NumberRange& limits,
                       const NumberRange& otherwise) {
  if (table.kind(key) == TomlKind::list) return table.interval(key, limits).value_or(otherwise);
  if (!table.has(key)) return otherwise;
  const double only = table.number(key, limits, otherwise.least);
  return {only, only};
}

PhantomOption read_phantom_option(const TomlTable& table, const std::string& name) {
  PhantomOption option;
  option.name = name;
  switch (table.kind(name)) {
    case TomlKind::boolean:
      option.choices = {table.boolean(name) ? "true" : "false"};
      break;
    case TomlKind::text: {
      const std::string text = table.text(name, "");
      option.choices = text == kEither ? std::vector<std::string>{"true", "false"} : std::vector<std::string>{text};
      break;
    }
    case TomlKind::list:
      option.range = table.interval(name, {});
      break;
    case TomlKind::number: {
      const double number = table.number(name);
      option.choices = {exact_text(number)};
      break;
    }
    default:
      table.report(name, in_quotes(name) + " is neither true, false, \"either\", a number nor a range",
                   "write one of these");
  }
  return option;
}

/// Reports an option that the recipe does not have, and values that it does not take, at both ends of a range.
void check_phantom_option(const TomlTable& options, const PhantomOption& option) {
  std::vector<std::string> values = option.choices;
  if (option.range) values = {exact_text(option.range->least), exact_text(option.range->most)};
  std::vector<std::pair<std::string, std::string>> given;
  for (const std::string& value : values) given.emplace_back(option.name, value);
  const std::string recipe = built_in_recipe().string();
  for (const OptionProblem& wrong : problems_with_options(recipe, read_file(recipe), given))
    options.report(option.name, in_quotes(wrong.option) + ": " + wrong.problem, wrong.remedy);
}

StudyCase read_case_of_study(const TomlTable& table, const std::filesystem::path& folder) {
  StudyCase subject;
  const std::string source = table.text("case", std::string(kBuiltIn));
  subject.place = table.place("case");
  const bool built_in = source == kBuiltIn;
  subject.given = source;
  subject.source = built_in ? source : (folder / source).lexically_normal().string();
  subject.name = table.text("name", source);
  subject.weight = table.number("weight", kWeight, 1);
  if (built_in) {
    subject.licence = table.text("licence", "Apache-2.0, made by Insonate");
  } else {
    subject.licence = table.text("licence");
    std::error_code error;
    if (!std::filesystem::exists(subject.source, error))
      table.report("case", "the case " + in_quotes(source) + " is not there",
                   "name a case folder, a CT or a DICOM folder by its path from this file, or \"abdomen\"");
  }
  subject.patients = std::uint32_t(table.whole_number("patients", 1, 10000, 1));
  if (table.has("phantom")) {
    const TomlTable options = table.table("phantom");
    if (!built_in)
      table.report("phantom", "only the built-in patient has options", "remove them, or take case = \"abdomen\"");
    for (const std::string& name : options.keys()) {
      subject.options.push_back(read_phantom_option(options, name));
      if (built_in) check_phantom_option(options, subject.options.back());
    }
  }
  const bool varies = std::any_of(subject.options.begin(), subject.options.end(), [](const PhantomOption& option) {
    return option.range || option.choices.size() > 1;
  });
  if (subject.patients > 1 && !built_in)
    table.report("patients", "only the built-in patient can be drawn several times", "remove this key");
  else if (subject.patients > 1 && !varies)
    table.report("patients", "several patients would all be the same one",
                 "give an option under 'phantom' a range or \"either\", or ask for one patient");
  return subject;
}

StudyProbe read_probe_of_study(const TomlTable& table) {
  StudyProbe read;
  read.probe = probes()[table.choice("name", probe_names())];
  read.weight = table.number("weight", kWeight, 1);
  read.probe.lines = int(table.whole_number("lines", 16, 4096, read.probe.lines));
  const auto stepped = [&](const char* key, const char* step_key, const NumberRange& limits, double usual,
                           double usual_step) {
    return SteppedRange{read_range(table, key, limits, {usual, usual}),
                        table.number(step_key, {0, limits.most}, usual_step)};
  };
  read.depth_mm = stepped("depth_mm", "depth_step_mm", {10, 400}, read.probe.depth_mm, 10);
  read.frequency_mhz = stepped("frequency_mhz", "frequency_step_mhz", {0.5, 30}, read.probe.frequency_mhz, 0.5);
  return read;
}

StudyPoses read_poses_of_study(const TomlTable& table, const std::filesystem::path& folder) {
  StudyPoses poses;
  poses.place = table.place("kind");
  poses.kind = PoseKind(table.choice("kind", {"skin", "view", "log"}));
  poses.weight = table.number("weight", kWeight, 1);
  // An empty list would mean the same as none, which is not what it says.
  const auto names = [&](const char* key) { return table.texts(key, table.has(key) ? 1 : 0); };
  poses.cases = names("cases");
  poses.probes = names("probes");
  const NumberRange half_turn{-180, 180}, most_tilt{-80, 80};
  const bool on_skin = poses.kind == PoseKind::skin;
  const NumberRange usual_tilt = on_skin ? NumberRange{-20, 20} : NumberRange{0, 0};
  poses.tilt_deg = read_range(table, "tilt_deg", most_tilt, usual_tilt);
  poses.rock_deg = read_range(table, "rock_deg", most_tilt, usual_tilt);
  poses.turn_deg = read_range(table, "turn_deg", half_turn, on_skin ? half_turn : NumberRange{0, 0});
  poses.press_mm = read_range(table, "press_mm", {-20, 50}, on_skin ? NumberRange{3, 10} : NumberRange{0, 0});
  poses.slide_mm = table.number("slide_mm", {0, 100}, 0);
  if (on_skin) {
    poses.around_deg = read_range(table, "around_deg", half_turn, half_turn);
    poses.height_percent = read_range(table, "height_percent", {0, 100}, poses.height_percent);
  } else if (poses.kind == PoseKind::view) {
    poses.views = names("views");
    poses.views_place = table.place("views");
  } else {
    const std::string log = table.text("file");
    poses.log_place = table.place("file");
    poses.log = folder / log;
    if (std::error_code error; !log.empty() && !std::filesystem::exists(poses.log, error))
      table.report("file", "the log " + in_quotes(log) + " is not there",
                   "name a recording by its path from this file");
    poses.transform = table.text("transform", "");
  }
  return poses;
}

/// Reports each text of a list that is not among the names.
void check_names(const TomlTable& table, const char* key, const std::vector<std::string>& given,
                 const std::vector<std::string>& known, const std::string& noun) {
  for (const std::string& name : given)
    if (std::find(known.begin(), known.end(), name) == known.end())
      table.report(key, "the study has no " + noun + " " + in_quotes(name), suggest(name, known));
}

/// Reports a name that an earlier table of the list has.
void check_unique(const TomlTable& table, const char* key, const std::string& name, std::set<std::string>& taken) {
  if (!taken.insert(name).second)
    table.report(key, "the name " + in_quotes(name) + " is taken", "give it another with 'name'");
}

}  // namespace

std::filesystem::path built_in_recipe() {
  return assets_folder() / "phantoms" / "abdomen.toml";
}

Study read_study(const std::filesystem::path& file) {
  Study study;
  study.file = file;
  study.text = read_file(file, kLargestFile);
  study.digest = digest_of(study.text);
  const std::filesystem::path folder = file.parent_path();
  const TomlDocument document(file.string(), study.text, OnMistake::collect);
  const TomlTable root = document.root();
  root.whole_number("format", kStudyFormat, kStudyFormat);
  study.name = root.text("name");
  study.seed = std::uint32_t(root.whole_number("seed", 0, std::numeric_limits<std::uint32_t>::max()));
  study.images = std::uint32_t(root.whole_number("images", 1, kMaxImages));
  study.shard_images = std::uint32_t(root.whole_number("shard_images", 1, kMaxShardImages, study.shard_images));
  if (study.shards() > kMaxShards)
    root.report("shard_images", "there would be " + std::to_string(study.shards()) + " shards, above 100000",
                "take more images per shard");

  if (root.has("settings")) read_setting_ranges(root.table("settings"), study);

  std::set<std::string> case_names, names_of_probes;
  for (const TomlTable& table : root.tables("case", kMaxTables)) {
    study.cases.push_back(read_case_of_study(table, folder));
    check_unique(table, table.has("name") ? "name" : "case", study.cases.back().name, case_names);
  }
  for (const TomlTable& table : root.tables("probe", kMaxTables)) {
    const std::size_t mistakes = document.mistakes().size();
    study.probes.push_back(read_probe_of_study(table));
    // In place of an unknown name stands the first one.
    if (document.mistakes().size() == mistakes)
      check_unique(table, "name", study.probes.back().probe.name, names_of_probes);
  }
  const std::vector<TomlTable> pose_tables = root.tables("poses", kMaxTables);
  for (const TomlTable& table : pose_tables) {
    study.poses.push_back(read_poses_of_study(table, folder));
    const StudyPoses& poses = study.poses.back();
    check_names(table, "cases", poses.cases, {case_names.begin(), case_names.end()}, "case");
    check_names(table, "probes", poses.probes, {names_of_probes.begin(), names_of_probes.end()}, "probe");
  }
  const auto needs = [&](bool there, const char* what, const char* remedy) {
    if (!there) root.report("", std::string("the study has no ") + what, remedy);
  };
  needs(!study.cases.empty(), "[[case]]", "add one, such as case = \"abdomen\"");
  needs(!study.probes.empty(), "[[probe]]", "add one, such as name = \"curvilinear\"");
  needs(!study.poses.empty(), "[[poses]]", "add one, such as kind = \"skin\"");
  root.refuse_unknown_keys();
  document.throw_mistakes();
  return study;
}

}  // namespace insonate
