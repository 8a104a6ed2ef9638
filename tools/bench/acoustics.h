#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/acoustics/scenes.h"
#include "tools/bench/tables/table.h"

/// The commands of insonate-bench about the wave physics of the transducers. They need no OpenGL.
namespace insonate::bench {

/// The arguments that these commands share.
struct AcousticRequest {
  std::vector<std::string> probes;  ///< names of find_probe(); all of them if empty
  std::string transducer;           ///< a transducer's file instead of the probes' bundled ones; empty for those
  double depth_mm = 0;              ///< 0 for the probe's default depth
  double focus_mm = 0;              ///< transmit focus; 0 for half the depth, as in the trainer
  double f_number = 3.5;            ///< of transmission and reception, as in the trainer
  double attenuation_db_cm_mhz = 0;
};

/// Measures the resolution cell of each transducer at 8 depths, beside the widths that the trainer's simulator uses
/// (sim/model/beam.h). Draws a plot per transducer to one SVG unless `svg` is empty.
Table measure_beams(const AcousticRequest& request, const std::string& svg);

/// Measures the speckle that the direct sum gives for each transducer about its focus, for several numbers of
/// scatterers per resolution cell: signal-to-noise ratio, and the test for a Rayleigh distribution.
/// @param lines  scan lines per row, each through a block of its own
Table measure_speckle(const AcousticRequest& request, int lines);

/// Measures how many scatterers the live simulator adds up in a second, beside the direct sum of the same field in
/// double precision (sim/reference/wave_reference.h).
Table measure_scatterer_rates();

/// Writes a scene for each transducer to FOLDER, or to FOLDER/PROBE if there are several (write_scene()). Throws
/// InputError.
void write_scenes(const AcousticRequest& request, SceneRequest scene, const std::filesystem::path& folder);

}  // namespace insonate::bench
