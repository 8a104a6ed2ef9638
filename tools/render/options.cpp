#include "tools/render/options.h"

#include <algorithm>

#include "sim/probe/probe.h"

namespace insonate {
namespace {

void add_picture_options(CLI::App& arguments, RenderOptions& given) {
  arguments.add_option("--case,--ct", given.subject, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  arguments.add_option("--view", given.view, "Render this view of the case")
      ->type_name("NAME")
      ->default_str("its first view");
  arguments
      .add_option("--pose", given.pose_file,
                  "Read the pose from this file instead of a view: 16 numbers, row-major patient_from_probe")
      ->type_name("FILE");
  given.with_speckle = arguments
                           .add_option("--speckle-volume", given.speckle_file,
                                       "Take the speckle from this scattering volume of insonate-case speckle. Needs "
                                       "settings with 'waves = false', as the preset 'paper' has them")
                           ->type_name("FILE");
  given.moved = arguments
                    .add_option("--moved-from", given.moved_file,
                                "Render the probe in motion: the last frames before had the poses of this file, "
                                "in their order, 16 numbers each as in --pose. Persistence and compounding then "
                                "show some of them")
                    ->type_name("FILE");
  arguments.add_option("--probe", given.probe, "Use this probe")
      ->type_name(one_of(probe_names()))
      ->capture_default_str();
  arguments.add_option("--depth", given.depth_mm, "Set the imaging depth, mm")
      ->check(CLI::Range(kMinDepth_mm, kMaxDepth_mm))
      ->default_str("that of the view, or of the probe");
  arguments
      .add_option("--model", given.model,
                  "Use model S, for training (Shams, Kutter), or model W, for registration (Wein)")
      ->check(CLI::IsMember({"S", "W"}))
      ->capture_default_str();
  arguments
      .add_option(
          "--settings", given.settings_file,
          "Read the model's settings from this file (TOML). For model S: preset = \"paper\" or \"trainer\", and "
          "fields of sim/model/settings.h that differ from it. For model W: fields of "
          "sim/wein/wein_settings.h")
      ->type_name("FILE")
      ->default_str(
          "those of the trainer without its compounding, persistence, edge enhancement and ring-down, for model W its "
          "own");
  given.with_quality =
      arguments
          .add_option("--quality", given.quality,
                      "Set the cost of a picture, by other numbers of samples and pixels than those of the settings")
          ->check(CLI::IsMember(quality_names()))
          ->capture_default_str();
  given.with_gain = arguments.add_option("--gain", given.gain_db, "Set the gain, dB")
                        ->check(CLI::Range(-60.0, 60.0))
                        ->default_str("that of the settings, 0");
  arguments.add_option("--width", given.width, "Set the width of the picture, pixels")
      ->check(CLI::Range(1, 8192))
      ->default_str("that of the settings: 640, for model W 128");
  arguments.add_option("--height", given.height, "Set the height of the picture, pixels")
      ->check(CLI::Range(1, 8192))
      ->default_str("that of the settings: 480, for model W 96");
  given.with_stages =
      arguments
          .add_option("--stages", given.stages_folder,
                      "Write the data of each stage to this new folder, enough to recompute it: scanlines.json, the "
                      "volume, and NRRD files. For model S, this sets 'skipping' to false")
          ->type_name("FOLDER");
  given.reference = arguments.add_flag("--reference", given.by_reference,
                                       "Compute by the double-precision reference, without OpenGL");
}

void add_volume_options(CLI::App& arguments, RenderOptions& given) {
  given.sweep = arguments.add_option("--sweep", given.sweep_deg,
                                     "Tilt the plane through this angle, degrees, as a 3D probe does, and write a "
                                     "volume: an NRRD of grey levels in the patient's frame (LPS), -1 outside");
  given.sweep->check(CLI::Range(1.0, 150.0));
  given.freehand = arguments
                       .add_option("--freehand", given.freehand_file,
                                   "Write a volume as --sweep does, from a 2D probe that was swept by hand: "
                                   "read its poses from this file, in their order, 16 numbers each as in --pose")
                       ->type_name("FILE");
  arguments.add_option("--planes", given.planes, "Set the number of planes of --sweep")
      ->check(CLI::Range(2, 2048))
      ->capture_default_str();
  arguments.add_option("--pivot", given.pivot_mm, "Set how far behind the probe's face the plane of --sweep turns, mm")
      ->check(CLI::Range(0.0, 200.0))
      ->default_str("where the scan lines meet; 30 for a linear probe");
  arguments.add_option("--voxel", given.voxel_mm, "Set the size of the volume's voxels, mm")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  for (CLI::Option* of_volume : {given.sweep, given.freehand})
    for (CLI::Option* of_picture : {given.with_stages, given.reference, given.moved, given.with_speckle})
      of_volume->excludes(of_picture);
  given.with_speckle->excludes(given.with_stages);
  given.moved->excludes(given.with_stages)->excludes(given.reference);
  given.freehand->excludes(given.sweep);
}

void add_log_options(CLI::App& arguments, RenderOptions& given) {
  // Options of pictures that --sweep-log takes too.
  const std::vector<std::string> shared{"--help", "--probe", "--depth", "--voxel"};
  given.sweep_log =
      arguments
          .add_option("--sweep-log", given.log_file,
                      "Write a volume of the images that this recording of a swept probe holds (PLUS, 3D Slicer, or "
                      "insonate --record-images): an NRRD of grey levels from 0 to 255, 0 where nothing was seen. Says "
                      "how evenly the probe was swept. --depth takes only the fan of --probe")
          ->type_name("LOG");
  std::vector<CLI::Option*> of_log{
      arguments
          .add_option("--transform", given.log.transform, "Take this transform of the recording for the probe's pose")
          ->type_name("NAME")
          ->default_str("ProbeToPatient, or a path to it"),
      arguments
          .add_option("--image-to-probe", given.image_matrix_file,
                      "Read how the images lie in the probe's frame from this file: 16 numbers by rows, mm per pixel")
          ->type_name("FILE")
          ->default_str("the recording's own"),
      arguments.add_option("--clip", given.clip, "Take only this part of the images, pixels")
          ->type_name("X,Y,WIDTH,HEIGHT")
          ->delimiter(',')
          ->expected(4)
          ->default_str("all of them"),
      arguments
          .add_option("--insertion", given.insertion, "Insert each pixel into one voxel, or into the eight around it")
          ->check(CLI::IsMember({"nearest", "trilinear"}))
          ->capture_default_str(),
      arguments.add_option("--compounding", given.compounding, "Take this of several pictures at one voxel")
          ->check(CLI::IsMember({"mean", "maximum", "latest"}))
          ->capture_default_str(),
      arguments
          .add_option("--hole-radius", given.log.reconstruction.hole_radius_mm,
                      "Fill holes between measured voxels that are up to twice this far apart, mm; 0 fills none")
          ->check(CLI::Range(0.0, 20.0))
          ->capture_default_str(),
      arguments
          .add_option("--beam-width", given.log.beam_mm,
                      "Call a sweep uneven where its pictures are farther apart than this width of the beam, mm")
          ->check(CLI::Range(0.1, 20.0))
          ->capture_default_str(),
      arguments
          .add_option("--known", given.known_file,
                      "Write this NRRD too: 2 where a picture shows the voxel, 1 where it was filled, else 0")
          ->type_name("FILE"),
  };
  for (CLI::Option* option : of_log) option->needs(given.sweep_log);
  for (CLI::Option* other : arguments.get_options())
    if (other != given.sweep_log && std::find(of_log.begin(), of_log.end(), other) == of_log.end() &&
        std::find(shared.begin(), shared.end(), other->get_name()) == shared.end())
      given.sweep_log->excludes(other);
}

}  // namespace

void add_options(CLI::App& arguments, RenderOptions& given) {
  add_picture_options(arguments, given);
  add_volume_options(arguments, given);
  add_log_options(arguments, given);
  arguments
      .add_option("IMAGE", given.out,
                  "Write this PNG, with the probe's marker on its left, as clinics show it; for a volume, this NRRD")
      ->type_name("FILE")
      ->required();
}

}  // namespace insonate
