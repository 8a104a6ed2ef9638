#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/files/mistake.h"
#include "sim/files/toml_table.h"
#include "sim/model/settings.h"
#include "sim/model/settings_file.h"
#include "sim/probe/probe.h"

namespace insonate {

/// The version of the rules of study files, and of the images that they stand for: the same study gives the same images
/// only with the same version.
inline constexpr int kStudyFormat = 1;

inline constexpr std::uint32_t kMaxImages = 100'000'000;
inline constexpr std::uint32_t kMaxShards = 100'000;
inline constexpr std::uint32_t kMaxShardImages = 100'000;

/// A range of numbers at equal steps from its least one: a knob that clicks. step 0: any number.
struct SteppedRange {
  NumberRange range;
  double step = 0;
};

/// An option of the phantom's recipe that differs between patients.
struct PhantomOption {
  std::string name;
  std::vector<std::string> choices;  ///< one of these, unless there is a range
  std::optional<NumberRange> range;
};

/// [[case]]: a patient, or several of the built-in phantom whose options are drawn.
struct StudyCase {
  std::string name;    ///< unique in the study
  std::string given;   ///< as the study names it
  std::string source;  ///< kBuiltIn, or the path of a case folder, CT file or DICOM folder
  std::string licence;
  double weight = 1;  ///< of all its patients together
  std::uint32_t patients = 1;
  std::vector<PhantomOption> options;
  SourcePlace place;
};
inline constexpr std::string_view kBuiltIn = "abdomen";
/// Returns the file of the built-in patient's recipe.
std::filesystem::path built_in_recipe();

/// [[probe]]
struct StudyProbe {
  Probe probe;
  double weight = 1;
  SteppedRange depth_mm, frequency_mhz;
};

/// A way to find poses.
enum class PoseKind {
  skin,  ///< anywhere on the skin, along its normal
  view,  ///< at the case's reference views
  log    ///< where a recorded hand was
};

/// [[poses]]: where the probe is held. Angles as in ViewValues (scenarios/metrics/view_meter.h), from the pose that the
/// kind gives: rotation = Rx(tilt) Rz(rock) Ry(turn).
struct StudyPoses {
  PoseKind kind = PoseKind::view;
  double weight = 1;
  std::vector<std::string> cases;      ///< names of [[case]]; empty: every case
  std::vector<std::string> probes;     ///< names of [[probe]]; empty: every one, for views the view's own
  std::vector<std::string> views;      ///< PoseKind::view: empty means all views
  std::filesystem::path log;           ///< PoseKind::log
  std::string transform;               ///< PoseKind::log: of the recording, empty for the usual one
  NumberRange around_deg{-180, 180};   ///< PoseKind::skin: 0 in front, 90 on the patient's left
  NumberRange height_percent{10, 90};  ///< PoseKind::skin: of the CT, from its lower end (feet) to its upper end
  NumberRange tilt_deg{0, 0}, rock_deg{0, 0}, turn_deg{0, 0};
  NumberRange press_mm{0, 0};  ///< along the beam; for the skin from where the face touches it
  double slide_mm = 0;         ///< at most so far to either side along the face, and as far across
  SourcePlace place, views_place, log_place;
};

/// A setting of model S that differs between images.
struct SettingRange {
  std::string name;
  std::vector<SettingValue> choices;  ///< one of these, unless there is a range
  std::optional<NumberRange> range;
  bool whole = false;  ///< whole numbers of the range alone
  int step = 1;        ///< between them: 2 where they must be odd
};

/// A study: which images a dataset holds. Everything in it follows from the file's text, the patients' files and the
/// program's version.
struct Study {
  std::filesystem::path file;
  std::string text, digest;  ///< of the file
  std::string name;
  std::uint32_t seed = 0;
  std::uint32_t images = 0;
  std::uint32_t shard_images = 500;    ///< images per shard; the last one may have fewer
  std::vector<SettingRange> settings;  ///< that differ from the trainer's, for the image's depth and frequency
  NumberRange tgc_shift_db{0, 0};      ///< added to each of the time gains
  std::vector<StudyCase> cases;
  std::vector<StudyProbe> probes;
  std::vector<StudyPoses> poses;

  std::uint32_t shards() const { return (images + shard_images - 1) / shard_images; }
  std::uint32_t first_image(std::uint32_t shard) const { return shard * shard_images; }
  std::uint32_t images_of(std::uint32_t shard) const { return std::min(shard_images, images - first_image(shard)); }
};

/// Reads a study (docs/datasets.md describes its keys). Throws one InputError that names every unknown key, wrong type,
/// value out of range, name that refers to nothing, and option that the built-in patient's recipe does not accept, with
/// line and column. Does not look into the patients: see ShotMaker.
Study read_study(const std::filesystem::path& toml_file);

}  // namespace insonate
