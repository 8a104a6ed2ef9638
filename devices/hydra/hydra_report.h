#pragma once

#include <array>

#include "devices/report.h"

namespace insonate {

/// The Razer Hydra's input report, 52 bytes, 250 times per second: two handsets with six buttons and a stick each.
/// Layout, scales and checksum follow public drivers. These disagree on the sign of the quaternion's y and z, so the
/// set-up has to determine the directions. Not tested on hardware.
struct HydraReport {
  struct Handset {
    SensorReading reading;  ///< the buttons are bits: 0 bumper, 1 B3, 2 B1, 3 B2, 4 B4, 5 middle, 6 stick
    double stick_x = 0;     ///< from -1 to 1
    double stick_y = 0;
    double trigger = 0;  ///< from 0 to 1
  };
  std::uint8_t sequence = 0;  ///< numbered by the device: one more with each report, modulo 256
  std::array<Handset, 2> handsets;
};

inline constexpr std::size_t kHydraReportLength = 52;
inline constexpr std::size_t kHydraFeatureLength = 91;

/// Parses a report. Returns a fault if its length, its header or its checksum is wrong.
Parsed<HydraReport> parse_hydra(Bytes bytes);

/// Returns the feature report, beginning with its number 0, that makes the device send poses (true) or act as a gamepad
/// again (false).
std::array<std::uint8_t, kHydraFeatureLength> hydra_mode(bool poses);

}  // namespace insonate
