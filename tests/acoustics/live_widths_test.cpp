// The widths that the trainer's simulator computes by formulas (sim/model/beam.h), against those of real arrays.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "sim/acoustics/beam_profile.h"
#include "sim/model/beam.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "tests/acoustics/helpers.h"

using namespace insonate;
using test::shipped;

namespace {

/// An array at the trainer's frequency, and the trainer's settings for it.
struct Pair {
  Transducer transducer;
  Settings settings;
  Beamforming beamforming;
};

Pair pair_of(const Probe& probe) {
  Pair pair{shipped(probe.name), trainer_settings(probe.frequency_mhz, probe.depth_mm), {}};
  pair.transducer.frequency_mhz = probe.frequency_mhz;
  pair.beamforming.transmit_focus_mm = pair.settings.focus_mm;
  pair.beamforming.transmit_f_number = pair.beamforming.receive_f_number = pair.settings.f_number;
  return pair;
}

double ratio(double live_mm, double width_mm) {
  return live_mm / width_mm;
}

}  // namespace

TEST_CASE("the live simulator's beam is as wide as the array's, and its pulse as long") {
  for (const Probe& probe : probes()) {
    const Pair pair = pair_of(probe);
    const ScanLine line = line_at(pair.transducer, 0);
    for (const double share : {0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0, 1.25, 1.5, 1.75, 2.0}) {
      const double depth = share * pair.settings.focus_mm;
      const BeamProfile array = beam_profile(pair.transducer, pair.beamforming, line, depth, kHalfAmplitude);
      CAPTURE(probe.name, share);
      // Before the focus the transmitted field is not Gaussian: its outer parts arrive apart, which widens it
      // here and narrows it there, and makes the pulse longer.
      const bool near = share < 1;
      CHECK(ratio(pair.settings.reflection_length_mm, array.axial_mm) == Approx(1).margin(near ? 0.17 : 0.1));
      // Waves take sqrt(2) of the width at half power for their amplitude, as for a Gaussian (sim/model/waves.h).
      const double live = std::sqrt(2.0) * focused_beam_fwhm_mm(pair.settings, probe.aperture_mm, depth);
      CHECK(ratio(live, array.lateral_mm) == Approx(1).margin(near ? 0.25 : 0.1));
    }
  }
}

TEST_CASE("the live simulator's slice follows a lens's, at half power, behind its focus") {
  for (const Probe& probe : probes()) {
    Pair pair = pair_of(probe);
    const double focus = pair.transducer.elevation_focus_mm;
    pair.beamforming.transmit_focus_mm = focus;
    const ScanLine line = line_at(pair.transducer, 0);
    const auto thickness = [&](double depth) {
      return beam_profile(pair.transducer, pair.beamforming, line, depth, kHalfPower).elevation_mm;
    };
    pair.settings.slice_planes = 3;
    pair.settings.elevation_focus_mm = focus;
    pair.settings.slice_thickness_mm = thickness(focus);
    CAPTURE(probe.name);
    // 0.638 lambda F / height, a little more for a short pulse.
    CHECK(pair.settings.slice_thickness_mm / (pair.transducer.wavelength_mm() * focus / pair.transducer.height_mm) ==
          Approx(0.638).epsilon(0.05));
    for (const double share : {1.125, 1.25, 1.5, 2.0}) {
      CAPTURE(share);
      // The formula's Gaussian beam spreads faster than the middle of an evenly weighted aperture's: at twice the focus
      // it is 1.34 times as wide.
      CHECK(ratio(slice_thickness_at_mm(pair.settings, share * focus), thickness(share * focus)) ==
            Approx(1.1).margin(share < 2 ? 0.2 : 0.25));
    }
  }
}
