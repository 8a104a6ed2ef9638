#include "tools/dataset/make_shards.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <tuple>

#include "scenarios/case_digest.h"
#include "sim/imaging/upload.h"
#include "tools/cli/about.h"
#include "tools/cli/subject.h"
#include "tools/dataset/pictures.h"
#include "tools/dataset/setting_ranges.h"
#include "tools/dataset/shard_file.h"
#include "tools/dataset/truth_writer.h"

namespace insonate {
namespace {

/// A patient as images are made of it.
struct OpenedPatient {
  const StudyPatient* patient;
  Case subject;
  std::string digest;
  ShotMaker shots;
  TruthMaker truth;

  OpenedPatient(const Study& study, const StudyPatient& of, const TissueTable& tissues)
      : patient(&of),
        subject(open_patient(study, of, show_progress)),
        digest(digest_of(subject)),
        shots(study, of, subject),
        truth(subject, tissues) {}
  OpenedPatient(const OpenedPatient&) = delete;
  OpenedPatient& operator=(const OpenedPatient&) = delete;
};

std::string labels_json(const Case& subject) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const Label& label : subject.label_table)
    json[std::to_string(label.value)] = {{"name", label.name}, {"tissue", label.tissue}};
  return json.dump();
}

std::vector<std::pair<std::string, std::string>> about_shard(const Study& study, const OpenedPatient& opened,
                                                             const DatasetTissues& tissues, const std::string& device,
                                                             std::uint32_t shard) {
  nlohmann::ordered_json options = nlohmann::ordered_json::object();
  for (const auto& [name, value] : opened.patient->options) options[name] = value;
  std::vector<std::pair<std::string, std::string>> about{{"dataset", study.name},
                                                         {"study_digest", study.digest},
                                                         {"shard", std::to_string(shard)},
                                                         {"first_image", std::to_string(study.first_image(shard))},
                                                         {"patient", opened.patient->name},
                                                         {"options", options.dump()},
                                                         {"licence", opened.patient->of->licence},
                                                         {"case_digest", opened.digest},
                                                         {"labels", labels_json(opened.subject)},
                                                         {"tissue_table_digest", tissues.digest},
                                                         {"device", device}};
  for (const AboutLine& line : about_this_build())
    if (line.name == "Version" || line.name == "Commit")
      about.emplace_back(line.name == "Version" ? "version" : "commit", line.text);
  return about;
}

/// Returns the shots of a shard in the order in which they are drawn: those with equal scan lines and pixels follow
/// each other, because a change of these costs as much as some pictures.
std::vector<Shot> shots_of(const Study& study, const ShotMaker& maker, std::uint32_t shard) {
  std::vector<Shot> shots;
  for (std::uint32_t i = 0; i < study.images_of(shard); ++i) shots.push_back(maker.at(study.first_image(shard) + i));
  const auto layout = [](const Shot& shot) {
    return std::tuple(std::string_view(shot.probe.name), shot.depth_mm, shot.settings.frequency_mhz,
                      shot.settings.samples, shot.index);
  };
  std::sort(shots.begin(), shots.end(), [&](const Shot& a, const Shot& b) { return layout(a) < layout(b); });
  return shots;
}

ShardShape shape_of(const Study& study, std::uint32_t shard, const Settings& any) {
  ShardShape shape{study.images_of(shard), any.image_width, any.image_height, 0};
  for (const StudyProbe& probe : study.probes) shape.most_lines = std::max(shape.most_lines, probe.probe.lines);
  return shape;
}

void make_shard(const Study& study, OpenedPatient& opened, const DatasetTissues& tissues, PictureMaker& pictures,
                const DatasetFolder& folder, std::uint32_t shard) {
  std::vector<Shot> shots = shots_of(study, opened.shots, shard);
  const std::filesystem::path temporary = folder.temporary_for(shard);
  try {
    ShardWriter writer(temporary, folder.shard_file(shard), shape_of(study, shard, shots.front().settings),
                       about_shard(study, opened, tissues, pictures.device(), shard));
    {
      TruthWriter behind(opened.truth, writer, study.first_image(shard));
      const auto take = [&](Shot&& shot, Image<std::uint8_t>&& grey) { behind.put(std::move(shot), std::move(grey)); };
      gl::within_device(study.file.string(), "take fewer samples, lines or pixels", [&] {
        for (Shot& shot : shots) pictures.draw(std::move(shot), take);
        pictures.finish(take);
      });
      behind.finish();
    }
    writer.finish();
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    if (folder.has_shard(shard)) return;  // another process was faster, and has removed what was left of this one's
    throw;
  }
  folder.put_in_place(temporary, shard);
}

}  // namespace

void check_patients(const Study& study, const std::vector<StudyPatient>& patients) {
  for (const StudyPatient& patient : patients) {
    const Case subject = open_patient(study, patient, show_progress);
    if (std::ranges::all_of(subject.labels.voxels, [](std::uint8_t label) { return label == 0; }))
      std::fprintf(
          stderr,
          "insonate-dataset: the patient '%s' has no labels, so that label and visible_label are 0; 'insonate-case "
          "import' makes a case of a CT with its segmentation.\n",
          patient.name.c_str());
    const ShotMaker maker(study, patient, subject);
    for (std::uint32_t i = 0; i < patient.shards; ++i) maker.at(study.first_image(patient.first_shard + i));
  }
}

void make_shards(const Study& study, const std::vector<StudyPatient>& patients, const DatasetFolder& folder,
                 const std::vector<std::uint32_t>& shards, const std::function<void(const MadeShard&)>& made) {
  using Clock = std::chrono::steady_clock;
  const DatasetTissues tissues = dataset_tissues();
  std::optional<PictureMaker> pictures;
  std::optional<OpenedPatient> opened;
  for (const std::uint32_t shard : shards) {
    if (folder.has_shard(shard)) continue;
    const StudyPatient& patient = patient_of(patients, shard);
    if (!pictures) pictures.emplace();
    if (!opened || opened->patient != &patient) {
      opened.reset();
      opened.emplace(study, patient, tissues.table);
      pictures->set_patient(patient.of->source, opened->subject, tissues.table, may_have_waves(study));
    }
    const Clock::time_point begun = Clock::now();
    make_shard(study, *opened, tissues, *pictures, folder, shard);
    made({shard, study.images_of(shard), patient.name, std::chrono::duration<double>(Clock::now() - begun).count()});
  }
}

SingleImage make_image(const Study& study, const std::vector<StudyPatient>& patients, std::uint32_t index) {
  const DatasetTissues tissues = dataset_tissues();
  const StudyPatient& patient = patient_of(patients, index / study.shard_images);
  OpenedPatient opened(study, patient, tissues.table);
  PictureMaker pictures;
  pictures.set_patient(patient.of->source, opened.subject, tissues.table, may_have_waves(study));
  std::optional<DatasetImage> image;
  const auto take = [&](Shot&& shot, Image<std::uint8_t>&& grey) {
    image = with_truth(std::move(shot), grey, opened.truth);
  };
  gl::within_device(study.file.string(), "take fewer samples, lines or pixels", [&] {
    pictures.draw(opened.shots.at(index), take);
    pictures.finish(take);
  });
  return {std::move(*image), about_shard(study, opened, tissues, pictures.device(), index / study.shard_images)};
}

}  // namespace insonate
