#include "tools/render/stage_description.h"

#include "sim/core/hash.h"
#include "sim/model/beam.h"
#include "sim/model/compounding.h"
#include "sim/model/display_filter.h"
#include "sim/model/mirror_image.h"
#include "sim/model/noise.h"
#include "sim/model/refraction.h"
#include "sim/model/reverberation.h"
#include "sim/model/scatterers.h"
#include "sim/model/stages.h"
#include "sim/model/waves.h"
#include "sim/reference/reference.h"
#include "sim/tissue/ct_noise.h"
#include "sim/volume/ct_reader.h"
#include "tools/render/stage_files.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kOutsideFan = -2;  // value of pixel_line and pixel_sample

Json json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Json echogenicity_constants() {
  return {{"texture_db_per_hu", kTextureDbPerHu},
          {"texture_hu", kTexture_hu},
          {"rim_hu", kRim_hu},
          {"edge_reach_mm", kEdgeRadius_mm},
          {"edge_margin_hu", kEdgeMargin_hu},
          {"layer_mm", kLayer_mm},
          {"most_air_hu", kMaxAir_hu},
          {"least_db", kMinEchogenicity_db},
          {"most_db", kMaxEchogenicity_db}};
}

Json ct_noise_constants() {
  return {{"step_mm", kNoiseStep_mm},    {"usual_hu", kUsualNoise_hu},      {"least_tissue_ml", kMinTissue_ml},
          {"filtered_hu", kFiltered_hu}, {"alike_in_guide", kAlikeInGuide}, {"alike_in_result", kAlikeInResult}};
}

Json scatterer_constants() {
  using Lattice = ScattererLattice;
  return {{"side", Lattice::kSide},
          {"scale", kScattererScale},
          {"tail", Lattice::kTail},
          {"variance", Lattice::kVariance},
          {"turn_rad", Lattice::kRotation_rad},
          {"turn_axis", json(Lattice::kRotationAxis)},
          {"hash", {{"first", kHashFirst}, {"second", kHashSecond}, {"next", kHashNext}}}};
}

void write_part(const fs::path& file, const AcousticVolume& volume, std::int16_t AcousticVoxel::*of) {
  Volume<std::int16_t> part{volume.grid, {}};
  part.voxels.reserve(volume.voxels.size());
  for (const AcousticVoxel& voxel : volume.voxels) part.voxels.push_back(voxel.*of);
  write_ct(file, part);
}

}  // namespace

StageGeometry::StageGeometry(const Probe& of_probe, double depth, int samples, int width, int height)
    : probe(of_probe),
      depth_mm(depth),
      lines(scan_lines(of_probe, depth, samples)),
      image(image_geometry(of_probe, depth, width, height)) {}

Json describe_geometry(const char* model, const StageGeometry& geometry, const Pose& patient_from_probe,
                       const AcousticVolume& volume, const std::string& made_by) {
  const Grid& grid = volume.grid;
  const ScanLines& lines = geometry.lines;
  const glm::dmat4 pose = patient_from_probe.matrix();
  Json text;
  text["format"] = 3;
  text["model"] = model;
  text["made_by"] = made_by;
  text["probe"] = geometry.probe.name;
  text["depth_mm"] = geometry.depth_mm;
  text["lines"] = lines.lines.size();
  text["samples"] = lines.samples;
  text["r_min_mm"] = lines.r_min_mm;
  text["r_max_mm"] = lines.r_max_mm;
  text["dr_mm"] = lines.dr_mm();
  for (int i = 0; i < 16; ++i) text["patient_from_probe"].push_back(pose[i % 4][i / 4]);
  text["image"] = {{"width", geometry.image.width},
                   {"height", geometry.image.height},
                   {"mm_per_pixel", geometry.image.mm_per_pixel},
                   {"top_left_mm", {geometry.image.top_left_mm.x, geometry.image.top_left_mm.y}}};
  text["volume"] = {{"size", {grid.size.x, grid.size.y, grid.size.z}},
                    {"spacing_mm", json(grid.spacing)},
                    {"origin_mm", json(grid.origin)},
                    {"axes", {json(grid.direction[0]), json(grid.direction[1]), json(grid.direction[2])}},
                    {"outside_hu", AcousticVoxel{}.hu},
                    {"outside_echogenicity_db", AcousticVoxel{}.echogenicity_cdb / 100.0}};
  for (const ScanLine& line : lines.lines)
    text["scan_lines"].push_back({{"start_mm", json(patient_from_probe.point(line.start))},
                                  {"direction", json(patient_from_probe.direction(line.direction))}});
  return text;
}

void describe_settings(Json& text, const std::vector<std::pair<std::string, SettingValue>>& settings) {
  for (const auto& [name, value] : settings)
    text["settings"][name] = std::visit([](const auto& held) { return Json(held); }, value);
}

Json describe(const RenderedScene& scene, const StageGeometry& geometry, const std::string& made_by) {
  const ScanLines& lines = geometry.lines;
  Json text = describe_geometry("S", geometry, scene.patient_from_probe, scene.volume, made_by);
  text["reflection_length_mm"] = scene.settings.reflection_length_mm;
  text["frequency_mhz"] = scene.settings.frequency_mhz;
  text["coupling_air_hu"] = kCouplingAir_hu;
  text["coupling_tissue_hu"] = kCouplingTissue_hu;
  text["coupling_depth_mm"] = coupling_depth_mm(scene.settings);
  describe_settings(text, named_settings(scene.settings));
  for (const TissueKnot& knot : scene.table.knots)
    text["tissues"].push_back({{"hu", knot.hu},
                               {"impedance_mrayl", knot.impedance_mrayl},
                               {"absorption_db_cm_mhz", knot.absorption_db_cm_mhz},
                               {"echogenicity_db", knot.echogenicity_db}});
  for (const auto& [name, tissue] : scene.table.labelled)
    text["labelled_tissues"][name] = {{"echogenicity_db", tissue.echogenicity_db}};
  for (std::size_t label = 0; label < scene.tissue_of.size(); ++label)
    if (!scene.tissue_of[label].empty()) text["tissue_of_label"][std::to_string(label)] = scene.tissue_of[label];
  text["echogenicity"] = echogenicity_constants();
  text["ct_noise"] = ct_noise_constants();
  text["silent_db"] = kSilent_db;
  text["least_echo"] = kMinEcho;
  text["scatterers"] = scatterer_constants();
  text["looks_rad"] = look_angles(scene.probe, scene.settings);
  if (is_filtered(scene.settings))
    text["display_filter"] = {{"sigma_mm", filter_sigma_mm(scene.settings)},
                              {"radius_px", filter_radius_px(scene.settings, geometry.image.mm_per_pixel)},
                              {"speckle_variance", speckle_variance(scene.settings, int(text["looks_rad"].size()))}};
  text["beam_weights"] = beam_weights(scene.settings);
  if (scene.settings.focused_beam) text["beam_sigma_lines"] = focused_beam_sigma(lines, scene.settings);
  text["noise_level"] = noise_level(scene.settings);
  text["clutter_share"] = clutter_share(scene.settings);
  text["clutter_tail_mm"] = kClutterTail_mm;
  text["wall_clutter"] = {
      {"wall_return", kWallReturn}, {"layer_share", kLayerShare}, {"least_layer_echo", kMinLayerEcho}};
  text["reverberation"] = {{"least_round", kMinRound},
                           {"least_from_face", kMinFromFace},
                           {"least_reverberant", kMinReverberant},
                           {"most_repeats", kMaxRepeats},
                           {"most_reflectors", kMaxReflectors}};
  text["mirror_image"] = {{"least_mirror", kMinMirror},
                          {"full_mirror", kFullMirror},
                          {"most_mirrored", kMaxMirrored},
                          {"own_place", kOwnPlace}};
  text["refraction"] = {{"log_speed_below_water", kLogSpeedBelowWater},
                        {"log_speed_above_water", kLogSpeedAboveWater},
                        {"least_hu", kMinRefracting_hu},
                        {"most_hu", kMaxRefracting_hu},
                        {"turn_rad", kDeflection_rad},
                        {"turn_mm", kDeflection_mm}};
  if (scene.settings.waves)
    text["waves"] = {{"cell_mm", scatterer_pitch_mm(lines, scene.settings)},
                     {"pulse_weights", pulse_weights(lines, scene.settings)},
                     {"scatterer_scale", scatterer_scale(lines, scene.settings)},
                     {"slice_half", kSliceHalf},
                     {"ring_down_at_face", ring_down_at(scene.settings, 0)},
                     {"ring_down_wavelengths", kRingDownWavelengths},
                     {"mirror_share", kMirrorShare},
                     {"rough_share", kRoughShare}};
  else
    text["envelope_scale"] = envelope_scale(lines, scene.settings);
  const std::vector<SlicePlane> planes = slice_planes(scene.settings);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    Json plane{{"folder", slice_folder(planes, i)}};
    for (const SlicePlane::Place& place : planes[i].places) {
      plane["offset"].push_back(place.offset);
      plane["weight"].push_back(place.weight);
      plane["lateral"].push_back(place.lateral);
    }
    text["slice_planes"].push_back(plane);
  }
  text["slice"] = {{"elevation", json(scene.patient_from_probe.direction({0, 0, 1}))},
                   {"thickness_mm", scene.settings.slice_thickness_mm},
                   {"focus_mm", scene.settings.elevation_focus_mm},
                   {"spread", slice_spread(scene.settings)}};
  return text;
}

void write_pixel_positions(const fs::path& folder, const StageGeometry& geometry) {
  const Image<float> outside(geometry.image.width, geometry.image.height, float(kOutsideFan));
  Image<float> line = outside, sample = outside;
  for (int y = 0; y < line.height; ++y)
    for (int x = 0; x < line.width; ++x)
      if (const auto at = line_position(geometry.probe, geometry.depth_mm, geometry.image.plane_mm(x, y))) {
        line.at(x, y) = float(at->line);
        sample.at(x, y) = float((at->r_mm - geometry.lines.r_min_mm) / geometry.lines.dr_mm() - 0.5);
      }
  write_as_picture(folder, "pixel_line", line, "scan line at the pixel, 0 on the first; -2 outside the fan");
  write_as_picture(folder, "pixel_sample", sample, "sample at the pixel, 0 on the first; -2 outside the fan");
}

void write_hounsfield(const fs::path& folder, const AcousticVolume& volume) {
  write_part(folder / "volume.nrrd", volume, &AcousticVoxel::hu);
}

void write_echogenicity(const fs::path& folder, const AcousticVolume& volume) {
  write_part(folder / "volume_echogenicity.nrrd", volume, &AcousticVoxel::echogenicity_cdb);
}

}  // namespace insonate
