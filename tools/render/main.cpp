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
#include "tools/render/options.h"
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

/// Throws InputError if an option does not go with the model, or a name with what is written under it.
void check(const RenderOptions& given) {
  if (*given.with_stages) refuse_taken(given.stages_folder);
  for (const CLI::Option* of_model_s :
       {given.with_quality, given.with_gain, given.sweep, given.freehand, given.moved, given.with_speckle})
    if (given.model == "W" && *of_model_s)
      throw InputError(of_model_s->get_name(), "", "model W has no such thing", "leave it out or take --model S");
  const std::string ending = given.to_volume() ? ".nrrd" : ".png";
  if (std::filesystem::path(given.out).extension() != ending)
    throw InputError(given.out, "", given.to_volume() ? "a sweep is written as NRRD" : "a picture is written as PNG",
                     "name a file that ends in " + ending);
  if (!given.known_file.empty() && std::filesystem::path(given.known_file).extension() != ".nrrd")
    throw InputError(given.known_file, "", "a volume is written as NRRD", "name a file that ends in .nrrd");
}

void reconstruct(const RenderOptions& given, const Probe& probe) {
  SweepLogSettings settings = given.log;
  if (!given.image_matrix_file.empty()) settings.probe_from_pixel = read_image_matrix(given.image_matrix_file);
  if (!given.clip.empty()) settings.clip = {given.clip[0], given.clip[1], given.clip[2], given.clip[3]};
  if (given.depth_mm > 0) settings.probe = probe;
  settings.depth_mm = given.depth_mm;
  settings.voxel_mm = given.voxel_mm;
  settings.reconstruction.insertion = insertion_named(given.insertion);
  settings.reconstruction.compounding = compounding_named(given.compounding);
  write_reconstructed(given.out, given.known_file, reconstruct_log(given.log_file, settings));
}

/// Writes the picture, and first the stages, if requested. Their folder gets its name when the picture is written.
template <typename WriteStages>
void write_all(const RenderOptions& given, const Image<std::uint8_t>& grey, const WriteStages& write_stages_to) {
  const auto write_picture = [&] { write_png(given.out, mirrored(grey)); };
  if (!*given.with_stages) return write_picture();
  write_folder(given.stages_folder, [&](const std::filesystem::path& folder) {
    write_stages_to(folder);
    write_picture();
  });
}

/// A patient and where the probe is.
struct Setting {
  const Probe& probe;
  Case subject;
  std::vector<std::string> tissue_of;
  TissueTable table;
  double depth_mm;
  Pose pose;
  std::vector<Pose> by_hand;     ///< of --freehand, or the one of --pose
  std::vector<Pose> moved_from;  ///< of --moved-from

  AcousticVolume volume(bool structure) const {
    return make_acoustic_volume(subject.ct, subject.labels, tissue_of, table, structure);
  }
};

/// Reads the patient last, because it may take a minute to build.
Setting read_setting(const RenderOptions& given, const Probe& probe) {
  std::vector<Pose> by_hand;
  if (*given.freehand)
    by_hand = read_sweep(given.freehand_file);
  else if (!given.pose_file.empty())
    by_hand = {read_pose(given.pose_file)};
  std::vector<Pose> moved_from = *given.moved ? read_poses(given.moved_file) : std::vector<Pose>();
  double depth_mm = given.depth_mm;
  if (!by_hand.empty() && depth_mm == 0) depth_mm = probe.depth_mm;
  if (!given.settings_file.empty()) check_settings(given.settings_file, given.model, probe, depth_mm);
  TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  Case subject = open_subject(given.subject);
  Pose pose;
  if (!by_hand.empty()) {
    pose = by_hand.front();
  } else {
    const ReferenceView& view = choose_view(subject, given.subject, given.view);
    pose = view.patient_from_probe;
    if (depth_mm == 0) depth_mm = view.depth_mm;
  }
  if (depth_mm == 0) depth_mm = probe.depth_mm;
  std::vector<std::string> tissue_of = tissue_by_label(subject);
  return {probe, std::move(subject), std::move(tissue_of), std::move(table), depth_mm,
          pose,  std::move(by_hand), std::move(moved_from)};
}

void render_model_w(const RenderOptions& given, const Setting& setting) {
  WeinSettings settings = given.settings_file.empty() ? WeinSettings{} : read_wein_settings(given.settings_file);
  settings.image_width = given.width.value_or(settings.image_width);
  settings.image_height = given.height.value_or(settings.image_height);
  const AcousticVolume volume = setting.volume(false);
  const WeinScene scene{volume, setting.probe, setting.depth_mm, settings, setting.pose};
  const RenderedWein rendered = render_wein(given.subject, scene, given.by_reference);
  write_all(given, rendered.stages.grey, [&](const auto& folder) { write_stages(folder, scene, rendered); });
}

Settings settings_of(const RenderOptions& given, const Setting& setting) {
  const double frequency_mhz = setting.probe.frequency_mhz;
  Settings settings = given.settings_file.empty() ? trainer_settings(frequency_mhz, setting.depth_mm)
                                                  : read_settings(given.settings_file, frequency_mhz, setting.depth_mm);
  settings = at_quality(settings, quality_named(given.quality));
  settings.gain_db = given.gain_db.value_or(settings.gain_db);
  settings.image_width = given.width.value_or(settings.image_width);
  settings.image_height = given.height.value_or(settings.image_height);
  return settings;
}

void render_sweep(const RenderOptions& given, const Setting& setting) {
  const Probe& probe = setting.probe;
  const Settings settings = settings_of(given, setting);
  const AcousticVolume volume = setting.volume(settings.waves);
  const double pivot =
      given.pivot_mm.value_or(probe.kind == ProbeKind::linear ? kLinearPivot_mm : apex_behind_mm(probe));
  const Sweep swept{
      probe, setting.depth_mm,
      *given.freehand ? setting.by_hand : swept_planes(setting.pose, given.planes, given.sweep_deg, pivot)};
  if (const auto back = reversal_index(swept))
    throw InputError(given.freehand_file, "pose " + std::to_string(*back + 1), "the sweep goes back here",
                     "keep the poses of one way, in their order");
  write_ct(given.out, render_volume(given.subject, volume, setting.table, swept, settings, given.voxel_mm));
}

std::optional<StoredSpeckle> read_speckle(const RenderOptions& given, const Settings& settings, const Probe& probe,
                                          const AcousticVolume& volume) {
  if (!*given.with_speckle) return std::nullopt;
  if (settings.waves || !settings.speckle)
    throw InputError("--speckle-volume", "", "these settings have no use for a scattering volume",
                     "take --settings with preset = 'paper', or with waves = false and speckle = true");
  const Transducer transducer = bundled_transducer(probe.name);
  return read_speckle_file(given.speckle_file, {digest_of(volume), identity_of(transducer), settings.speckle_seed});
}

void render_picture(const RenderOptions& given, const Setting& setting) {
  Settings settings = settings_of(given, setting);
  const AcousticVolume volume = setting.volume(settings.waves);
  const std::optional<StoredSpeckle> speckle = read_speckle(given, settings, setting.probe, volume);
  const StoredSpeckle* const stored = speckle ? &*speckle : nullptr;
  // Where samples are skipped, R uses a mean normal, which users cannot recompute.
  if (*given.with_stages) settings.skipping = false;
  const RenderedScene scene{volume,        setting.subject.labels, setting.tissue_of, setting.table,
                            setting.probe, setting.depth_mm,       settings,          setting.pose};
  const Rendered rendered = given.by_reference ? render_by_reference(scene, stored)
                                               : render(given.subject, scene, setting.moved_from, stored);
  write_all(given, rendered.stages.grey,
            [&](const auto& folder) { write_stages(folder, scene, rendered.stages, rendered.made_by); });
}

void make(const RenderOptions& given) {
  const Probe* probe = find_probe(given.probe);
  if (!probe)
    throw InputError("--probe", "", "there is no probe named '" + given.probe + "'",
                     suggest(given.probe, probe_names()));
  check(given);
  if (*given.sweep_log) return reconstruct(given, *probe);
  const Setting setting = read_setting(given, *probe);
  if (given.model == "W") return render_model_w(given, setting);
  if (given.to_volume()) return render_sweep(given, setting);
  render_picture(given, setting);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App arguments("Render one ultrasound image of a patient to a PNG, or a sweep to a volume, without a window.",
                     "insonate-render");
  RenderOptions given;
  add_options(arguments, given);
  return run_program(arguments, argc, argv, [&] {
    gl::within_device(given.settings_file.empty() ? "command line" : given.settings_file,
                      "take fewer samples, pixels or planes, or larger voxels", [&] { make(given); });
    return 0;
  });
}
