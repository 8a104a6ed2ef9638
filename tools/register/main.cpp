// insonate-register: finds where a recording of tracked ultrasound lies in a CT, and how sure that is.

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/alignment/registration.h"
#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/core/new_folder.h"
#include "sim/core/suggest.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/upload.h"
#include "sim/registration/wein_settings_file.h"
#include "sim/volume/ct_reader.h"
#include "tools/cli/pose_file.h"
#include "tools/cli/program.h"
#include "tools/cli/subject.h"
#include "tools/register/comparison_pictures.h"
#include "tools/register/read_sweep.h"
#include "tools/register/result_files.h"
#include "tools/register/start_transform.h"

using namespace insonate;

namespace {

constexpr int kNotConverged = 3;
constexpr std::size_t kShownImages = 4;

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments(
      "Register a recording of tracked ultrasound with a CT: find the map from the recording's frame to the CT's, and "
      "how sure it is. Exits with 3 if the search did not converge.",
      "insonate-register");
  SweepInput input;
  RegistrationSettings settings;
  std::string subject_path, probe_name = "curvilinear", probe_file, image_matrix_file, start_file, landmarks_file,
                            settings_file, measure = "lc2", out;
  std::vector<double> face_pixel;
  std::vector<int> clip;
  std::optional<double> depth_mm;
  std::optional<int> patch;
  bool affine = false;
  arguments.add_option("--case,--ct", subject_path, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  CLI::Option* named = arguments.add_option("--probe", probe_name, "Take the recording to be of this probe")
                           ->type_name(one_of(probe_names()))
                           ->capture_default_str();
  arguments
      .add_option("--probe-file", probe_file,
                  "Read the probe from this file instead (TOML): kind, radius_mm, field_of_view_deg, width_mm and "
                  "depth_mm, as far as that kind has them")
      ->type_name("FILE")
      ->excludes(named);
  arguments.add_option("--depth", depth_mm, "Set the imaging depth of the recording, mm")
      ->check(CLI::Range(10.0, 400.0))
      ->default_str("that of the probe");
  arguments.add_option("--transform", input.transform, "Take this transform of the recording for the probe's pose")
      ->type_name("NAME")
      ->default_str("ProbeToPatient, or a path to it");
  arguments
      .add_option("--image-to-probe", image_matrix_file,
                  "Read how the images lie in the probe's frame from this file: 16 numbers by rows, mm per pixel")
      ->type_name("FILE")
      ->default_str("the recording's own");
  arguments.add_option("--face-pixel", face_pixel, "Set the pixel that shows the middle of the probe's face")
      ->type_name("X,Y")
      ->delimiter(',')
      ->expected(2)
      ->default_str("where the probe's frame has its origin");
  arguments.add_option("--clip", clip, "Take only this part of the images, pixels")
      ->type_name("X,Y,WIDTH,HEIGHT")
      ->delimiter(',')
      ->expected(4)
      ->default_str("all of them");
  CLI::Option* start =
      arguments
          .add_option("--start", start_file,
                      "Read the start from this file: 16 numbers by rows, the map ct_from_sweep in mm (LPS)")
          ->type_name("FILE")
          ->default_str("the recording's own frame");
  arguments
      .add_option("--landmarks", landmarks_file,
                  "Fit the start to landmarks in this file: per landmark x y z in the recording's frame and x y z in "
                  "the CT, mm (LPS)")
      ->type_name("FILE")
      ->excludes(start);
  arguments
      .add_option("--measure", measure,
                  "Compare by LC2 with simulated images, or, as baselines, by mutual information or the correlation "
                  "ratio with the CT's slices")
      ->check(CLI::IsMember({"lc2", "mi", "cr"}))
      ->capture_default_str();
  arguments.add_flag("--affine", affine, "Fit stretches and shears too, after the rigid registration");
  arguments.add_option("--search-mm", settings.search_mm, "Search this far around the start, mm; 0: do not scatter")
      ->check(CLI::Range(0.0, 200.0))
      ->capture_default_str();
  arguments.add_option("--search-deg", settings.search_deg, "Search this far around the start, degrees")
      ->check(CLI::Range(0.0, 90.0))
      ->capture_default_str();
  arguments.add_option("--slices", settings.slices, "Use this many images of the recording, evenly spread")
      ->check(CLI::Range(2, 200))
      ->capture_default_str();
  arguments.add_option("--patch", patch, "Set the side of LC2's patches, pixels of 128 x 96; 0: whole images")
      ->check(CLI::Range(0, 128))
      ->default_str("8");
  arguments
      .add_option("--settings", settings_file,
                  "Read model W's settings from this file (TOML): fields of sim/registration/wein_settings.h")
      ->type_name("FILE");
  arguments.add_option("RECORDING", input.file, "Register this recording (PLUS, 3D Slicer, or insonate)")
      ->type_name("FILE")
      ->required();
  arguments
      .add_option("FOLDER", out,
                  "Write to this new folder: registration.json, ct_from_sweep.tfm and sweep_from_ct.tfm (ITK), "
                  "evaluations.csv, index.html, and scene.mrml for 3D Slicer with ct.nrrd and sweep.nrrd")
      ->type_name("FOLDER")
      ->required();

  const auto work = [&] {
    refuse_taken(out);
    if (!probe_file.empty()) {
      input.probe = read_probe(probe_file);
    } else {
      const Probe* probe = find_probe(probe_name);
      if (!probe)
        throw InputError("--probe", "", "there is no probe named '" + probe_name + "'",
                         suggest(probe_name, probe_names()));
      input.probe = *probe;
    }
    input.depth_mm = depth_mm.value_or(input.probe.depth_mm);
    if (!image_matrix_file.empty()) input.probe_from_pixel = read_image_matrix(image_matrix_file);
    if (!face_pixel.empty()) input.face_pixel = glm::dvec2(face_pixel[0], face_pixel[1]);
    if (!clip.empty()) input.clip = {clip[0], clip[1], clip[2], clip[3]};
    input.slices = settings.slices;
    input.probe.lines = input.width;
    if (!settings_file.empty()) settings.wein = read_wein_settings(settings_file);
    if (patch) settings.wein.similarity_patch = *patch;
    if (const auto why = why_not_valid(settings.wein))
      throw InputError("--patch", "", *why, "give 0, or a number from 4 to 128");
    settings.measure = measure_named(measure);
    settings.freedom = affine ? Freedom::affine : Freedom::rigid;
    glm::dmat4 ct_from_sweep(1.0);
    if (!start_file.empty()) ct_from_sweep = read_pose(start_file).matrix();
    if (!landmarks_file.empty()) ct_from_sweep = start_from_landmarks(landmarks_file);

    const ReadSweep read = read_sweep(input);
    const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
    const Case subject = open_subject(subject_path);
    check_start(subject_path, subject.ct, read.sweep, ct_from_sweep);
    const AcousticVolume volume = make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table);
    const gl::HeadlessContext context;
    SweepRegistration found;
    gl::upload_ct(subject_path, volume.grid, [&] {
      SweepRegistrar registrar(volume, read.sweep, settings);
      found = registrar.from(ct_from_sweep);
      found.seconds += registrar.seconds_to_prepare();
    });

    const std::string sentence = verdict(found);
    write_folder(out, [&](const std::filesystem::path& folder) {
      RegistrationReport report{subject_path, input.file, read, settings, found, {}};
      report.pictures = write_comparison(folder / "pictures", read.sweep, subject.ct, ct_from_sweep,
                                         found.ct_from_sweep, kShownImages);
      write_file(folder / "registration.json", registration_json(report));
      write_file(folder / "ct_from_sweep.tfm", itk_transform(found.ct_from_sweep, sentence));
      write_file(folder / "sweep_from_ct.tfm", itk_transform(glm::inverse(found.ct_from_sweep), sentence));
      write_file(folder / "evaluations.csv", evaluations_csv(found));
      write_file(folder / "index.html", registration_page(report));
      write_file(folder / "scene.mrml", slicer_scene(sentence));
      write_ct(folder / "ct.nrrd", subject.ct);
      write_labels(folder / "sweep.nrrd", volume_of(read.sweep));
    });
    std::printf("%s\nSimilarity (%s): %.4f before, %.4f after. %zu evaluations in %.1f s.\n", sentence.c_str(),
                measure.c_str(), found.similarity_before, found.similarity_after, found.evaluations.size(),
                found.seconds);
    return found.converged() ? 0 : kNotConverged;
  };
  return run_program(arguments, argc, argv, [&] {
    int code = 0;
    gl::within_device(settings_file.empty() ? "command line" : settings_file, "take fewer samples or a smaller CT",
                      [&] { code = work(); });
    return code;
  });
}
