#include "tools/render/stages.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <complex>

#include "sim/files/files.h"
#include "sim/model/display_filter.h"
#include "sim/model/noise.h"
#include "sim/reference/reference.h"
#include "sim/reference/wave_reference.h"
#include "sim/volume/ct_reader.h"
#include "tools/render/stage_description.h"
#include "tools/render/stage_files.h"
#include "tools/render/stage_tissue.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImpedance = "Z, MRayl; water in place of air within coupling_depth_mm";
constexpr const char* kAlpha = "alpha (1): ((Z(r + l/2) - Z(r - l/2)) / (Z(r + l/2) + Z(r - l/2)))^2";

void write_tissue(const fs::path& folder, const Tissue& tissue) {
  const auto write = [&](const char* name, const Image<float>& image, const char* content) {
    write_among_lines(folder, name, image, content);
  };
  write("hounsfield", tissue.hounsfield, "Hounsfield units of the volume, trilinear; gel as water");
  write("echogenicity", tissue.echogenicity, "backscatter relative to liver, dB");
  write("impedance", tissue.impedance, kImpedance);
  write("absorption", tissue.absorption, "a, dB/(cm MHz), one way; gel as in impedance");
  write("alpha", tissue.alpha, kAlpha);
  write("incidence", tissue.incidence,
        "|d . n|, n from differences of Hounsfield units, gel included, over l along three axes");
}

void add(Image<double>& to, double weight, const Image<double>& what) {
  for (std::size_t i = 0; i < to.pixels.size(); ++i) to.pixels[i] += weight * what.pixels[i];
}

/// Writes the sums of scatterers around each sample.
void write_scatterers(const fs::path& folder, const RenderedScene& scene, const ScanLines& lines) {
  const Image<std::complex<double>> scatterers = scatterers_reference(lines, scene.settings, scene.patient_from_probe);
  const auto write = [&](const char* name, auto part, const char* content) {
    Image<double> image(scatterers.width, scatterers.height);
    std::ranges::transform(scatterers.pixels, image.pixels.begin(), part);
    write_among_lines(folder, name, in_single_precision(image), content);
  };
  write(
      "scatterers_re", [](std::complex<double> n) { return n.real(); }, "n of sim/model/waves.h, real part");
  write(
      "scatterers_im", [](std::complex<double> n) { return n.imag(); }, "n of sim/model/waves.h, imaginary part");
}

/// Writes the tissue of each plane of the slice, and the scatterers' echo of all planes.
void write_planes(const fs::path& folder, const RenderedScene& scene, const ScanLines& lines) {
  const MediumField field = trilinear_field(scene.volume);
  const std::vector<SlicePlane> planes = slice_planes(scene.settings);
  Image<double> echo_re(int(lines.lines.size()), lines.samples), echo_im = echo_re;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const fs::path of_plane = folder / slice_folder(planes, i);
    fs::create_directories(of_plane);
    const Tissue tissue = tissue_along(lines, scene, planes[i]);
    write_tissue(of_plane, tissue);
    const ReferenceScan scan =
        traverse_reference(field, scene.table, lines, scene.settings, scene.patient_from_probe, planes[i]);
    if (planes.size() > 1) {
      write_among_lines(of_plane, "transmission", in_single_precision(scan.intensity), "I (5) of this plane");
      write_among_lines(of_plane, "reflection", in_single_precision(scan.reflection), "R (3) of this plane");
      if (i == planes.size() / 2) {  // the middle one, also written to the main folder
        write_among_lines(folder, "impedance", tissue.impedance, kImpedance);
        write_among_lines(folder, "alpha", tissue.alpha, kAlpha);
      }
    }
    if (scene.settings.waves) {
      write_among_lines(of_plane, "amplitude", in_single_precision(scan.amplitude), "A of sim/model/waves.h");
      write_among_lines(of_plane, "mirror", in_single_precision(scan.mirror), "q of sim/model/waves.h");
    } else {
      add(echo_re, planes[i].of_line(0).weight, scan.echo_re);
      add(echo_im, planes[i].of_line(0).weight, scan.echo_im);
    }
  }
  if (scene.settings.waves) {
    write_scatterers(folder, scene, lines);
    return;
  }
  write_among_lines(folder, "echo_re", in_single_precision(echo_re),
                    "the scatterers' echo before the beam's width, real part, of all planes");
  write_among_lines(folder, "echo_im", in_single_precision(echo_im),
                    "the scatterers' echo before the beam's width, imaginary part, of all planes");
}

/// Writes the receiver's noise: along the lines or, with waves, as the picture has it.
void write_noise(const fs::path& folder, const RenderedScene& scene, const StageGeometry& geometry) {
  if (!scene.settings.waves) {
    write_among_lines(
        folder, "noise", in_single_precision(electronic_noise(geometry.lines, scene.settings)),
        "of mean 1: in U times noise_level + clutter_share M, M the scatterers' mean echo at the pixel's depth");
    return;
  }
  const Image<std::complex<double>> noise = noise_wave(geometry.lines, scene.settings);
  const glm::ivec2 shift = noise_shift(scene.patient_from_probe);
  const int w = geometry.image.width, h = geometry.image.height;
  Image<float> re(w, h), im(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const std::complex<double> n =
          noise_of_pixel(noise, geometry.image, geometry.lines, (x + shift.x) % w, (y + shift.y) % h);
      re.at(x, y) = float(n.real());
      im.at(x, y) = float(n.imag());
    }
  const char* const content =
      "of mean square 1: added to f, times the root of noise_level + clutter_share M + the clutter of the body wall";
  write_as_picture(folder, "noise_re", re, content);
  write_as_picture(folder, "noise_im", im, content);
}

}  // namespace

std::string slice_folder(const std::vector<SlicePlane>& planes, std::size_t plane) {
  return planes.size() == 1 ? "" : "plane_" + std::to_string(plane + 1);
}

Stages<float> in_single_precision(const Stages<double>& stages) {
  Stages<float> single;
  single.intensity = in_single_precision(stages.intensity);
  single.reflection = in_single_precision(stages.reflection);
  single.reflection_beam = in_single_precision(stages.reflection_beam);
  single.transmission = in_single_precision(stages.transmission);
  single.repeated = in_single_precision(stages.repeated);
  single.speckle = in_single_precision(stages.speckle);
  single.scattered = in_single_precision(stages.scattered);
  single.echo_re = in_single_precision(stages.echo_re);
  single.echo_im = in_single_precision(stages.echo_im);
  single.wave_re = in_single_precision(stages.wave_re);
  single.wave_im = in_single_precision(stages.wave_im);
  single.fused = in_single_precision(stages.fused);
  single.shown = in_single_precision(stages.shown);
  single.inside = stages.inside;
  single.grey = stages.grey;
  return single;
}

void write_stages(const fs::path& folder, const RenderedScene& scene, const Stages<float>& stages,
                  const std::string& made_by) {
  const Settings& settings = scene.settings;
  const StageGeometry geometry(scene.probe, scene.depth_mm, settings.samples, settings.image_width,
                               settings.image_height);
  write_file(folder / "scanlines.json", describe(scene, geometry, made_by).dump(1) + "\n");
  write_hounsfield(folder, scene.volume);
  write_echogenicity(folder, scene.volume);
  if (!scene.labels.empty()) write_labels(folder / "volume_labels.nrrd", scene.labels);
  write_planes(folder, scene, geometry.lines);

  const auto among_lines = [&](const char* name, const Image<float>& image, const char* content) {
    write_among_lines(folder, name, image, content);
  };
  among_lines("transmission", stages.intensity, "I (5), relative to the intensity at the face");
  if (settings.waves) {
    among_lines("scattered", stages.scattered, "expected power of the scatterers' echo, as in sim/model/stages.h");
    among_lines("echo_re", stages.echo_re, "e of sim/model/waves.h, real part, of all planes");
    among_lines("echo_im", stages.echo_im, "e of sim/model/waves.h, imaginary part, of all planes");
    among_lines("wave_re", stages.wave_re, "f of sim/model/waves.h, real part");
    among_lines("wave_im", stages.wave_im, "f of sim/model/waves.h, imaginary part");
  } else {
    among_lines("reflection", stages.reflection, "R (3) before the beam's width");
    among_lines("reflection_beam", stages.reflection_beam, "R behind the beam's width (4)");
    among_lines("speckle", stages.speckle, "S: envelope of the scatterers' echo behind the beam's width");
  }
  if (settings.reverberation || settings.face_reflection > 0)
    among_lines("repeated", stages.repeated, "V behind the beam's width, as sim/model/reverberation.h says");
  if (settings.electronic_noise || settings.clutter) write_noise(folder, scene, geometry);

  write_pixel_positions(folder, geometry);
  write_as_picture(folder, "fused", stages.fused, "U (6), before gain");
  if (is_filtered(settings))
    write_as_picture(folder, "shown", stages.shown,
                     "compressed echo (7), 0 to 1, before filter and grey map of sim/model/display_filter.h");
  write_as_picture(folder, "image", in_single_precision(stages.grey),
                   "grey level behind gain and log compression (7), 0 to 255; the marker on the right");
}

}  // namespace insonate
