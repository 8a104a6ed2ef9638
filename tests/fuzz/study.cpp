// Studies of insonate-dataset, and settings that are drawn by them.
#include "tools/dataset/study.h"

#include "sim/model/settings_file.h"
#include "tests/fuzz/fuzz_target.h"
#include "tools/dataset/draws.h"
#include "tools/dataset/setting_ranges.h"

namespace insonate::fuzz {
namespace {

bool holds(const NumberRange& range, double least, double most) {
  return range.least >= least && range.least <= range.most && range.most <= most;
}

const Target study_target("study", [](std::string_view bytes) -> std::string {
  const Study study = read_study(file_with("study.toml", bytes));
  if (study.images == 0 || study.shards() == 0 || study.shards() > kMaxShards)
    return "it has no images or too many shards";
  if (study.cases.empty() || study.probes.empty() || study.poses.empty()) return "it lacks a case, a probe or poses";
  for (const StudyCase& subject : study.cases)
    if (subject.licence.empty() || !(subject.weight > 0) || subject.patients == 0) return "a case is out of range";
  for (const StudyPoses& poses : study.poses)
    if (!holds(poses.tilt_deg, -80, 80) || !holds(poses.turn_deg, -180, 180) || !holds(poses.press_mm, -20, 50))
      return "poses are out of range";
  for (const StudyProbe& probe : study.probes) {
    if (!holds(probe.depth_mm.range, 10, 400) || !holds(probe.frequency_mhz.range, 0.5, 30))
      return "a probe is out of range";
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Draws draws(study.seed, i);
      const double depth_mm = draws.step_of(probe.depth_mm, "depth_mm");
      const double frequency_mhz = draws.step_of(probe.frequency_mhz, "frequency_mhz");
      if (!(depth_mm >= 10 && depth_mm <= 400)) return "a depth is out of range";
      const Settings settings = draw_settings(study, draws, frequency_mhz, depth_mm, 1);
      if (const auto why = why_not_valid(settings)) return *why;
    }
  }
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
