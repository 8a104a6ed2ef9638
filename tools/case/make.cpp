// insonate-case phantom, import and add-view: the commands that write.

#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "devices/replay/read_log.h"
#include "scenarios/cases/add_view.h"
#include "scenarios/cases/structures.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/phantom/phantom.h"
#include "tools/case/commands.h"
#include "tools/cli/pose_file.h"

namespace insonate {
namespace {

std::vector<std::pair<std::string, std::string>> parse_options(const std::vector<std::string>& settings) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const std::string& setting : settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError("--set", "", "'" + setting + "' is not a setting", "write KEY=VALUE, such as free_fluid=true");
    options.emplace_back(setting.substr(0, equals), setting.substr(equals + 1));
  }
  return options;
}

/// Shows progress on standard error: on a terminal every percent in place, in a log file every 10 % on its own line.
class ProgressLine {
public:
  explicit ProgressLine(std::string work) : work_(std::move(work)) {}
  ~ProgressLine() {
    if (on_terminal_ && last_ >= 0) std::fprintf(stderr, "\n");
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void operator()(double share) {
    const int percent = int(share * 100);
    if (percent == last_ || (!on_terminal_ && percent / 10 == last_ / 10 && last_ >= 0)) return;
    last_ = percent;
    std::fprintf(stderr, on_terminal_ ? "\r%s: %d %%" : "%s: %d %%\n", work_.c_str(), percent);
  }

private:
  std::string work_;
  bool on_terminal_ = isatty(STDERR_FILENO) != 0;
  int last_ = -1;
};

/// Returns the probe's pose in a log at a time.
Pose pose_in_log(const RecordedMoment& moment) {
  constexpr double kNear_s = 0.1;  // a few frames of the slowest tracker
  RecordingOptions of_log;
  of_log.transform = moment.transform;
  const RecordedScan scan = read_log(moment.log, of_log);
  check_is_of_probe(scan.recording);
  const ProbeSample* nearest = nullptr;
  const double wanted_s = scan.samples.front().time_s + moment.at_s;
  for (const ProbeSample& sample : scan.samples)
    if (sample.status == PoseStatus::ok &&
        (!nearest || std::abs(sample.time_s - wanted_s) < std::abs(nearest->time_s - wanted_s)))
      nearest = &sample;
  if (!nearest || std::abs(nearest->time_s - wanted_s) > kNear_s) {
    char place[64];
    std::snprintf(place, sizeof place, "second %.3f", moment.at_s);
    throw InputError(moment.log.string(), place, "there is no valid pose within a tenth of a second",
                     "name a moment at which the probe was tracked");
  }
  return nearest->patient_from_probe;
}

// Checked before the work, which takes a minute.
void check_destination(const std::filesystem::path& folder, bool replace) {
  check_case_can_be_written(folder);
  if (!replace && std::filesystem::exists(folder / "case.toml"))
    throw InputError(folder.string(), "", "there is a case already, with the views that were added to it",
                     "name another folder, or give --replace to write over it");
}

}  // namespace

void make_and_write(std::filesystem::path recipe, const std::vector<std::string>& settings,
                    const std::filesystem::path& folder, bool replace) {
  constexpr std::size_t kLongestRecipe = std::size_t(16) << 20;
  check_destination(folder, replace);
  if (recipe.empty()) recipe = assets_folder() / "phantoms" / "abdomen.toml";
  Case subject;
  {
    ProgressLine progress("Making the phantom");
    subject = make_phantom(recipe.string(), read_file(recipe, kLongestRecipe), parse_options(settings),
                           [&](double share) { progress(share); });
  }
  write_case(folder, subject);
}

void import_and_write(ImportRequest request, const std::filesystem::path& folder, bool replace) {
  check_destination(folder, replace);
  if (request.name.empty()) request.name = std::filesystem::absolute(folder / "").parent_path().filename().string();
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  ImportedCase imported;
  {
    ProgressLine progress("Importing");
    imported = import_case(request, tissues, [&](double share) { progress(share); });
  }
  const Case& subject = imported.subject;
  write_case(folder, subject);
  std::printf("%s: %zu structures, %zu landmarks, %zu views\n", folder.string().c_str(), subject.label_table.size(),
              subject.landmarks.size(), subject.views.size());
  for (const std::string& note : imported.notes) std::printf("  %s\n", note.c_str());
}

void add_recorded_view(const std::filesystem::path& folder, ReferenceView view, const std::string& pose_file,
                       const RecordedMoment& moment) {
  if (pose_file.empty() == moment.log.empty())
    throw InputError("add-view", "", "it takes either a pose file or a log", "give --pose, or --log and --at");
  view.patient_from_probe = pose_file.empty() ? pose_in_log(moment) : read_pose(pose_file);
  if (view.title.empty()) view.title = title_of_structure(view.name);
  add_view(folder, view, read_tissue_table(assets_folder() / "tissues.toml"));
}

}  // namespace insonate
