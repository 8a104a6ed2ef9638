#include "tools/render_stages.h"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <cmath>

#include "sim/core/files.h"
#include "sim/model/beam.h"
#include "sim/model/noise.h"
#include "sim/model/refraction.h"
#include "sim/model/reverberation.h"
#include "sim/model/settings_file.h"
#include "sim/reference/reference.h"
#include "tools/stage_files.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kOutsideFan = -2;  // of pixel_line and pixel_sample

/// What the sound meets at each sample.
struct Tissue {
  Image<float> hounsfield, echogenicity, impedance, absorption, alpha, incidence;
};

Tissue tissue_along(const ScanLines& lines, const RenderedScene& scene) {
  const MediumField field = trilinear_field(scene.volume);
  const double l = scene.settings.reflection_length_mm, gel = scene.settings.gel_mm;
  const int n = int(lines.lines.size()), d = lines.samples;
  const Image<float> empty(n, d);
  Tissue tissue{empty, empty, empty, empty, empty, empty};

  for (int line = 0; line < n; ++line) {
    const ScanLine& in_probe = lines.lines[std::size_t(line)];
    const glm::dvec3 start = scene.patient_from_probe.point(in_probe.start);
    const glm::dvec3 along = scene.patient_from_probe.direction(in_probe.direction);
    const glm::dvec3 lateral = scene.patient_from_probe.direction({in_probe.direction.y, -in_probe.direction.x, 0});
    const glm::dvec3 elevation = glm::cross(along, lateral);
    for (int k = 0; k < d; ++k) {
      const double r = lines.r_min_mm + (k + 0.5) * lines.dr_mm();
      const glm::dvec3 p = start + r * along;
      const auto hu = [&](const glm::dvec3& offset, double depth) {
        return with_gel(field(p + offset), depth, gel).hu;
      };
      const Medium here = with_gel(field(p), r, gel);
      const TissueKnot met = scene.table.at(here.hu);
      tissue.hounsfield.at(line, k) = float(here.hu);
      tissue.echogenicity.at(line, k) = float(here.echogenicity_db);
      tissue.impedance.at(line, k) = float(met.impedance_mrayl);
      tissue.absorption.at(line, k) = float(met.absorption_db_cm_mhz);

      const double hu_before = hu(-l / 2 * along, r - l / 2), hu_behind = hu(l / 2 * along, r + l / 2);
      const double before = scene.table.at(hu_before).impedance_mrayl;
      const double behind = scene.table.at(hu_behind).impedance_mrayl;
      const double contrast = (behind - before) / (behind + before);
      const glm::dvec3 rise(hu_behind - hu_before, hu(l / 2 * lateral, r) - hu(-l / 2 * lateral, r),
                            hu(l / 2 * elevation, r) - hu(-l / 2 * elevation, r));
      const double steepness = glm::length(rise);
      tissue.alpha.at(line, k) = float(contrast * contrast);
      tissue.incidence.at(line, k) = float(steepness > 0 ? std::abs(rise.x) / steepness : 0);
    }
  }
  return tissue;
}

struct PixelPositions {
  Image<float> line, sample;
};

PixelPositions pixel_positions(const RenderedScene& scene, const ScanLines& lines, const ImageGeometry& geometry) {
  const Image<float> outside(geometry.width, geometry.height, float(kOutsideFan));
  PixelPositions positions{outside, outside};
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x)
      if (const auto at = line_position(scene.probe, scene.depth_mm, geometry.plane_mm(x, y))) {
        positions.line.at(x, y) = float(at->line);
        positions.sample.at(x, y) = float((at->r_mm - lines.r_min_mm) / lines.dr_mm() - 0.5);
      }
  return positions;
}

Json json(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

Json description(const RenderedScene& scene, const ScanLines& lines, const ImageGeometry& geometry,
                 const std::string& made_by) {
  const Grid& grid = scene.volume.grid;
  const glm::dmat4 pose = scene.patient_from_probe.matrix();
  Json text;
  text["format"] = 1;
  text["made_by"] = made_by;
  text["probe"] = scene.probe.name;
  text["depth_mm"] = scene.depth_mm;
  text["lines"] = lines.lines.size();
  text["samples"] = lines.samples;
  text["r_min_mm"] = lines.r_min_mm;
  text["r_max_mm"] = lines.r_max_mm;
  text["dr_mm"] = lines.dr_mm();
  text["reflection_length_mm"] = scene.settings.reflection_length_mm;
  text["frequency_mhz"] = scene.settings.frequency_mhz;
  text["coupling_air_hu"] = kCouplingAirHu;
  for (int i = 0; i < 16; ++i) text["patient_from_probe"].push_back(pose[i % 4][i / 4]);
  text["image"] = {{"width", geometry.width},
                   {"height", geometry.height},
                   {"mm_per_pixel", geometry.mm_per_pixel},
                   {"top_left_mm", {geometry.top_left_mm.x, geometry.top_left_mm.y}}};
  text["volume"] = {{"size", {grid.size.x, grid.size.y, grid.size.z}},
                    {"spacing_mm", json(grid.spacing)},
                    {"origin_mm", json(grid.origin)},
                    {"axes", {json(grid.direction[0]), json(grid.direction[1]), json(grid.direction[2])}}};
  for (const auto& [name, value] : named_settings(scene.settings))
    text["settings"][name] = std::visit([](const auto& held) { return Json(held); }, value);
  for (const TissueKnot& knot : scene.table.knots)
    text["tissues"].push_back({{"hu", knot.hu},
                               {"impedance_mrayl", knot.impedance_mrayl},
                               {"absorption_db_cm_mhz", knot.absorption_db_cm_mhz},
                               {"echogenicity_db", knot.echogenicity_db}});
  text["beam_weights"] = beam_weights(scene.settings);
  if (scene.settings.focused_beam) text["beam_sigma_lines"] = focused_beam_sigma(lines, scene.settings);
  text["noise_level"] = noise_level(scene.settings);
  text["clutter_share"] = clutter_share(scene.settings);
  text["clutter_tail_mm"] = kClutterTail_mm;
  text["reverberation"] = {{"least_round", kLeastRound},
                           {"least_reverberant", kLeastReverberant},
                           {"most_repeats", kMostRepeats},
                           {"most_reflectors", kMostReflectors}};
  text["refraction"] = {{"log_speed_below_water", kLogSpeedBelowWater},
                        {"log_speed_above_water", kLogSpeedAboveWater},
                        {"least_hu", kLeastHu},
                        {"most_hu", kMostHu},
                        {"turn_rad", kTurn_rad},
                        {"turn_mm", kTurn_mm}};
  text["envelope_scale"] = envelope_scale(lines, scene.settings);
  for (const ScanLine& line : lines.lines)
    text["scan_lines"].push_back({{"start_mm", json(scene.patient_from_probe.point(line.start))},
                                  {"direction", json(scene.patient_from_probe.direction(line.direction))}});
  return text;
}

}  // namespace

Stages<float> in_single_precision(const Stages<double>& stages) {
  return {in_single_precision(stages.intensity),
          in_single_precision(stages.reflection),
          in_single_precision(stages.reflection_beam),
          in_single_precision(stages.transmission),
          in_single_precision(stages.repeated),
          in_single_precision(stages.speckle),
          in_single_precision(stages.fused),
          stages.inside,
          stages.grey};
}

void write_stages(const fs::path& folder, const RenderedScene& scene, const Stages<float>& stages,
                  const std::string& made_by) {
  const Settings& settings = scene.settings;
  const ScanLines lines = scan_lines(scene.probe, scene.depth_mm, settings.samples);
  const ImageGeometry geometry =
      image_geometry(scene.probe, scene.depth_mm, settings.image_width, settings.image_height);
  write_file(folder / "scanlines.json", description(scene, lines, geometry, made_by).dump(1) + "\n");

  const auto among_lines = [&](const char* name, const Image<float>& image, const char* content) {
    write_among_lines(folder, name, image, content);
  };
  const Tissue tissue = tissue_along(lines, scene);
  among_lines("hounsfield", tissue.hounsfield, "Hounsfield units of the volume, trilinear");
  among_lines("echogenicity", tissue.echogenicity, "backscatter relative to liver, dB");
  among_lines("impedance", tissue.impedance, "Z, MRayl; gel in place of air within gel_mm");
  among_lines("absorption", tissue.absorption, "a, dB/(cm MHz), one way; gel as in impedance");
  among_lines("alpha", tissue.alpha, "alpha (1): ((Z(r + l/2) - Z(r - l/2)) / (Z(r + l/2) + Z(r - l/2)))^2");
  among_lines("incidence", tissue.incidence, "|d . n|, n from differences of Z over l along three axes");
  const ReferenceScan scan =
      traverse_reference(trilinear_field(scene.volume), scene.table, lines, settings, scene.patient_from_probe);
  among_lines("echo_re", in_single_precision(scan.echo_re), "the scatterers' echo before the beam's width, real part");
  among_lines("echo_im", in_single_precision(scan.echo_im), "the same, imaginary part");
  among_lines("transmission", stages.intensity, "I (5), relative to the intensity at the face");
  among_lines("reflection", stages.reflection, "R (3) before the beam's width");
  among_lines("reflection_beam", stages.reflection_beam, "R behind the beam's width (4)");
  among_lines("speckle", stages.speckle, "S: envelope of the scatterers' echo behind the beam's width");
  if (settings.reverberation || settings.face_reflection > 0)
    among_lines("repeated", stages.repeated, "V behind the beam's width, as sim/model/reverberation.h says");
  if (settings.electronic_noise || settings.clutter)
    among_lines("noise", in_single_precision(electronic_noise(lines, settings)),
                "of mean 1: times noise_level, and the scatterers' mean echo at the depth times clutter_share, in U");

  const auto as_picture = [&](const char* name, const Image<float>& image, const char* content) {
    write_as_picture(folder, name, image, content);
  };
  const PixelPositions positions = pixel_positions(scene, lines, geometry);
  as_picture("pixel_line", positions.line, "scan line at the pixel, 0 on the first; -2 outside the fan");
  as_picture("pixel_sample", positions.sample, "sample at the pixel, 0 on the first; -2 outside the fan");
  as_picture("fused", stages.fused, "U (6), before gain");
  as_picture("image", in_single_precision(stages.grey), "grey level behind gain and log compression (7), 0 to 255");
}

}  // namespace insonate
