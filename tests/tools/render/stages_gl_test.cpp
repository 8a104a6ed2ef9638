// Tests what insonate-render --stages writes of model S: each file has the form that docs/stages.md states, and holds
// the stage that it is named after. The formulas themselves are tested in tests/reference and tests/accuracy.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

#include "sim/core/hash.h"
#include "sim/model/compounding.h"
#include "sim/model/display_filter.h"
#include "sim/model/mirror_image.h"
#include "sim/model/noise.h"
#include "sim/model/refraction.h"
#include "sim/model/reverberation.h"
#include "sim/model/scatterers.h"
#include "sim/model/waves.h"
#include "sim/reference/wave_reference.h"
#include "sim/tissue/ct_noise.h"
#include "sim/volume/ct_reader.h"
#include "sim/volume/open_case.h"
#include "tests/imaging/stage_parity.h"
#include "tests/tools/render/stage_folder.h"
#include "tests/tools/render/synthetic_ct.h"

using namespace insonate;
using namespace insonate::test;

namespace {

// Every effect that has a file of its own, through a slice of three planes that bend. Noise is loud enough to be
// visible in the picture. Parity allows for exact filtering alone (tests/imaging/parity.h).
const View kSlice = {
    "curvilinear",
    60,
    // rotated about the beam, and pressed in until the fan's corners are under the skin
    {{{0.96, 0, -0.28}, {0, 1, 0}, {0.28, 0, 0.96}}, {-4, 9, 1}},
    "preset = 'trainer'\nwaves = false\nsamples = 240\nreflection_length_mm = 0.7\ngel_mm = 3.1\nslice_planes = 3\n"
    "slice_thickness_mm = 4\nelevation_focus_mm = 35\nedge_shadow = true\nreverberation = true\nface_reflection = 1\n"
    "electronic_noise = true\nnoise_db = -70\nclutter = true\nclutter_db = -10\n"
    "tgc_db = [0, 2, 5, 9, 14, 20, 27, 35]\ngain_db = 4\nimage_width = 160\nimage_height = 120\nexact_filter = true\n"};

// The same with waves, and without the elevation focus.
const View kWaves = {"curvilinear", kSlice.depth_mm, kSlice.patient_from_probe,
                     "preset = 'trainer'\nsamples = 240\nslice_thickness_mm = 4\nface_reflection = 1\n"
                     "noise_db = -70\nring_down = 1.5\nclutter_db = -10\ntgc_db = [0, 2, 5, 9, 14, 20, 27, 35]\n"
                     "gain_db = 4\nsteering_angles = 3\nedge_enhancement = 1\nspeckle_reduction = 0.3\n"
                     "image_width = 160\nimage_height = 120\nexact_filter = true\n"};

// One plane, no effect that the paper leaves out, and gel in front of a face that stands off the skin.
const View kPaper = {"linear",
                     40,
                     {{{-1, 0, 0}, {0, 0.96, -0.28}, {0, -0.28, -0.96}}, {3, -2, 0}},
                     "preset = 'paper'\nsamples = 200\ngel_mm = 6.05\nbeam_window = 'box'\nbeam_lines = 15\n"
                     "image_width = 90\nimage_height = 140\nexact_filter = true\n"};

/// The inputs of an exported picture.
struct Insonated {
  Insonated(const TemporaryFolder& folder, const View& view, const AcousticVolume& of_patient)
      : volume(of_patient), probe(*find_probe(view.probe)), depth_mm(view.depth_mm), pose(view.patient_from_probe) {
    settings = read_settings(folder.path / "settings.toml", probe.frequency_mhz, depth_mm);
    settings.skipping = false;  // as --stages sets it
    lines = scan_lines(probe, depth_mm, settings.samples);
  }

  ReferenceScan traversed(const Settings& with, const SlicePlane& plane) const {
    return traverse_reference(field, table, lines, with, pose, plane);
  }

  const AcousticVolume& volume;
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const MediumField field = trilinear_field(volume);
  const Probe& probe;
  double depth_mm;
  const Pose& pose;
  Settings settings;
  ScanLines lines;
};

void check_description(const nlohmann::json& text, const Insonated& scene) {
  const Settings& settings = scene.settings;
  CHECK(text.at("model") == "S");
  REQUIRE(text.at("tissues").size() == scene.table.knots.size());
  for (std::size_t i = 0; i < scene.table.knots.size(); ++i) {
    const TissueKnot& knot = scene.table.knots[i];
    CHECK(text.at("tissues").at(i) == nlohmann::json{{"hu", knot.hu},
                                                     {"impedance_mrayl", knot.impedance_mrayl},
                                                     {"absorption_db_cm_mhz", knot.absorption_db_cm_mhz},
                                                     {"echogenicity_db", knot.echogenicity_db}});
  }
  CHECK(text.at("labelled_tissues").size() == scene.table.labelled.size());
  for (const auto& [name, tissue] : scene.table.labelled)
    CHECK(text.at("labelled_tissues").at(name).at("echogenicity_db") == tissue.echogenicity_db);

  CHECK(text.at("beam_weights") == beam_weights(settings));
  CHECK(text.contains("beam_sigma_lines") == settings.focused_beam);
  if (settings.focused_beam) CHECK(text.at("beam_sigma_lines") == focused_beam_sigma(scene.lines, settings));
  CHECK(text.contains("waves") == settings.waves);
  if (settings.waves) {
    const nlohmann::json& waves = text.at("waves");
    CHECK(waves.at("scatterer_scale") == scatterer_scale(scene.lines, settings));
    CHECK(waves.at("pulse_weights") == pulse_weights(scene.lines, settings));
    CHECK(waves.at("cell_mm") == scatterer_pitch_mm(scene.lines, settings));
    CHECK(waves.at("slice_half") == kSliceHalf);
    CHECK(waves.at("mirror_share") == kMirrorShare);
    CHECK(waves.at("rough_share") == kRoughShare);
    CHECK(waves.at("ring_down_at_face") == ring_down_at(settings, 0));
    CHECK(waves.at("ring_down_wavelengths") == kRingDownWavelengths);
  } else {
    CHECK(text.at("envelope_scale") == envelope_scale(scene.lines, settings));
  }
  CHECK(text.at("looks_rad") == look_angles(scene.probe, settings));
  CHECK(text.contains("display_filter") == is_filtered(settings));
  if (is_filtered(settings)) {
    const ImageGeometry picture =
        image_geometry(scene.probe, scene.depth_mm, settings.image_width, settings.image_height);
    CHECK(text.at("display_filter").at("sigma_mm") == filter_sigma_mm(settings));
    CHECK(text.at("display_filter").at("radius_px") == filter_radius_px(settings, picture.mm_per_pixel));
    CHECK(text.at("display_filter").at("speckle_variance") ==
          speckle_variance(settings, int(look_angles(scene.probe, settings).size())));
  }
  const std::vector<SlicePlane> planes = slice_planes(settings);
  REQUIRE(text.at("slice_planes").size() == planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const nlohmann::json& plane = text.at("slice_planes").at(i);
    for (std::size_t line = 0; line < planes[i].places.size(); ++line) {
      CHECK(plane.at("offset").at(line) == planes[i].places[line].offset);
      CHECK(plane.at("weight").at(line) == planes[i].places[line].weight);
      CHECK(plane.at("lateral").at(line) == planes[i].places[line].lateral);
    }
  }
  const glm::dvec3 elevation = scene.pose.direction({0, 0, 1});
  CHECK(text.at("slice").at("elevation") == std::vector<double>{elevation.x, elevation.y, elevation.z});

  const auto number = [&](const char* pointer) { return text.at(nlohmann::json::json_pointer(pointer)).get<double>(); };
  const std::pair<const char*, double> constants[] = {
      {"/reflection_length_mm", settings.reflection_length_mm},
      {"/frequency_mhz", settings.frequency_mhz},
      {"/coupling_air_hu", kCouplingAir_hu},
      {"/coupling_tissue_hu", kCouplingTissue_hu},
      {"/coupling_depth_mm", coupling_depth_mm(settings)},
      {"/silent_db", kSilent_db},
      {"/least_echo", kMinEcho},
      {"/noise_level", noise_level(settings)},
      {"/clutter_share", clutter_share(settings)},
      {"/clutter_tail_mm", kClutterTail_mm},
      {"/wall_clutter/wall_return", kWallReturn},
      {"/wall_clutter/layer_share", kLayerShare},
      {"/wall_clutter/least_layer_echo", kMinLayerEcho},
      {"/slice/thickness_mm", settings.slice_thickness_mm},
      {"/slice/focus_mm", settings.elevation_focus_mm},
      {"/slice/spread", slice_spread(settings)},
      {"/echogenicity/texture_db_per_hu", kTextureDbPerHu},
      {"/echogenicity/texture_hu", kTexture_hu},
      {"/echogenicity/rim_hu", kRim_hu},
      {"/echogenicity/edge_reach_mm", kEdgeRadius_mm},
      {"/echogenicity/edge_margin_hu", kEdgeMargin_hu},
      {"/echogenicity/layer_mm", kLayer_mm},
      {"/ct_noise/step_mm", kNoiseStep_mm},
      {"/ct_noise/usual_hu", kUsualNoise_hu},
      {"/ct_noise/least_tissue_ml", kMinTissue_ml},
      {"/ct_noise/filtered_hu", kFiltered_hu},
      {"/ct_noise/alike_in_guide", kAlikeInGuide},
      {"/ct_noise/alike_in_result", kAlikeInResult},
      {"/echogenicity/most_air_hu", kMaxAir_hu},
      {"/echogenicity/least_db", kMinEchogenicity_db},
      {"/echogenicity/most_db", kMaxEchogenicity_db},
      {"/scatterers/side", ScattererLattice::kSide},
      {"/scatterers/scale", kScattererScale},
      {"/scatterers/tail", ScattererLattice::kTail},
      {"/scatterers/variance", ScattererLattice::kVariance},
      {"/scatterers/turn_rad", ScattererLattice::kRotation_rad},
      {"/scatterers/turn_axis/0", ScattererLattice::kRotationAxis.x},
      {"/scatterers/turn_axis/1", ScattererLattice::kRotationAxis.y},
      {"/scatterers/turn_axis/2", ScattererLattice::kRotationAxis.z},
      {"/scatterers/hash/first", kHashFirst},
      {"/scatterers/hash/second", kHashSecond},
      {"/scatterers/hash/next", kHashNext},
      {"/reverberation/least_round", kMinRound},
      {"/reverberation/least_from_face", kMinFromFace},
      {"/reverberation/least_reverberant", kMinReverberant},
      {"/reverberation/most_repeats", kMaxRepeats},
      {"/reverberation/most_reflectors", kMaxReflectors},
      {"/mirror_image/least_mirror", kMinMirror},
      {"/mirror_image/full_mirror", kFullMirror},
      {"/mirror_image/most_mirrored", kMaxMirrored},
      {"/mirror_image/own_place", kOwnPlace},
      {"/refraction/log_speed_below_water", kLogSpeedBelowWater},
      {"/refraction/log_speed_above_water", kLogSpeedAboveWater},
      {"/refraction/least_hu", kMinRefracting_hu},
      {"/refraction/most_hu", kMaxRefracting_hu},
      {"/refraction/turn_rad", kDeflection_rad},
      {"/refraction/turn_mm", kDeflection_mm},
  };
  for (const auto& [pointer, value] : constants) {
    INFO(pointer);
    CHECK(number(pointer) == value);
  }
}

/// Checks the values that the shaders do not store, in one plane of the slice.
/// @param prefix  of the plane's files
void check_tissue(const StageFolder& stages, const Insonated& scene, const SlicePlane& plane,
                  const std::string& prefix) {
  const int n = scene.probe.lines, d = scene.lines.samples;
  const Settings& settings = scene.settings;
  const double dr = scene.lines.dr_mm(), l = settings.reflection_length_mm;
  const Image<double> empty(n, d);
  Image<double> hounsfield = empty, echogenicity = empty, impedance = empty, absorption = empty;
  for (int line = 0; line < n; ++line)
    for (int k = 0; k < d; ++k) {
      const SlicePlane::Place& of_slice = plane.of_line(std::size_t(line));
      const ScanLine at = line_beside(scene.lines, std::size_t(line), of_slice.lateral);
      const double r = scene.lines.r_min_mm + (k + 0.5) * dr;
      const glm::dvec3 aside(0, 0, of_slice.offset * slice_thickness_at_mm(settings, r));
      const glm::dvec3 place = scene.pose.point(at.start + r * at.direction + aside);
      const Medium met = with_gel(scene.field(place), r, coupling_depth_mm(settings));
      const TissueKnot tissue = scene.table.at(met.hu);
      hounsfield.at(line, k) = met.hu;
      echogenicity.at(line, k) = met.echogenicity_db;
      impedance.at(line, k) = tissue.impedance_mrayl;
      absorption.at(line, k) = tissue.absorption_db_cm_mhz + end_absorption(met.echogenicity_db);
    }
  check_rounded(stages, prefix + "hounsfield", hounsfield);
  check_rounded(stages, prefix + "echogenicity", echogenicity);
  check_rounded(stages, prefix + "impedance", impedance);
  check_rounded(stages, prefix + "absorption", absorption);

  // Without other losses, but for those at an end of the CT, (5) gives alpha from the reference's I, and (3) then gives
  // the incidence from its R.
  Settings interfaces_alone = settings;
  interfaces_alone.absorption = interfaces_alone.edge_shadow = interfaces_alone.waves = false;
  const ReferenceScan scan = scene.traversed(interfaces_alone, plane);
  const Image<float> alpha = stages.image(prefix + "alpha"), incidence = stages.image(prefix + "incidence");
  double worst_alpha = 0, worst_incidence = 0;
  int oblique = 0;
  for (int line = 0; line < n; ++line)
    for (int k = 0; k + 1 < d; ++k) {
      const double i = scan.intensity.at(line, k);
      const double kept = std::pow(10.0, -end_absorption(echogenicity.at(line, k)) * settings.frequency_mhz * dr / 100);
      const double expected = 1 - std::pow(scan.intensity.at(line, k + 1) / (i * kept), l / dr);
      worst_alpha = std::max(worst_alpha, std::abs(alpha.at(line, k) - expected) / (1e-7 * expected + 1e-14));
      if (expected < 1e-8) continue;  // rounding of I hides it
      const double cosine = scan.reflection.at(line, k) / (expected * i * i);
      oblique += cosine > 0.1 && cosine < 0.9;
      worst_incidence = std::max(worst_incidence, std::abs(incidence.at(line, k) - cosine) / 2e-6);
    }
  INFO(prefix << ": errors of alpha and incidence: " << worst_alpha << ", " << worst_incidence);
  CHECK(worst_alpha < 1);
  CHECK(worst_incidence < 1);
  CHECK(oblique > n * d / 20);
}

Image<double> real_part(const Image<std::complex<double>>& wave) {
  Image<double> part(wave.width, wave.height);
  std::ranges::transform(wave.pixels, part.pixels.begin(), [](const std::complex<double>& c) { return c.real(); });
  return part;
}

Image<double> imaginary_part(const Image<std::complex<double>>& wave) {
  Image<double> part(wave.width, wave.height);
  std::ranges::transform(wave.pixels, part.pixels.begin(), [](const std::complex<double>& c) { return c.imag(); });
  return part;
}

/// Checks the planes of the slice and the scatterers' echo of all.
void check_planes(const StageFolder& stages, const Insonated& scene) {
  const std::vector<SlicePlane> planes = slice_planes(scene.settings);
  Image<double> echo_re(scene.probe.lines, scene.lines.samples), echo_im = echo_re;
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const std::string folder = stages.description.at("slice_planes").at(p).at("folder");
    CHECK(folder == (planes.size() == 1 ? "" : "plane_" + std::to_string(p + 1)));
    const std::string prefix = folder.empty() ? "" : folder + "/";
    check_tissue(stages, scene, planes[p], prefix);
    const ReferenceScan scan = scene.traversed(scene.settings, planes[p]);
    if (scene.settings.waves) {
      check_rounded(stages, prefix + "amplitude", scan.amplitude);
      check_rounded(stages, prefix + "mirror", scan.mirror);
    }
    for (std::size_t i = 0; i < scan.echo_re.pixels.size(); ++i) {
      echo_re.pixels[i] += planes[p].of_line(0).weight * scan.echo_re.pixels[i];
      echo_im.pixels[i] += planes[p].of_line(0).weight * scan.echo_im.pixels[i];
    }
    if (folder.empty()) continue;
    check_rounded(stages, prefix + "transmission", scan.intensity);
    check_rounded(stages, prefix + "reflection", scan.reflection);
    if (p == planes.size() / 2)
      for (const std::string name : {"impedance", "alpha"})
        CHECK((stages.files.at(name).bytes == stages.files.at(prefix + name).bytes));
  }
  if (scene.settings.waves) {  // e is the device's
    const Image<std::complex<double>> scatterers = scatterers_reference(scene.lines, scene.settings, scene.pose);
    check_rounded(stages, "scatterers_re", real_part(scatterers));
    check_rounded(stages, "scatterers_im", imaginary_part(scatterers));
    return;
  }
  check_rounded(stages, "echo_re", echo_re);
  check_rounded(stages, "echo_im", echo_im);
}

void check_volume(const StageFolder& stages, const AcousticVolume& volume) {
  std::vector<std::int16_t> hu, echogenicity;
  for (const AcousticVoxel& voxel : volume.voxels) {
    hu.push_back(voxel.hu);
    echogenicity.push_back(voxel.echogenicity_cdb);
  }
  for (const auto& [name, voxels] : {std::pair{"volume", &hu}, {"volume_echogenicity", &echogenicity}}) {
    INFO(name);
    const NrrdFile& file = stages.files.at(name);
    CHECK(file.fields.at("space directions") == stages.files.at("volume").fields.at("space directions"));
    CHECK(file.fields.at("space origin") == stages.files.at("volume").fields.at("space origin"));
    CHECK((file.volume<std::int16_t>().voxels == *voxels));
  }
}

/// Checks the form of every file. The content of each names its quantity or unit.
void check_files(const StageFolder& stages, const Settings& settings, std::vector<std::string> volumes) {
  std::vector<FileForm> tissue = {
      {"hounsfield", "Hounsfield units"},     {"echogenicity", "dB"}, {"impedance", "Z, MRayl"},
      {"absorption", "dB/(cm MHz), one way"}, {"alpha", "alpha (1)"}, {"incidence", "|d . n|"}};
  std::vector<FileForm> among_lines = {
      {"echo_re", "real part"}, {"echo_im", "imaginary part"}, {"transmission", "I (5)"}};
  if (settings.waves) {
    among_lines.insert(among_lines.end(), {{"scattered", "expected power"},
                                           {"wave_re", "f of"},
                                           {"wave_im", "f of"},
                                           {"scatterers_re", "n of"},
                                           {"scatterers_im", "n of"}});
    tissue.insert(tissue.end(), {{"amplitude", "A of"}, {"mirror", "q of"}});
  } else {
    among_lines.insert(
        among_lines.end(),
        {{"reflection", "R (3)"}, {"reflection_beam", "R behind the beam's width (4)"}, {"speckle", "S: envelope"}});
  }
  if (settings.slice_planes == 1) among_lines.insert(among_lines.end(), tissue.begin(), tissue.end());
  for (int plane = 1; plane <= settings.slice_planes && settings.slice_planes > 1; ++plane) {
    const std::string folder = "plane_" + std::to_string(plane) + "/";
    for (const FileForm& form : tissue) among_lines.push_back({folder + form.name, form.content});
    among_lines.push_back({folder + "transmission", "I (5) of this plane"});
    among_lines.push_back({folder + "reflection", "R (3) of this plane"});
  }
  if (settings.slice_planes > 1) among_lines.insert(among_lines.end(), {tissue[2], tissue[4]});
  if (settings.reverberation) among_lines.push_back({"repeated", "V behind the beam's width"});
  std::vector<FileForm> of_pixels = {{"pixel_line", "scan line at the pixel, 0 on the first; -2 outside the fan"},
                                     {"pixel_sample", "sample at the pixel, 0 on the first; -2 outside the fan"},
                                     {"fused", "U (6), before gain"},
                                     {"image", "grey level"}};
  if (is_filtered(settings)) of_pixels.push_back({"shown", "compressed echo (7), 0 to 1"});
  if (settings.electronic_noise && settings.waves)
    of_pixels.insert(of_pixels.end(), {{"noise_re", "of mean square 1"}, {"noise_im", "of mean square 1"}});
  else if (settings.electronic_noise)
    among_lines.push_back({"noise", "of mean 1"});
  volumes.insert(volumes.end(), {"volume", "volume_echogenicity"});
  check_forms(stages, among_lines, of_pixels, volumes);
}

/// Checks all but the values that are read back from the device.
void check_export(const StageFolder& stages, const View& view, const Insonated& scene,
                  const std::vector<std::string>& more_volumes = {}) {
  check_files(stages, scene.settings, more_volumes);
  check_geometry(stages, view, scene.settings.samples, scene.settings.image_width, scene.settings.image_height,
                 scene.volume.grid);
  check_settings(stages, named_settings(scene.settings));
  check_description(stages.description, scene);
  check_volume(stages, scene.volume);
  check_planes(stages, scene);
  if (scene.settings.electronic_noise && !scene.settings.waves)
    check_rounded(stages, "noise", electronic_noise(scene.lines, scene.settings));
}

/// Returns the stages that the files hold. T is not among them.
Stages<float> stages_of(const StageFolder& folder, const Settings& settings) {
  Stages<float> stages;
  stages.intensity = folder.image("transmission");
  stages.repeated =
      settings.reverberation ? folder.image("repeated") : Image<float>(stages.intensity.width, stages.intensity.height);
  if (settings.waves) {
    stages.scattered = folder.image("scattered");
    stages.echo_re = folder.image("echo_re");
    stages.echo_im = folder.image("echo_im");
    stages.wave_re = folder.image("wave_re");
    stages.wave_im = folder.image("wave_im");
  } else {
    stages.reflection = folder.image("reflection");
    stages.reflection_beam = folder.image("reflection_beam");
    stages.speckle = folder.image("speckle");
  }
  stages.fused = folder.image("fused");
  stages.grey = folder.grey();
  const Image<float> line = folder.image("pixel_line");
  stages.inside = Image<std::uint8_t>(line.width, line.height);
  for (std::size_t i = 0; i < line.pixels.size(); ++i) stages.inside.pixels[i] = line.pixels[i] >= -0.5f;
  return stages;
}

/// Returns what a view meets: tissues have structure in pictures with waves alone.
AcousticVolume acoustic(const Volume<std::int16_t>& ct, const View& view) {
  return make_acoustic_volume(ct, {}, {}, read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"), &view == &kWaves);
}

StageFolder export_of(const TemporaryFolder& folder, const Volume<std::int16_t>& ct, const View& view,
                      const std::string& more) {
  write_ct(folder.path / "ct.nrrd", ct);
  return export_stages(folder, "--ct " + (folder.path / "ct.nrrd").string(), view, more);
}

}  // namespace

TEST_CASE("each file of the graphics card's stages has its form, and holds the stage of its name") {
  const View& view = GENERATE_REF(kSlice, kWaves, kPaper);
  const TemporaryFolder folder;
  const Volume<std::int16_t> ct = synthetic_ct();
  const AcousticVolume volume = acoustic(ct, view);
  const StageFolder stages = export_of(folder, ct, view, "");
  const Insonated scene(folder, view, volume);
  CHECK(stages.description.at("made_by") != "reference in double precision");
  check_export(stages, view, scene);
  check_stages(reference_stages(scene.field, scene.table, scene.probe, scene.depth_mm, scene.settings, scene.pose),
               stages_of(stages, scene.settings), scene.lines, scene.settings);
}

TEST_CASE("each file of the reference's stages has its form, and holds the stage of its name") {
  const View& view = GENERATE_REF(kSlice, kWaves, kPaper);
  const TemporaryFolder folder;
  const Volume<std::int16_t> ct = synthetic_ct();
  const AcousticVolume volume = acoustic(ct, view);
  const StageFolder stages = export_of(folder, ct, view, "--reference");
  const Insonated scene(folder, view, volume);
  CHECK(stages.description.at("made_by") == "reference in double precision");
  check_export(stages, view, scene);
  const Stages<double> expected =
      simulate_reference(scene.field, scene.table, scene.probe, scene.depth_mm, scene.settings, scene.pose);
  check_rounded(stages, "transmission", expected.intensity);
  if (scene.settings.waves) {
    check_rounded(stages, "scattered", expected.scattered);
    check_rounded(stages, "echo_re", expected.echo_re);
    check_rounded(stages, "echo_im", expected.echo_im);
    check_rounded(stages, "wave_re", expected.wave_re);
    check_rounded(stages, "wave_im", expected.wave_im);
  } else {
    check_rounded(stages, "reflection", expected.reflection);
    check_rounded(stages, "reflection_beam", expected.reflection_beam);
    check_rounded(stages, "speckle", expected.speckle);
  }
  if (scene.settings.reverberation) check_rounded(stages, "repeated", expected.repeated);
  check_rounded(stages, "fused", expected.fused);
  if (is_filtered(scene.settings)) check_rounded(stages, "shown", expected.shown);
  CHECK((stages.grey().pixels == expected.grey.pixels));
}

TEST_CASE("a CT that is resampled lies beside the stages as it was insonated") {
  Volume<std::int16_t> fine = synthetic_ct(), coarse = fine;  // every third voxel along each axis
  coarse.grid.size /= 3;
  coarse.grid.spacing *= 3.0;
  coarse.grid.origin = fine.grid.patient_from_index(glm::dvec3(1));
  coarse.voxels.clear();
  for (int k = 0; k < coarse.grid.size.z; ++k)
    for (int j = 0; j < coarse.grid.size.y; ++j)
      for (int i = 0; i < coarse.grid.size.x; ++i) coarse.voxels.push_back(fine.at(3 * glm::ivec3(i, j, k) + 1));
  const TemporaryFolder folder;
  const StageFolder stages = export_of(folder, coarse, kPaper, "--reference");
  const AcousticVolume insonated = acoustic(resample_isotropic(coarse, kInsonatedVoxel_mm), kPaper);
  CHECK(glm::distance(insonated.grid.origin, fine.grid.origin) < 1e-9);
  check_export(stages, kPaper, Insonated(folder, kPaper, insonated));
}

TEST_CASE("the labels of a case lie beside the stages, and the tissue of each") {
  const Volume<std::int16_t> ct = synthetic_ct();
  Volume<std::uint8_t> labels{ct.grid, {}};
  for (const int hu : ct.voxels) labels.voxels.push_back(hu > 20 ? 1 : hu > -20 ? 3 : 0);  // 0: by density
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path / "case");
  write_ct(folder.path / "case" / "ct.nrrd", ct);
  write_labels(folder.path / "case" / "labels.nrrd", labels);
  folder.put("case/case.toml",
             "format = 1\nname = \"Labelled\"\nct = \"ct.nrrd\"\nlabels = \"labels.nrrd\"\n"
             "[[label]]\nvalue = 1\nname = \"liver\"\ntissue = \"liver\"\n"
             "[[label]]\nvalue = 3\nname = \"kidney\"\ntissue = \"kidney_cortex\"\n");
  const StageFolder stages = export_stages(folder, "--case " + (folder.path / "case").string(), kPaper, "--reference");
  const AcousticVolume volume = make_acoustic_volume(ct, labels, {"", "liver", "", "kidney_cortex"},
                                                     read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  check_export(stages, kPaper, Insonated(folder, kPaper, volume), {"volume_labels"});
  CHECK((stages.files.at("volume_labels").volume<std::uint8_t>().voxels == labels.voxels));
  CHECK(stages.files.at("volume_labels").grid().size == ct.grid.size);
  CHECK(stages.description.at("tissue_of_label") == nlohmann::json{{"1", "liver"}, {"3", "kidney_cortex"}});
}
