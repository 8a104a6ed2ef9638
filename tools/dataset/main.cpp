// insonate-dataset: makes images with their truth by a study file, in shards.

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>
#include <vector>

#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/files/new_folder.h"
#include "sim/files/png.h"
#include "tools/cli/program.h"
#include "tools/dataset/dataset_folder.h"
#include "tools/dataset/make_shards.h"
#include "tools/dataset/ranks.h"

using namespace insonate;

namespace {

/// Begins a dataset's folder, after all patients have been looked into. Another process may have done so already.
void begin(const Study& study, const std::vector<StudyPatient>& patients, const DatasetFolder& folder) {
  if (folder.has_begun()) return folder.check_is_of(study);
  folder.check_may_begin();
  check_patients(study, patients);
  folder.begin(study, patients);
}

int plan(const std::string& study_file, const std::string& path) {
  const Study study = read_study(study_file);
  const std::vector<StudyPatient> patients = patients_of(study);
  const DatasetFolder folder(path);
  folder.has_begun() ? folder.check_is_of(study) : folder.check_may_begin();
  check_patients(study, patients);
  folder.begin(study, patients);
  std::printf("%s in %s of %s\n", count_of(study.images, "image").c_str(), count_of(study.shards(), "shard").c_str(),
              count_of(patients.size(), "patient").c_str());
  for (const StudyPatient& patient : patients) {
    std::vector<std::uint32_t> shards(patient.shards);
    std::iota(shards.begin(), shards.end(), patient.first_shard);
    std::printf("  %s %s: %s\n", patient.shards == 1 ? "shard" : "shards", shard_list(shards).c_str(),
                patient.name.c_str());
  }
  return 0;
}

int make(const std::string& study_file, const std::string& path, const std::string& shards) {
  const Study study = read_study(study_file);
  const std::vector<StudyPatient> patients = patients_of(study);
  const DatasetFolder folder(path);
  const Rank rank = rank_of_environment();
  const std::string listed = shards.empty() ? "0-" + std::to_string(study.shards() - 1) : shards;
  const std::vector<std::uint32_t> all = read_shard_list("--shards", listed, study.shards());
  begin(study, patients, folder);
  const std::vector<std::uint32_t> part = part_of(all, rank);
  if (part.empty())
    std::printf("this process has no shard to make\n");
  else if (std::ranges::all_of(part, [&](std::uint32_t shard) { return folder.has_shard(shard); }))
    std::printf("%s: there already\n", count_of(part.size(), "shard").c_str());
  make_shards(study, patients, folder, part, [&](const MadeShard& made) {
    std::printf("shard %u: %s of %s, %.0f per hour\n", made.shard, count_of(made.images, "image").c_str(),
                made.patient.c_str(), 3600 * made.images / made.seconds);
    std::fflush(stdout);
  });
  if (folder.missing().empty()) folder.complete();
  return 0;
}

int make_one(const std::string& study_file, std::uint32_t index, const std::string& path) {
  const Study study = read_study(study_file);
  if (index >= study.images)
    throw InputError("INDEX", "", "there is no image " + std::to_string(index) + " of " + std::to_string(study.images),
                     "count them from 0");
  refuse_taken(path);
  const SingleImage made = make_image(study, patients_of(study), index);
  const DatasetImage& image = made.image;
  write_folder(path, [&](const std::filesystem::path& folder) {
    write_png(folder / "image.png", image.grey);
    write_png(folder / "label.png", image.truth.label);
    write_png(folder / "visible_label.png", image.truth.visible_label);
    write_png(folder / "reach.png", image.truth.reach);
    nlohmann::ordered_json json;
    json["index"] = index;
    json["shard"] = index / study.shard_images;
    json["probe"] = image.shot.probe.name;
    json["depth_mm"] = image.shot.depth_mm;
    json["mm_per_pixel"] =
        image_geometry(image.shot.probe, image.shot.depth_mm, image.grey.width, image.grey.height).mm_per_pixel;
    json["pose_source"] = image.shot.pose_source;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) {
        json["patient_from_probe"][std::size_t(row)][std::size_t(column)] =
            image.shot.patient_from_probe.matrix()[column][row];
        json["patient_from_pixel"][std::size_t(row)][std::size_t(column)] = image.patient_from_pixel[column][row];
      }
    for (const float distance : image.truth.skin_mm) {
      if (std::isnan(distance))
        json["skin_mm"].push_back(nullptr);
      else
        json["skin_mm"].push_back(distance);
    }
    json["settings"] = nlohmann::ordered_json::parse(image.settings);
    json["digest"] = image.digest;
    for (const auto& [name, text] : made.about) {
      if (name == "options" || name == "labels")
        json[name] = nlohmann::ordered_json::parse(text);
      else if (name != "shard" && name != "first_image")
        json[name] = text;
    }
    write_file(folder / "truth.json", json.dump(2) + "\n");
  });
  return 0;
}

int status(const std::string& path, bool only_missing) {
  const DatasetFolder folder(path);
  const std::vector<std::uint32_t> missing = folder.missing();
  const std::string list = shard_list(missing);
  if (only_missing) {
    if (!missing.empty()) std::printf("%s\n", list.c_str());
  } else {
    const std::size_t count = folder.shards();
    std::printf("%zu of %zu shards are finished\n", count - missing.size(), count);
    if (!missing.empty()) std::printf("missing: %s\n", list.c_str());
    if (missing.empty() && !folder.is_complete()) std::printf("the manifest is not complete: run make once more\n");
  }
  return missing.empty() ? 0 : 1;
}

int merge(const std::string& path, const std::vector<std::string>& others) {
  const DatasetFolder folder(path);
  folder.shards();  // refuses a folder that is none, before anything is moved
  for (const std::string& other : others) {
    const DatasetFolder from(other);
    std::printf("%s: %s moved", other.c_str(), count_of(folder.take_shards_of(from), "shard").c_str());
    if (const std::size_t left = from.shards() - from.missing().size(); left > 0)
      std::printf(", %zu left there, which %s has already", left, path.c_str());
    std::printf("\n");
  }
  if (folder.missing().empty()) folder.complete();
  return 0;
}

int check(const std::string& path) {
  const DatasetFolder folder(path);
  const std::vector<std::string> damage = folder.damage();
  for (const std::string& sentence : damage) std::printf("%s\n", sentence.c_str());
  std::printf("%zu shards are sound, %zu are damaged, %zu are missing\n",
              std::size_t(folder.shards()) - folder.missing().size() - damage.size(), damage.size(),
              folder.missing().size());
  return damage.empty() && folder.missing().empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Make sets of ultrasound images with their truth, by a study file, for training and testing.",
                   "insonate-dataset");
  program.footer(
      "Examples:\n"
      "  insonate-dataset plan study.toml images                 check the study and all its patients\n"
      "  insonate-dataset make study.toml images                 make all shards, or those that are missing\n"
      "  insonate-dataset make study.toml images --shards 0-15\n"
      "  mpirun -n 8 insonate-dataset make study.toml images     each process makes its part\n"
      "  insonate-dataset status --missing images                such as 3,7-9, for sbatch --array\n"
      "  insonate-dataset image study.toml 731 image-731         one image again, as PNG files\n"
      "docs/datasets.md describes study files, and the jobs of a cluster.");
  program.require_subcommand(1);

  std::string study_file, folder, shards;
  const auto add_study = [&](CLI::App* command) {
    command->add_option("STUDY", study_file, "Follow this study, a TOML file")->type_name("FILE")->required();
  };
  const auto add_folder = [&](CLI::App* command, const char* what) {
    command->add_option("FOLDER", folder, what)->type_name("FOLDER")->required();
  };
  CLI::App* plan_command =
      program.add_subcommand("plan", "Check a study and its patients, and begin its folder without images");
  add_study(plan_command);
  add_folder(plan_command, "Begin the dataset in this folder");

  CLI::App* make_command = program.add_subcommand(
      "make", "Make the shards that are not finished; under mpirun or srun, the part of this process");
  add_study(make_command);
  add_folder(make_command, "Write the shards to this folder");
  make_command
      ->add_option("--shards", shards,
                   "Make only these shards, such as 3, 0-15 or 1,4-6; of them, the part of this process")
      ->type_name("LIST")
      ->default_str("all");

  std::uint32_t index = 0;
  CLI::App* image_command = program.add_subcommand("image", "Make one image of a study alone, as PNG files and JSON");
  add_study(image_command);
  image_command->add_option("INDEX", index, "Make this image, counted from 0")->type_name("NUMBER")->required();
  add_folder(image_command, "Write to this new folder");

  bool only_missing = false;
  CLI::App* status_command =
      program.add_subcommand("status", "Report which shards are finished; the exit code is 1 if some are missing");
  add_folder(status_command, "Look at this dataset");
  status_command->add_flag("--missing", only_missing, "Print only a list of those that are missing, for --shards");

  std::vector<std::string> others;
  CLI::App* merge_command =
      program.add_subcommand("merge", "Move the shards of other folders of the same study into one, by renaming");
  add_folder(merge_command, "Move the shards to this dataset");
  merge_command->add_option("FROM", others, "Take the shards of these folders")->type_name("FOLDER")->required();

  CLI::App* check_command = program.add_subcommand(
      "check", "Read all shards and report damage; the exit code is 1 if a shard is damaged or missing");
  add_folder(check_command, "Read this dataset");

  return run_program(program, argc, argv, [&] {
    if (*plan_command) return plan(study_file, folder);
    if (*make_command) return make(study_file, folder, shards);
    if (*image_command) return make_one(study_file, index, folder);
    if (*status_command) return status(folder, only_missing);
    if (*merge_command) return merge(folder, others);
    return check(folder);
  });
}
