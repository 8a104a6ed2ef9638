// Files of transducers.
#include "sim/acoustics/transducer.h"

#include <cmath>

#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

bool is_within(double value, double least, double most) {
  return value >= least && value <= most;
}

const Target transducer_target("transducer", [](std::string_view bytes) -> std::string {
  const Transducer transducer = read_transducer(file_with("transducer.toml", bytes));
  if (!is_within(transducer.elements, 1, 1024) || !is_within(transducer.pitch_mm, 0.02, 5) ||
      !(transducer.element_width_mm() > 0) || transducer.kerf_mm < 0 || !is_within(transducer.radius_mm, 5, 200) ||
      !is_within(transducer.height_mm, 0.1, 50) ||
      (transducer.elevation_focus_mm != 0 && !is_within(transducer.elevation_focus_mm, 1, 1000)) ||
      !is_within(transducer.frequency_mhz, 0.5, 30) || !is_within(transducer.bandwidth_percent, 5, 120) ||
      !is_within(transducer.excitation_cycles, 0, 50))
    return "a number is out of range";
  const auto places = element_places(transducer);
  if (int(places.size()) != transducer.elements) return "elements are missing";
  for (const ElementPlace& place : places)
    if (!std::isfinite(place.centre.x) || !std::isfinite(place.centre.y)) return "an element lies nowhere";
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
