// insonate-render: renders one pose of one patient to a PNG without a window, and optionally writes the stages of the
// picture.

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "sim/acoustics/speckle_file.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/files/files.h"
#include "sim/files/new_folder.h"
#include "sim/files/png.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/sweep_simulator.h"
#include "sim/imaging/upload.h"
#include "sim/model/quality.h"
#include "sim/model/settings_file.h"
#include "sim/reference/reference.h"
#include "sim/volume/ct_reader.h"
#include "sim/wein/wein_settings_file.h"
#include "tools/cli/pose_file.h"
#include "tools/cli/program.h"
#include "tools/cli/subject.h"
#include "tools/render/stage_description.h"
#include "tools/render/stage_files.h"
#include "tools/render/stages.h"
#include "tools/render/sweep_log.h"
#include "tools/render/wein.h"

using namespace insonate;

namespace {

constexpr double kLinearPivot_mm = 30;  // its lines do not meet; the pivot of a hand that rocks the probe

/// Reads the poses of a probe that was swept by hand.
std::vector<Pose> read_sweep(const std::string& file) {
  constexpr std::size_t kMaxPlanes = 2048;
  std::vector<Pose> poses = read_poses(file);
  if (poses.size() < 2 || poses.size() > kMaxPlanes)
    throw InputError(file, "", "it holds " + std::to_string(poses.size()) + " of the 2 to 2048 poses of a sweep",
                     "write a matrix patient_from_probe for each plane, in the order of the sweep");
  return poses;
}

const ReferenceView& choose_view(const Case& subject, const std::string& path, const std::string& name) {
  std::vector<std::string> names;
  for (const ReferenceView& view : subject.views) names.push_back(view.name);
  if (names.empty()) throw InputError(path, "", "no view is marked and no body was found", "give a --pose");
  if (name.empty()) return subject.views.front();
  if (const ReferenceView* view = subject.find_view(name)) return *view;
  throw InputError("--view", "", "there is no view named '" + name + "'", suggest(name, names));
}

struct Rendered {
  Stages<float> stages;
  std::string made_by;
};

Insertion insertion_named(const std::string& name) {
  return name == to_string(Insertion::nearest) ? Insertion::nearest : Insertion::trilinear;
}

Compounding compounding_named(const std::string& name) {
  for (const Compounding each : {Compounding::maximum, Compounding::latest})
    if (name == to_string(each)) return each;
  return Compounding::mean;
}

/// Writes the volume, and prints how well it was swept.
void write_reconstructed(const std::string& file, const std::string& known_file, const ReconstructedLog& made) {
  write_labels(file, made.volume.grey);
  if (!known_file.empty()) write_labels(known_file, made.volume.known);
  const SweepQuality& quality = made.quality;
  if (made.has_times) {
    std::printf("%s\n", quality.verdict().c_str());
    for (const SweepFlaw& flaw : quality.flaws) std::printf("  %s\n", flaw.words().c_str());
  } else {
    std::printf("%zu pictures without times, up to %.1f mm apart.\n", quality.pictures, quality.largest_spacing_mm);
  }
  if (made.left_out > 0) std::printf("Frames without a pose, left out: %zu.\n", made.left_out);
  if (!made.remark.empty()) std::printf("%s\n", made.remark.c_str());
}

constexpr double kMinDepth_mm = 10, kMaxDepth_mm = 400;

/// Throws the errors of reading the settings early, as far as they do not depend on the depth, which may be unknown
/// (0).
void check_settings(const std::string& file, const std::string& model, const Probe& probe, double depth_mm) {
  if (model == "W") {
    read_wein_settings(file);
  } else if (depth_mm > 0) {
    read_settings(file, probe.frequency_mhz, depth_mm);
  } else {
    try {
      read_settings(file, probe.frequency_mhz, kMinDepth_mm);
    } catch (const InputError&) {
      read_settings(file, probe.frequency_mhz, kMaxDepth_mm);
    }
  }
}

/// @param file  what the person who gave the CT calls it
/// @param moved_from  where the probe was in the frames before; empty for a probe at rest
/// @param stored      null for none
Rendered render(const std::string& file, const RenderedScene& scene, const std::vector<Pose>& moved_from,
                const StoredSpeckle* stored) {
  const gl::HeadlessContext context;
  gl::Simulator simulator;
  gl::upload_ct(file, scene.volume.grid, [&] { simulator.set_volume(scene.volume, scene.table); });
  simulator.set_probe(scene.probe, scene.depth_mm);
  simulator.set_settings(scene.settings);
  if (stored) simulator.set_stored_speckle(stored);
  for (const Pose& before : moved_from) {
    simulator.set_pose(before);
    simulator.image_in_motion();
  }
  simulator.set_pose(scene.patient_from_probe);
  if (moved_from.empty()) return {simulator.read_stages(), gl::device_description()};
  const gl::Texture& image = simulator.image_in_motion();
  Image<Rgba8> rgba(image.width(), image.height());
  image.read(GL_RGBA, GL_UNSIGNED_BYTE, rgba.pixels.data(), rgba.pixels.size() * sizeof(Rgba8));
  Rendered rendered;
  rendered.made_by = gl::device_description();
  rendered.stages.grey = Image<std::uint8_t>(rgba.width, rgba.height);
  std::ranges::transform(rgba.pixels, rendered.stages.grey.pixels.begin(), [](const Rgba8& p) { return p[0]; });
  return rendered;
}

/// @param file  what the person who gave the CT calls it
Volume<std::int16_t> render_volume(const std::string& file, const AcousticVolume& volume, const TissueTable& table,
                                   const Sweep& sweep, const Settings& settings, double voxel_mm) {
  constexpr int kLongestSide = 512;
  const Grid grid = sweep_grid(sweep, voxel_mm);
  if (std::max({grid.size.x, grid.size.y, grid.size.z}) > kLongestSide)
    throw InputError("--voxel", "", "the volume would have more than 512 voxels along a side", "take larger voxels");
  const gl::HeadlessContext context;
  gl::SweepSimulator simulator;
  gl::upload_ct(file, volume.grid, [&] { simulator.set_volume(volume, table); });
  simulator.set_sweep(sweep);
  simulator.set_settings(settings);
  simulator.set_grid(grid);
  return simulator.read_grey();
}

Rendered render_by_reference(const RenderedScene& scene, const StoredSpeckle* stored) {
  return {in_single_precision(simulate_reference(trilinear_field(scene.volume), scene.table, scene.probe,
                                                 scene.depth_mm, scene.settings, scene.patient_from_probe, stored)),
          kMadeByReference};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Render one ultrasound image of a patient to a PNG, or a sweep to a volume, without a window.",
                     "insonate-render");
  std::string subject_path, view_name, pose_file, probe_name = "curvilinear", model = "S", settings_file, stages_folder,
                                                  out;
  std::string freehand_file, quality_name = name_of(Quality::balanced);
  std::string speckle_file, moved_file, log_file, image_matrix_file, known_file, insertion = "trilinear",
                                                                                 compounding = "mean";
  std::vector<int> clip;
  SweepLogSettings log;
  // Options of pictures that --sweep-log takes too.
  const std::vector<std::string> shared{"--help", "--probe", "--depth", "--voxel"};
  double depth_mm = 0, sweep_deg = 0, voxel_mm = 1;
  std::optional<double> pivot_mm;
  int planes = 64;
  std::optional<double> gain_db;
  std::optional<int> width, height;
  bool by_reference = false;
  arguments.add_option("--case,--ct", subject_path, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  arguments.add_option("--view", view_name, "Render this view of the case")
      ->type_name("NAME")
      ->default_str("its first view");
  arguments
      .add_option("--pose", pose_file,
                  "Read the pose from this file instead of a view: 16 numbers, row-major patient_from_probe")
      ->type_name("FILE");
  CLI::Option* stored = arguments
                            .add_option("--speckle-volume", speckle_file,
                                        "Take the speckle from this scattering volume of insonate-case speckle. Needs "
                                        "settings with 'waves = false', as the preset 'paper' has them")
                            ->type_name("FILE");
  CLI::Option* moved = arguments
                           .add_option("--moved-from", moved_file,
                                       "Render the probe in motion: the last frames before had the poses of this file, "
                                       "in their order, 16 numbers each as in --pose. Persistence and compounding then "
                                       "show some of them")
                           ->type_name("FILE");
  arguments.add_option("--probe", probe_name, "Use this probe")
      ->type_name(one_of(probe_names()))
      ->capture_default_str();
  arguments.add_option("--depth", depth_mm, "Set the imaging depth, mm")
      ->check(CLI::Range(kMinDepth_mm, kMaxDepth_mm))
      ->default_str("that of the view, or of the probe");
  arguments
      .add_option("--model", model, "Use model S, for training (Shams, Kutter), or model W, for registration (Wein)")
      ->check(CLI::IsMember({"S", "W"}))
      ->capture_default_str();
  arguments
      .add_option(
          "--settings", settings_file,
          "Read the model's settings from this file (TOML). For model S: preset = \"paper\" or \"trainer\", and "
          "fields of sim/model/settings.h that differ from it. For model W: fields of "
          "sim/wein/wein_settings.h")
      ->type_name("FILE")
      ->default_str(
          "those of the trainer without its compounding, persistence, edge enhancement and ring-down, for model W its "
          "own");
  CLI::Option* quality =
      arguments
          .add_option("--quality", quality_name,
                      "Set the cost of a picture, by other numbers of samples and pixels than those of the settings")
          ->check(CLI::IsMember(quality_names()))
          ->capture_default_str();
  CLI::Option* gain = arguments.add_option("--gain", gain_db, "Set the gain, dB")
                          ->check(CLI::Range(-60.0, 60.0))
                          ->default_str("that of the settings, 0");
  arguments.add_option("--width", width, "Set the width of the picture, pixels")
      ->check(CLI::Range(1, 8192))
      ->default_str("that of the settings: 640, for model W 128");
  arguments.add_option("--height", height, "Set the height of the picture, pixels")
      ->check(CLI::Range(1, 8192))
      ->default_str("that of the settings: 480, for model W 96");
  CLI::Option* stages_option =
      arguments
          .add_option("--stages", stages_folder,
                      "Write the data of each stage to this new folder, enough to recompute it: scanlines.json, the "
                      "volume, and NRRD files. For model S, this sets 'skipping' to false")
          ->type_name("FOLDER");
  CLI::Option* reference_flag =
      arguments.add_flag("--reference", by_reference, "Compute by the double-precision reference, without OpenGL");
  CLI::Option* sweep =
      arguments.add_option("--sweep", sweep_deg,
                           "Tilt the plane through this angle, degrees, as a 3D probe does, and write a "
                           "volume: an NRRD of grey levels in the patient's frame (LPS), -1 outside");
  sweep->check(CLI::Range(1.0, 150.0));
  CLI::Option* freehand = arguments
                              .add_option("--freehand", freehand_file,
                                          "Write a volume as --sweep does, from a 2D probe that was swept by hand: "
                                          "read its poses from this file, in their order, 16 numbers each as in --pose")
                              ->type_name("FILE");
  arguments.add_option("--planes", planes, "Set the number of planes of --sweep")
      ->check(CLI::Range(2, 2048))
      ->capture_default_str();
  arguments.add_option("--pivot", pivot_mm, "Set how far behind the probe's face the plane of --sweep turns, mm")
      ->check(CLI::Range(0.0, 200.0))
      ->default_str("where the scan lines meet; 30 for a linear probe");
  arguments.add_option("--voxel", voxel_mm, "Set the size of the volume's voxels, mm")
      ->check(CLI::Range(0.1, 10.0))
      ->capture_default_str();
  for (CLI::Option* of_volume : {sweep, freehand})
    for (CLI::Option* of_picture : {stages_option, reference_flag, moved, stored}) of_volume->excludes(of_picture);
  stored->excludes(stages_option);
  moved->excludes(stages_option)->excludes(reference_flag);
  freehand->excludes(sweep);
  CLI::Option* sweep_log =
      arguments
          .add_option("--sweep-log", log_file,
                      "Write a volume of the images that this recording of a swept probe holds (PLUS, 3D Slicer, or "
                      "insonate --record-images): an NRRD of grey levels from 0 to 255, 0 where nothing was seen. Says "
                      "how evenly the probe was swept. --depth takes only the fan of --probe")
          ->type_name("LOG");
  std::vector<CLI::Option*> of_log{
      arguments.add_option("--transform", log.transform, "Take this transform of the recording for the probe's pose")
          ->type_name("NAME")
          ->default_str("ProbeToPatient, or a path to it"),
      arguments
          .add_option("--image-to-probe", image_matrix_file,
                      "Read how the images lie in the probe's frame from this file: 16 numbers by rows, mm per pixel")
          ->type_name("FILE")
          ->default_str("the recording's own"),
      arguments.add_option("--clip", clip, "Take only this part of the images, pixels")
          ->type_name("X,Y,WIDTH,HEIGHT")
          ->delimiter(',')
          ->expected(4)
          ->default_str("all of them"),
      arguments.add_option("--insertion", insertion, "Insert each pixel into one voxel, or into the eight around it")
          ->check(CLI::IsMember({"nearest", "trilinear"}))
          ->capture_default_str(),
      arguments.add_option("--compounding", compounding, "Take this of several pictures at one voxel")
          ->check(CLI::IsMember({"mean", "maximum", "latest"}))
          ->capture_default_str(),
      arguments
          .add_option("--hole-radius", log.reconstruction.hole_radius_mm,
                      "Fill holes between measured voxels that are up to twice this far apart, mm; 0 fills none")
          ->check(CLI::Range(0.0, 20.0))
          ->capture_default_str(),
      arguments
          .add_option("--beam-width", log.beam_mm,
                      "Call a sweep uneven where its pictures are farther apart than this width of the beam, mm")
          ->check(CLI::Range(0.1, 20.0))
          ->capture_default_str(),
      arguments
          .add_option("--known", known_file,
                      "Write this NRRD too: 2 where a picture shows the voxel, 1 where it was filled, else 0")
          ->type_name("FILE"),
  };
  for (CLI::Option* option : of_log) option->needs(sweep_log);
  for (CLI::Option* other : arguments.get_options())
    if (other != sweep_log && std::find(of_log.begin(), of_log.end(), other) == of_log.end() &&
        std::find(shared.begin(), shared.end(), other->get_name()) == shared.end())
      sweep_log->excludes(other);
  arguments
      .add_option("IMAGE", out,
                  "Write this PNG, with the probe's marker on its left, as clinics show it; for a volume, this NRRD")
      ->type_name("FILE")
      ->required();

  // Writes the stages first, if requested. Their folder gets its final name when the picture is written.
  const auto write_all = [&](const Image<std::uint8_t>& grey, const auto& write_stages_to) {
    const auto write_picture = [&] { write_png(out, mirrored(grey)); };
    if (!*stages_option) return write_picture();
    write_folder(stages_folder, [&](const std::filesystem::path& folder) {
      write_stages_to(folder);
      write_picture();
    });
  };
  const auto work = [&] {
    const Probe* probe = find_probe(probe_name);
    if (!probe)
      throw InputError("--probe", "", "there is no probe named '" + probe_name + "'",
                       suggest(probe_name, probe_names()));
    if (*stages_option) refuse_taken(stages_folder);
    for (const CLI::Option* of_model_s : {quality, gain, sweep, freehand, moved, stored})
      if (model == "W" && *of_model_s)
        throw InputError(of_model_s->get_name(), "", "model W has no such thing", "leave it out or take --model S");
    const bool to_volume = *sweep || *freehand || *sweep_log;
    const std::string ending = to_volume ? ".nrrd" : ".png";
    if (std::filesystem::path(out).extension() != ending)
      throw InputError(out, "", to_volume ? "a sweep is written as NRRD" : "a picture is written as PNG",
                       "name a file that ends in " + ending);
    if (*sweep_log) {
      if (!known_file.empty() && std::filesystem::path(known_file).extension() != ".nrrd")
        throw InputError(known_file, "", "a volume is written as NRRD", "name a file that ends in .nrrd");
      if (!image_matrix_file.empty()) log.probe_from_pixel = read_image_matrix(image_matrix_file);
      if (!clip.empty()) log.clip = {clip[0], clip[1], clip[2], clip[3]};
      if (depth_mm > 0) log.probe = *probe;
      log.depth_mm = depth_mm;
      log.voxel_mm = voxel_mm;
      log.reconstruction.insertion = insertion_named(insertion);
      log.reconstruction.compounding = compounding_named(compounding);
      write_reconstructed(out, known_file, reconstruct_log(log_file, log));
      return;
    }
    // The patient is read last, because it may take a minute to build.
    std::vector<Pose> by_hand;
    if (*freehand)
      by_hand = read_sweep(freehand_file);
    else if (!pose_file.empty())
      by_hand = {read_pose(pose_file)};
    const std::vector<Pose> moved_from = *moved ? read_poses(moved_file) : std::vector<Pose>();
    if (!by_hand.empty() && depth_mm == 0) depth_mm = probe->depth_mm;
    if (!settings_file.empty()) check_settings(settings_file, model, *probe, depth_mm);
    const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
    const Case subject = open_subject(subject_path);
    Pose pose;
    if (!by_hand.empty()) {
      pose = by_hand.front();
    } else {
      const ReferenceView& view = choose_view(subject, subject_path, view_name);
      pose = view.patient_from_probe;
      if (depth_mm == 0) depth_mm = view.depth_mm;
    }
    if (depth_mm == 0) depth_mm = probe->depth_mm;

    const std::vector<std::string> tissue_of = tissue_by_label(subject);
    const auto volume_of = [&](bool structure) {
      return make_acoustic_volume(subject.ct, subject.labels, tissue_of, table, structure);
    };
    if (model == "W") {
      WeinSettings settings = settings_file.empty() ? WeinSettings{} : read_wein_settings(settings_file);
      settings.image_width = width.value_or(settings.image_width);
      settings.image_height = height.value_or(settings.image_height);
      const AcousticVolume volume = volume_of(false);
      const WeinScene scene{volume, *probe, depth_mm, settings, pose};
      const RenderedWein rendered = render_wein(subject_path, scene, by_reference);
      write_all(rendered.stages.grey, [&](const auto& folder) { write_stages(folder, scene, rendered); });
      return;
    }
    Settings settings = settings_file.empty() ? trainer_settings(probe->frequency_mhz, depth_mm)
                                              : read_settings(settings_file, probe->frequency_mhz, depth_mm);
    settings = at_quality(settings, quality_named(quality_name));
    settings.gain_db = gain_db.value_or(settings.gain_db);
    settings.image_width = width.value_or(settings.image_width);
    settings.image_height = height.value_or(settings.image_height);

    const AcousticVolume volume = volume_of(settings.waves);
    if (to_volume) {
      const double pivot =
          pivot_mm.value_or(probe->kind == ProbeKind::linear ? kLinearPivot_mm : apex_behind_mm(*probe));
      const Sweep swept{*probe, depth_mm, *freehand ? by_hand : swept_planes(pose, planes, sweep_deg, pivot)};
      if (const auto back = reversal_index(swept))
        throw InputError(freehand_file, "pose " + std::to_string(*back + 1), "the sweep goes back here",
                         "keep the poses of one way, in their order");
      write_ct(out, render_volume(subject_path, volume, table, swept, settings, voxel_mm));
      return;
    }
    std::optional<StoredSpeckle> speckle;
    if (*stored) {
      if (settings.waves || !settings.speckle)
        throw InputError("--speckle-volume", "", "these settings have no use for a scattering volume",
                         "take --settings with preset = 'paper', or with waves = false and speckle = true");
      const Transducer transducer = bundled_transducer(probe->name);
      speckle = read_speckle_file(speckle_file, {digest_of(volume), identity_of(transducer), settings.speckle_seed});
    }
    // Where samples are skipped, R uses a mean normal, which users cannot recompute.
    if (*stages_option) settings.skipping = false;
    const RenderedScene scene{volume, subject.labels, tissue_of, table, *probe, depth_mm, settings, pose};
    const auto [stages, made_by] = by_reference
                                       ? render_by_reference(scene, speckle ? &*speckle : nullptr)
                                       : render(subject_path, scene, moved_from, speckle ? &*speckle : nullptr);
    write_all(stages.grey, [&, &stages = stages, &made_by = made_by](const auto& folder) {
      write_stages(folder, scene, stages, made_by);
    });
  };
  return run_program(arguments, argc, argv, [&] {
    gl::within_device(settings_file.empty() ? "command line" : settings_file,
                      "take fewer samples, pixels or planes, or larger voxels", work);
    return 0;
  });
}
