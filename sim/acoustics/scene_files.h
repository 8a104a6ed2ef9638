#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/acoustics/echo_lines.h"

namespace insonate {

// A scene as text, for programs such as Field II and SIMUS. Numbers are in metres, seconds and hertz. The frame is that
// of those programs: x lateral, z into the depth, y = z cross x along the elevation, which is minus the probe's z.

/// Returns "x_m,y_m,z_m,amplitude" and a line per scatterer.
std::string scatterers_csv(const std::vector<PointScatterer>& scatterers);

/// Returns "quantity,value,unit" and a line per number of the transducer and of its beamforming.
std::string transducer_csv(const Transducer& transducer, const Beamforming& beamforming);

/// Returns "x_m,y_m,z_m,angle_rad" and a line per element: its middle, and the angle from z to its normal towards x.
std::string elements_csv(const Transducer& transducer);

/// Returns "time_s,TITLE" and a line per sample, the first at `first_us`.
std::string samples_csv(const std::string& title, double first_us, double per_us, const std::vector<double>& samples);

/// Writes a folder with a scene, the transducer and its pulse, and the central scan line of the scene from 1 mm to
/// `to_mm`, with which another program can compare its own:
///     scatterers.csv, transducer.csv, elements.csv, excitation.csv, element_response.csv, central_line.csv
/// Throws InputError if the folder's name is taken or it cannot be written.
/// @param to_mm  above 1
void write_scene(const std::filesystem::path& folder, const Transducer& transducer, const Beamforming& beamforming,
                 const std::vector<PointScatterer>& scatterers, double to_mm);

}  // namespace insonate
