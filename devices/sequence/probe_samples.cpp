#include "devices/sequence/probe_samples.h"

#include <algorithm>
#include <cctype>

#include "devices/sequence/sequence_file.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

constexpr std::string_view kPreferred[] = {"ProbeToPatient", "ProbeToReference", "ProbeToTracker"};

std::string all_names(const Sequence& sequence) {
  std::string names;
  for (const std::string& name : sequence.transform_names) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none" : names;
}

int choose(const Sequence& sequence, std::string_view wanted) {
  if (wanted.empty()) {
    for (const std::string_view name : kPreferred)
      if (const int found = sequence.find(name); found >= 0) return found;
    throw InputError(
        sequence.file, "",
        "none of its transforms is ProbeToPatient, ProbeToReference or ProbeToTracker; it has " + all_names(sequence),
        "name the probe's, as in 'replay:FILE?transform=SensorToTracker'");
  }
  std::string_view name = wanted;
  if (name.ends_with("Transform")) name.remove_suffix(std::string_view("Transform").size());
  const int found = sequence.find(name);
  if (found < 0)
    throw InputError(sequence.file, "", "no frame has the transform '" + std::string(wanted) + "'",
                     suggest(name, sequence.transform_names));
  return found;
}

/// "Tracker" of "ProbeToTracker": what follows the first "To" before a capital letter, as IGSIO reads its names.
std::string_view target(std::string_view name) {
  for (std::size_t to = name.find("To"); to != std::string_view::npos; to = name.find("To", to + 2))
    if (to > 0 && to + 2 < name.size() && std::isupper(static_cast<unsigned char>(name[to + 2])))
      return name.substr(to + 2);
  return {};
}

/// Where a transform of the sequence is found, if at all: in each frame or in the header.
struct Source {
  std::string name;
  int index = -1;
  const glm::dmat4* constant = nullptr;
};

/// The transform's pose in a frame; sets `status` to why there is none.
Pose pose_in(const Sequence& sequence, std::size_t frame, const Source& source, PoseStatus& status) {
  const glm::dmat4* matrix = source.constant;
  if (!matrix) {
    const SequenceTransform* transform = sequence.frames[frame].find(source.index);
    status = transform ? transform->status : PoseStatus::missing;
    if (status != PoseStatus::ok) return {};
    matrix = &transform->matrix;
  }
  if (const auto why = why_not_rigid(*matrix))
    throw InputError(sequence.file, source.constant ? "header" : "frame " + std::to_string(frame),
                     source.name + "Transform: " + *why, "calibrate and record again, or mark the frame as INVALID");
  return pose_from_matrix(*matrix);
}

}  // namespace

std::vector<PoseSample> probe_samples(const Sequence& sequence, std::string_view transform) {
  Source probe;
  probe.index = choose(sequence, transform);
  probe.name = sequence.transform_names[std::size_t(probe.index)];

  Source onward;
  const std::string_view base = target(probe.name);
  if (base != "Patient" && !base.empty()) {
    onward.name = std::string(base) + "ToPatient";
    onward.index = sequence.find(onward.name);
    const auto constant = sequence.constants.find(onward.name);
    if (onward.index < 0 && constant != sequence.constants.end()) onward.constant = &constant->second;
  }
  const bool chained = onward.index >= 0 || onward.constant;

  std::vector<PoseSample> samples(sequence.frames.size());
  for (std::size_t f = 0; f < samples.size(); ++f) {
    PoseSample& sample = samples[f];
    sample.time_s = sequence.frames[f].time_s;
    sample.buttons = sequence.frames[f].buttons;
    sample.distortion = sequence.frames[f].distortion;
    sample.rejected = sequence.frames[f].rejected;
    const Pose base_from_probe = pose_in(sequence, f, probe, sample.status);
    if (sample.status != PoseStatus::ok) continue;
    if (!chained) {
      sample.patient_from_probe = base_from_probe;
      continue;
    }
    const Pose patient_from_base = pose_in(sequence, f, onward, sample.status);
    if (sample.status == PoseStatus::ok) sample.patient_from_probe = patient_from_base * base_from_probe;
  }
  return samples;
}

std::string probe_transform(const Sequence& sequence, std::string_view transform) {
  return sequence.transform_names[std::size_t(choose(sequence, transform))];
}

std::map<double, std::string> recorded_actions(const Sequence& sequence) {
  std::map<double, std::string> actions;
  for (const SequenceFrame& frame : sequence.frames)
    if (!frame.actions.empty()) actions.emplace(frame.time_s, frame.actions);
  return actions;
}

RecordedScan read_recorded_scan(const std::filesystem::path& file, std::string_view transform) {
  const SequenceFile read = read_sequence_file(file);
  const Sequence sequence = parse_sequence(read.bytes(), file.string());
  return {{file.filename().string(), read.digest, probe_transform(sequence, transform), recorded_actions(sequence)},
          probe_samples(sequence, transform)};
}

}  // namespace insonate
