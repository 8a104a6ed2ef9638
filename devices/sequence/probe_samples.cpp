#include "devices/sequence/probe_samples.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "devices/sequence/sequence_file.h"
#include "devices/sequence/transform_path.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"

namespace insonate {
namespace {

constexpr std::string_view kProbe = "Probe", kPatient = "Patient", kSuffix = "Transform";

/// Targets to which the probe is followed, best first. A path to the patient is used even if no frame has a status for
/// it. Otherwise poses in the tracker's frame would be used instead, and the probe would silently be in a wrong place.
constexpr std::pair<std::string_view, PathLinks> kUsualWays[] = {
    {kPatient, PathLinks::with_a_status},  {kPatient, PathLinks::all},    {"Reference", PathLinks::with_a_status},
    {"Tracker", PathLinks::with_a_status}, {"Reference", PathLinks::all}, {"Tracker", PathLinks::all}};

TransformPath direct(const Sequence& sequence, int index) {
  TransformLink link;
  link.name = sequence.transform_names[std::size_t(index)];
  link.index = index;
  return {link};
}

/// Extends a path to the patient's frame if the sequence has a path there.
void go_on_to_patient(const Sequence& sequence, std::string_view from, TransformPath& path) {
  auto onward = find_path(sequence, from, kPatient, PathLinks::with_a_status);
  if (!onward) onward = find_path(sequence, from, kPatient, PathLinks::all);
  if (onward) path.insert(path.end(), onward->begin(), onward->end());
}

[[noreturn]] void fail_without_probe(const Sequence& sequence) {
  if (sequence.transform_names.empty())
    throw InputError(sequence.file, "", "its frames have no transforms, so it does not tell where the probe was",
                     "record it with a tracker, so that its frames have ProbeToTrackerTransform");
  std::string names;
  for (const std::string& name : sequence.transform_names) names += (names.empty() ? "" : ", ") + name;
  // The transform that the user most likely means comes neither from the patient's reference nor from a picture.
  const auto tool =
      std::find_if(sequence.transform_names.begin(), sequence.transform_names.end(),
                   [](const auto& name) { return !name.starts_with("Reference") && !name.starts_with("Image"); });
  const std::string& example = tool == sequence.transform_names.end() ? sequence.transform_names.front() : *tool;
  throw InputError(
      sequence.file, "", "no transform leads from Probe to Patient, Reference or Tracker; it has " + names,
      "name the probe's, such as " + example + ": by --transform, or for a tracker as replay:FILE?transform=NAME");
}

TransformPath usual_path(const Sequence& sequence) {
  for (const auto& [target, links] : kUsualWays)
    if (const auto path = find_path(sequence, kProbe, target, links); path && moves(*path)) return *path;

  std::vector<int> of_probe;
  for (std::size_t i = 0; i < sequence.transform_names.size(); ++i)
    if (frames_of(sequence.transform_names[i]).from.starts_with(kProbe)) of_probe.push_back(int(i));
  if (of_probe.size() != 1) fail_without_probe(sequence);
  TransformPath path = direct(sequence, of_probe.front());
  go_on_to_patient(sequence, frames_of(path.front().name).to, path);
  return path;
}

TransformPath named_path(const Sequence& sequence, std::string_view wanted) {
  std::string_view name = wanted;
  if (name.ends_with(kSuffix)) name.remove_suffix(kSuffix.size());
  const FramePair frames = frames_of(name);
  std::optional<TransformPath> path;
  if (const int index = sequence.find(name); index >= 0) path = direct(sequence, index);
  if (!path && !frames.from.empty()) path = find_path(sequence, frames.from, frames.to, PathLinks::all);
  if (!path || !moves(*path))
    throw InputError(sequence.file, "", "no frame has the transform '" + std::string(wanted) + "'",
                     suggest(name, sequence.transform_names));
  go_on_to_patient(sequence, frames.to, *path);
  return *path;
}

std::optional<std::string> why_not_pose(const glm::dmat4& matrix) {
  return why_not_rigid(matrix, kTrackerRange_mm, kRecordedRotationError);
}

/// Converts a matrix to a pose and records its rotation's error.
Pose rounded(const glm::dmat4& matrix, double& worst_error) {
  worst_error = std::max(worst_error, orthonormal_error(glm::dmat3(matrix)));
  return pose_from_matrix(matrix);
}

/// Returns the pose at the end of a path that is ok in a frame. Links are rounded one by one, so that their errors do
/// not add up. A path may lead through a frame that is not in mm, such as an image's pixels. Then the matrix of the
/// whole path has to be rigid.
Pose pose_in(const Sequence& sequence, std::size_t frame, const TransformPath& path, double& worst_error) {
  PoseStatus status = PoseStatus::ok;
  Pose pose;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const glm::dmat4 matrix = matrix_in(sequence, frame, path[i], status);
    if (const auto why = why_not_pose(matrix)) {
      const glm::dmat4 whole = matrix_in(sequence, frame, path, status);
      if (!why_not_pose(whole)) return rounded(whole, worst_error);
      throw InputError(sequence.file,
                       path[i].constant ? "header" : "frame " + std::to_string(sequence.frames[frame].number),
                       path[i].name + "Transform: " + *why,
                       path[i].constant ? "correct the header, or calibrate and record again"
                                        : "calibrate and record again, or mark the frame as INVALID");
    }
    const Pose link = rounded(matrix, worst_error);
    pose = i == 0 ? link : link * pose;
  }
  return pose;
}

void read_pose(const Sequence& sequence, std::size_t frame, const TransformPath& path, ProbeSample& sample,
               RecordingRepairs& repairs) {
  matrix_in(sequence, frame, path, sample.status);
  if (sample.status != PoseStatus::ok) return;
  double error = 0;
  sample.patient_from_probe = pose_in(sequence, frame, path, error);
  if (error <= kRoundingToSixDecimals) return;
  ++repairs.rounded_rotations;
  repairs.worst_rotation_error = std::max(repairs.worst_rotation_error, error);
}

/// Returns the rate for frames without times; 0 if the frames have times.
double assumed_rate_hz(const Sequence& sequence, const RecordingOptions& options) {
  if (sequence.has_times && options.rate_hz > 0)
    throw InputError(sequence.file, "", "its frames have times of their own", "leave '?rate=' out");
  if (sequence.has_times) return 0;
  if (options.rate_hz > 0) return options.rate_hz;
  if (!options.without_times)
    throw InputError(sequence.file, "", "its frames have no Timestamp, so nobody knows how fast the probe moved",
                     "replay it with 'replay:FILE?rate=HZ', or record it again with times");
  return 1;
}

/// Returns whether columns and rows lie as on a screen. Scan lines stored as rows ("FM") are not yet a picture.
bool is_b_mode(const Sequence& sequence) {
  return sequence.image_orientation.empty() || sequence.image_orientation.find_first_of("FNfn") != 0;
}

RecordedImages images_of(const Sequence& sequence, const std::string& probe, const std::filesystem::path& file) {
  RecordedImages images;
  images.file = file;
  images.offset = sequence.image_offset;
  images.form = *sequence.image_form;
  images.mirrored = sequence.image_orientation.find_first_of("Uu") == 0;
  images.upside_down = sequence.image_orientation.find_first_of("Nn") == 1;
  auto path = find_path(sequence, "Image", probe, PathLinks::with_a_status);
  if (!path) path = find_path(sequence, "Image", probe, PathLinks::all);
  images.frames.resize(sequence.frames.size());
  for (std::size_t f = 0; f < sequence.frames.size(); ++f) {
    images.frames[f].number = sequence.frames[f].number;
    if (!path) continue;
    PoseStatus status = PoseStatus::unknown;
    const glm::dmat4 matrix = matrix_in(sequence, f, *path, status);
    if (status == PoseStatus::ok) images.frames[f].probe_from_pixel = matrix;
  }
  return images;
}

RecordedScan scan_of(const Sequence& sequence, ProbeTrack track) {
  // Assigned member by member: g++ 12 destroys the members of a nested aggregate twice if a later initializer throws.
  RecordedScan scan;
  scan.recording.file = sequence.file;
  scan.recording.transform = std::move(track.transform);
  scan.recording.assumed_rate_hz = track.assumed_rate_hz;
  if (sequence.has_times) scan.recording.actions = recorded_actions(sequence);
  scan.recording.repairs = track.repairs;
  scan.samples = std::move(track.samples);
  return scan;
}

}  // namespace

ProbeTrack probe_track(const Sequence& sequence, const RecordingOptions& options) {
  const TransformPath path = options.transform.empty() ? usual_path(sequence) : named_path(sequence, options.transform);
  ProbeTrack track;
  if (const double rate_hz = assumed_rate_hz(sequence, options); rate_hz > 0) track.assumed_rate_hz = rate_hz;
  track.transform = to_string(path);
  track.probe = frames_of(track.transform).from;
  track.repairs.frames_out_of_order = sequence.frames_out_of_order;
  track.repairs.worst_disorder_s = sequence.worst_disorder_s;
  track.samples.resize(sequence.frames.size());
  for (std::size_t f = 0; f < track.samples.size(); ++f) {
    const SequenceFrame& frame = sequence.frames[f];
    ProbeSample& sample = track.samples[f];
    sample.time_s = track.assumed_rate_hz ? double(f) / *track.assumed_rate_hz : frame.time_s;
    sample.buttons = frame.buttons;
    sample.distortion = frame.distortion;
    sample.rejected = frame.rejected;
    read_pose(sequence, f, path, sample, track.repairs);
  }
  return track;
}

std::vector<ProbeSample> probe_samples(const Sequence& sequence, std::string_view transform) {
  RecordingOptions options;
  options.transform = transform;
  return probe_track(sequence, options).samples;
}

std::map<double, std::string> recorded_actions(const Sequence& sequence) {
  std::map<double, std::string> actions;
  for (const SequenceFrame& frame : sequence.frames)
    if (!frame.actions.empty()) actions.emplace(frame.time_s, frame.actions);
  return actions;
}

RecordedScan recorded_scan(const Sequence& sequence, const RecordingOptions& options) {
  return scan_of(sequence, probe_track(sequence, options));
}

RecordedScan read_recorded_scan(const std::filesystem::path& file, const RecordingOptions& options) {
  const SequenceFile read = read_sequence_file(file);
  const Sequence sequence = parse_sequence(read.bytes(), file.string());
  ProbeTrack track = probe_track(sequence, options);
  const std::string probe = track.probe;
  RecordedScan scan = scan_of(sequence, std::move(track));
  scan.recording.file = file.filename().string();
  scan.recording.digest = read.digest;
  if (sequence.image_form && is_b_mode(sequence)) scan.images = images_of(sequence, probe, file);
  return scan;
}

}  // namespace insonate
