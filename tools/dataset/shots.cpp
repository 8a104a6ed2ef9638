#include "tools/dataset/shots.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include "devices/sequence/probe_samples.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/tissue/skin_contact.h"
#include "tools/dataset/draws.h"
#include "tools/dataset/setting_ranges.h"
#include "tools/dataset/skin_poses.h"

namespace insonate {
namespace {

glm::dmat3 turned(std::size_t axis, double angle_deg) {
  const double c = std::cos(glm::radians(angle_deg)), s = std::sin(glm::radians(angle_deg));
  const int next = int((axis + 1) % 3), last = int((axis + 2) % 3);
  glm::dmat3 rotation(1.0);
  rotation[next][next] = rotation[last][last] = c;
  rotation[next][last] = s;
  rotation[last][next] = -s;
  return rotation;
}

/// Returns from where to where a grid reaches along patient z, mm.
NumberRange heights_of(const Grid& grid) {
  NumberRange heights{grid.origin.z, grid.origin.z};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 share(corner & 1, corner >> 1 & 1, corner >> 2);
    const double z = grid.patient_from_index(share * glm::dvec3(grid.size - 1)).z;
    heights = {std::min(heights.least, z), std::max(heights.most, z)};
  }
  return heights;
}

}  // namespace

ShotMaker::ShotMaker(const Study& study, const StudyPatient& patient, const Case& subject)
    : study_(&study), patient_(&patient), case_(&subject), height_mm_(heights_of(subject.ct.grid)) {
  for (const StudyPoses& poses : study.poses) {
    const auto& cases = poses.cases;
    if (!cases.empty() && std::find(cases.begin(), cases.end(), patient.of->name) == cases.end()) continue;
    ways_.push_back(way_of(poses));
    weights_.push_back(poses.weight);
  }
  if (ways_.empty())
    throw input_error(study.file.string(),
                      {{patient.of->place, "no [[poses]] apply to the case " + in_quotes(patient.of->name),
                        "name it in the 'cases' of one, or leave 'cases' out"}});
}

std::vector<std::size_t> ShotMaker::listed_probes(const StudyPoses& poses) const {
  std::vector<std::size_t> listed;
  for (std::size_t i = 0; i < study_->probes.size(); ++i) {
    const std::string& name = study_->probes[i].probe.name;
    if (poses.probes.empty() || std::find(poses.probes.begin(), poses.probes.end(), name) != poses.probes.end())
      listed.push_back(i);
  }
  return listed;
}

ShotMaker::Way ShotMaker::way_of(const StudyPoses& poses) const {
  Way way{&poses, {}, listed_probes(poses)};
  if (poses.kind == PoseKind::view) add_views(way);
  if (poses.kind == PoseKind::log) add_log(way);
  return way;
}

void ShotMaker::add_views(Way& way) const {
  const StudyPoses& poses = *way.poses;
  std::vector<Mistake> mistakes;
  const auto add = [&](const ReferenceView& view, bool named) {
    std::vector<std::size_t> probes = way.probes;
    if (poses.probes.empty())
      std::erase_if(probes, [&](std::size_t i) { return study_->probes[i].probe.name != view.probe; });
    if (!probes.empty())
      way.starts.push_back({"view " + view.name, Pose(view.patient_from_probe), std::move(probes)});
    else if (named)
      mistakes.push_back({poses.views_place,
                          "the view " + in_quotes(view.name) + " is held with the probe " + in_quotes(view.probe) +
                              ", which the study does not list",
                          "add a [[probe]] of that name, or give these poses 'probes'"});
  };
  for (const std::string& name : poses.views) {
    if (const ReferenceView* view = case_->find_view(name))
      add(*view, true);
    else
      mistakes.push_back(
          {poses.views_place, "the patient " + in_quotes(patient_->name) + " has no view " + in_quotes(name),
           case_->views.empty() ? "add one with insonate-case add-view" : suggest(name, names_of(case_->views))});
  }
  if (poses.views.empty())
    for (const ReferenceView& view : case_->views) add(view, false);
  if (way.starts.empty() && mistakes.empty())
    mistakes.push_back(
        {poses.place,
         "the patient " + in_quotes(patient_->name) + " has no view that is held with a [[probe]] of the study",
         "list the probe of a view, give these poses 'probes', or take kind = \"skin\""});
  if (!mistakes.empty()) throw input_error(study_->file.string(), std::move(mistakes));
}

void ShotMaker::add_log(Way& way) const {
  const StudyPoses& poses = *way.poses;
  RecordingOptions options;
  options.transform = poses.transform;
  options.without_times = true;
  std::vector<ProbeSample> samples;
  try {
    samples = read_recorded_scan(poses.log, options).samples;
  } catch (const InputError& error) {
    throw InputError(study_->file.string() + ": " + in_words(poses.log_place) + ": " + error.what());
  }
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].status == PoseStatus::ok)
      way.starts.push_back({"log " + poses.log.filename().string() + ", sample " + std::to_string(i),
                            Pose(samples[i].patient_from_probe), std::vector<std::size_t>(way.probes)});
  if (way.starts.empty())
    throw input_error(study_->file.string(),
                      {{poses.log_place, "the log " + in_quotes(poses.log.string()) + " holds no pose of the probe",
                        "take a log of a probe that was tracked"}});
}

// Returns whether the middle of a probe's face lies deep in tissue, as in the recording of another patient.
bool ShotMaker::is_within_body(const Pose& patient_from_probe) const {
  constexpr double kDeepest_mm = 60;
  return !distance_out_of_body(case_->ct, patient_from_probe.translation, patient_from_probe.direction({0, -1, 0}),
                               kDeepest_mm);
}

Shot ShotMaker::at(std::uint32_t index) const {
  const Draws draws(study_->seed, index);
  const Way& way = ways_[draws.weighted(weights_, "poses")];
  const StudyPoses& poses = *way.poses;

  Shot shot;
  shot.index = index;
  for (std::uint32_t attempt = 0; attempt < kMaxAttempts; ++attempt) {
    Pose start;
    const std::vector<std::size_t>* probes = &way.probes;
    if (poses.kind == PoseKind::skin) {
      const double share = draws.within(poses.height_percent, "height", attempt) / 100;
      const double height_mm = height_mm_.least + share * (height_mm_.most - height_mm_.least);
      const auto found = pose_on_skin(case_->ct, draws.within(poses.around_deg, "around", attempt), height_mm);
      if (!found) continue;
      start = *found;
      shot.pose_source = "skin";
    } else {
      const Start& chosen = way.starts[draws.below(std::uint32_t(way.starts.size()), "start", attempt)];
      start = chosen.pose;
      shot.pose_source = chosen.source;
      probes = &chosen.probes;
    }
    std::vector<double> weights;
    for (const std::size_t i : *probes) weights.push_back(study_->probes[i].weight);
    const StudyProbe& listed = study_->probes[(*probes)[draws.weighted(weights, "probe")]];

    const NumberRange slide{-poses.slide_mm, poses.slide_mm};
    const glm::dvec3 moved(draws.within(slide, "slide across", attempt), draws.within(poses.press_mm, "press", attempt),
                           draws.within(slide, "slide along", attempt));
    shot.patient_from_probe.translation = start.point(moved);
    shot.patient_from_probe.rotation = start.rotation * turned(0, draws.within(poses.tilt_deg, "tilt", attempt)) *
                                       turned(2, draws.within(poses.rock_deg, "rock", attempt)) *
                                       turned(1, draws.within(poses.turn_deg, "turn", attempt));
    if (!SkinContact(case_->ct, listed.probe).at(shot.patient_from_probe) || is_within_body(shot.patient_from_probe))
      continue;

    shot.probe = listed.probe;
    shot.depth_mm = draws.step_of(listed.depth_mm, "depth_mm");
    const double frequency_mhz = draws.step_of(listed.frequency_mhz, "frequency_mhz");
    shot.settings = draw_settings(*study_, draws, frequency_mhz, shot.depth_mm, hash(study_->seed, patient_->number));
    return shot;
  }
  throw input_error(
      study_->file.string(),
      {{poses.place,
        "of " + std::to_string(kMaxAttempts) + " poses that were drawn for image " + std::to_string(index) +
            ", none has the probe on the skin of the patient " + in_quotes(patient_->name),
        "take poses of this patient, and smaller ranges around them"}});
}

}  // namespace insonate
