// insonate-register: finds where a recording of tracked ultrasound lies in a CT, and how sure that is.

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/files/new_folder.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/upload.h"
#include "sim/registration/free_form.h"
#include "sim/registration/registration.h"
#include "sim/volume/ct_reader.h"
#include "sim/wein/wein_settings_file.h"
#include "tools/cli/pose_file.h"
#include "tools/cli/program.h"
#include "tools/cli/subject.h"
#include "tools/register/comparison_pictures.h"
#include "tools/register/read_sweep.h"
#include "tools/register/read_volume.h"
#include "tools/register/result_files.h"
#include "tools/register/start_transform.h"
#include "tools/register/sweep_options.h"

using namespace insonate;

namespace {

constexpr int kNotConverged = 3;
constexpr double kContradicting_mm = 10;           // apart: what a person points at twice is nearer
constexpr double kMentioned = 0.005, kMuch = 0.5;  // of the images' pixels, where the CT ends

/// Returns the program's arguments as a shell would take them.
std::string command_line(int argc, char** argv) {
  std::string line = "insonate-register";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain =
        argument.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,:=+@%") ==
            std::string::npos &&
        !argument.empty();
    std::string quoted;
    for (const char c : argument) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += " " + (plain ? argument : "'" + quoted + "'");
  }
  return line;
}

// Refuses a sweep to which no deformation can be fitted.
void check_deformable(const std::string& file, const TrackedSweep& sweep, double spacing_mm) {
  if (sweep.images.size() < kMinFreeFormImages)
    throw InputError(
        file, "", formatted("a deformation needs %zu images; there are %zu", kMinFreeFormImages, sweep.images.size()),
        "record a longer sweep, or leave out --free-form");
  const std::size_t points = field_over(target_points(sweep), spacing_mm).control_mm.size();
  if (points > kMaxControlPoints)
    throw InputError("--free-form", "",
                     formatted("the sweep would need %zu control points; %zu are the most", points, kMaxControlPoints),
                     "place them farther apart");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments(
      "Register a recording of tracked ultrasound with a CT: find the map from the recording's frame to the CT's, and "
      "how sure it is. Exits with 3 if the search did not converge.",
      "insonate-register");
  RegistrationSettings settings;
  SweepOptions sweep;
  std::string subject_path, transform, settings_file, poses_file, mask_volume, measure = "lc2", recording, out;
  std::vector<double> beam;
  std::optional<int> patch;
  bool affine = false;
  std::optional<double> spacing_mm;
  FreeFormSettings free_form;
  arguments.add_option("--case,--ct", subject_path, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  arguments.add_option("--transform", transform, "Take this transform of the recording for the probe's pose")
      ->type_name("NAME")
      ->default_str("the way from Probe to Patient, else to Reference, else to Tracker");
  declare_sweep_options(arguments, sweep);
  arguments
      .add_option("--poses", poses_file,
                  "Read where the probe was in each image of DICOM ultrasound from this file: per image 16 numbers by "
                  "rows, the map sweep_from_probe in mm (LPS)")
      ->type_name("FILE");
  arguments
      .add_option("--mask-volume", mask_volume,
                  "Use only the pixels whose points have a label above 0 in this label map of the recording's frame "
                  "(NRRD, MetaImage, NIfTI)")
      ->type_name("FILE");
  CLI::Option* along = arguments
                           .add_option("--beam", beam,
                                       "Take RECORDING to be a 3D ultrasound volume (NRRD, MetaImage, NIfTI) in whose "
                                       "middle the sound ran in this direction of its frame (LPS). Its probe, and "
                                       "how its planes lie, are found from its outline")
                           ->type_name("X,Y,Z")
                           ->delimiter(',')
                           ->expected(3);
  for (const char* of_images : {"--probe", "--probe-file", "--depth", "--image-to-probe", "--face-pixel", "--clip",
                                "--mask", "--transform", "--poses"})
    along->excludes(arguments.get_option(of_images));
  arguments
      .add_option("--measure", measure,
                  "Compare by LC2 with simulated images, or, as baselines, by mutual information or the correlation "
                  "ratio with the CT's slices")
      ->check(CLI::IsMember({"lc2", "mi", "cr"}))
      ->capture_default_str();
  arguments.add_flag("--affine", affine, "Fit stretches and shears too, after the rigid registration");
  CLI::Option* free =
      arguments
          .add_option("--free-form", spacing_mm,
                      "After an affine registration, fit a smooth deformation by control points this far apart, mm")
          ->type_name("MM")
          ->check(CLI::Range(8.0, 100.0));
  arguments
      .add_option("--smoothness", free_form.smoothness_mm2,
                  "Set the weight of the deformation's bending energy against the similarity, mm^2")
      ->type_name("MM2")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str()
      ->needs(free);
  arguments
      .add_option("--search-mm", settings.search_mm,
                  "Search this far around the start, mm; 0 with --search-deg 0 follows the start alone, which does "
                  "not converge")
      ->check(CLI::Range(0.0, 200.0))
      ->capture_default_str();
  arguments.add_option("--search-deg", settings.search_deg, "Search this far around the start, degrees")
      ->check(CLI::Range(0.0, 90.0))
      ->capture_default_str();
  arguments
      .add_option("--slices", settings.slices,
                  "Use this many images of the recording, evenly spread; with --free-form twice as many")
      ->check(CLI::Range(2, 200))
      ->capture_default_str();
  arguments.add_option("--patch", patch, "Set the side of LC2's patches, pixels of 128 x 96; 0: whole images")
      ->check(CLI::Range(0, 128))
      ->default_str("8");
  arguments
      .add_option("--settings", settings_file,
                  "Read model W's settings from this file (TOML): fields of sim/wein/wein_settings.h")
      ->type_name("FILE");
  arguments
      .add_option(
          "RECORDING", recording,
          "Register this recording (PLUS, 3D Slicer, or insonate), with --poses this clip of DICOM ultrasound, or "
          "with --beam this volume")
      ->type_name("FILE")
      ->required();
  arguments
      .add_option("FOLDER", out,
                  "Write to this new folder: registration.json, ct_from_sweep and sweep_from_ct for ITK (.tfm and .h5, "
                  "and .nrrd if it is deformed), evaluations.csv, index.html, and scene.mrml for 3D Slicer with "
                  "ct.nrrd and sweep.nrrd")
      ->type_name("FOLDER")
      ->required();

  const auto work = [&] {
    refuse_taken(out);
    refuse_unwritable(out);
    SweepInput input = sweep.input();
    input.file = recording;
    input.transform = transform;
    if (!poses_file.empty()) {
      check_is_file(recording);
      if (!is_dicom_sweep(recording))
        throw InputError("--poses", "", "they are for DICOM ultrasound; a recording has poses of its own",
                         "leave it out");
      input.poses = read_poses(poses_file, "sweep_from_probe");
    }
    input.slices = settings.slices;
    if (!settings_file.empty()) settings.wein = read_wein_settings(settings_file);
    if (patch) settings.wein.similarity_patch = *patch;
    if (const auto why = why_not_valid(settings.wein))
      throw InputError("--patch", "", *why, "give 0, or a number from 4 to 128");
    settings.measure = measure_named(measure);
    settings.freedom = affine || spacing_mm ? Freedom::affine : Freedom::rigid;
    if (spacing_mm) {
      if (settings.measure != Measure::lc2)
        throw InputError("--free-form", "", "a deformation is fitted by LC2 alone", "leave out --measure");
      if (settings.wein.similarity_patch == 0)
        throw InputError("--free-form", "", "a deformation is fitted by patches", "give --patch from 4 to 128");
      free_form.spacing_mm = *spacing_mm;
      free_form.wein = settings.wein;
      input.slices = 2 * settings.slices;  // half of them judge
    }
    const StartTransform start = sweep.start();
    const glm::dmat4& ct_from_sweep = start.ct_from_sweep;

    const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
    const Case subject = open_subject(subject_path);
    ReadSweep read =
        beam.empty() ? read_sweep(input) : read_volume_sweep(recording, glm::dvec3(beam[0], beam[1], beam[2]), input);
    if (!mask_volume.empty()) keep_labelled(read.sweep, read_labels(mask_volume), mask_volume);
    if (start.landmark_error_mm)
      std::printf("Landmarks: fitted within %.1f mm (root mean square)%s.\n", *start.landmark_error_mm,
                  *start.landmark_error_mm > kContradicting_mm
                      ? "; they contradict each other: see that a line's points are of one landmark, the CT's in LPS"
                      : "");
    if (!read.transform.empty()) std::printf("Transform of the probe: %s.\n", read.transform.c_str());
    if (read.fan) std::printf("Found in the images: %s.\n", description(*read.fan).c_str());
    if (!read.found_in_volume.empty()) std::printf("Found in the volume: %s.\n", read.found_in_volume.c_str());
    check_start(subject_path, subject.ct, read.sweep, ct_from_sweep);
    read.share_at_ends = leave_out_ends(read.sweep, subject.ct, ct_from_sweep);
    if (read.sweep.images.size() < 2)
      throw InputError(recording, "", "at the start fewer than two images show what lies in the CT",
                       "give a nearer --start, or a CT of the region that was scanned");
    if (spacing_mm) check_deformable(recording, read.sweep, *spacing_mm);
    if (read.share_at_ends > kMentioned)
      std::printf("Left out: %.0f %% of the images, which lie where the CT ends.\n", 100 * read.share_at_ends);
    const AcousticVolume volume = make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table);
    const gl::HeadlessContext context;
    SweepRegistration found;
    std::optional<FreeFormRegistration> deformed;
    gl::upload_ct(subject_path, volume.grid, [&] {
      SweepRegistrar registrar(volume, read.sweep, settings);
      found = registrar.from(ct_from_sweep);
      found.seconds += registrar.seconds_to_prepare();
      if (read.share_at_ends > kMuch)
        found.doubts.emplace_back("at the start most of what the images show lies where the CT ends");
      if (spacing_mm && found.converged()) deformed = fit_free_form(volume, read.sweep, found.ct_from_sweep, free_form);
    });

    const RegistrationReport report{subject_path,
                                    recording,
                                    read,
                                    settings,
                                    found,
                                    {},
                                    deformed ? &*deformed : nullptr,
                                    &free_form,
                                    command_line(argc, argv),
                                    start.landmark_error_mm,
                                    gl::device_description()};
    write_registration(out, report, subject.ct);
    std::printf("%s\nSimilarity (%s): %.4f before, %.4f after. %zu evaluations in %.1f s.\n", verdict(report).c_str(),
                measure.c_str(), found.similarity_before, found.similarity_after, found.evaluations.size(),
                found.seconds);
    if (deformed)
      std::printf("Deformation: %zu evaluations in %.1f s.\n", deformed->evaluations.size(), deformed->seconds);
    return found.converged() ? 0 : kNotConverged;
  };
  return run_program(arguments, argc, argv, [&] {
    int code = 0;
    gl::within_device(settings_file.empty() ? "command line" : settings_file, "take fewer samples or a smaller CT",
                      [&] { code = work(); });
    return code;
  });
}
