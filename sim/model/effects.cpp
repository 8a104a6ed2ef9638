#include "sim/model/effects.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace insonate {
namespace {

/// Returns a switch of one setting.
template <bool Settings::*kMember>
constexpr Effect flag_effect(std::string_view name) {
  return {name,
          0,
          1,
          true,
          [](const Settings& s) { return double(s.*kMember); },
          [](Settings& s, double on) { s.*kMember = on != 0; }};
}

template <double Settings::*kMember>
constexpr Effect number_effect(std::string_view name, double least, double most) {
  return {name,
          least,
          most,
          false,
          [](const Settings& s) { return s.*kMember; },
          [](Settings& s, double value) { s.*kMember = value; }};
}

/// Returns a switch of a setting that is off at 0 and otherwise has a strength.
template <double Settings::*kMember>
constexpr Effect strength_effect(std::string_view name) {
  return {name,
          0,
          1,
          true,
          [](const Settings& s) { return double(s.*kMember > 0); },
          [](Settings& s, double on) {
            if (on == 0) s.*kMember = 0;
          }};
}

constexpr std::array kEffects{
    flag_effect<&Settings::absorption>("absorption"),
    Effect{"waves", 0, 1, true, [](const Settings& s) { return double(s.waves); },
           [](Settings& s, double on) {
             if (on != 0) return;
             s.waves = false;
             s.transmission_sigma_mm = 1;  // the paper's sums need smoothing, (6)
           }},
    flag_effect<&Settings::speckle>("speckle"),
    flag_effect<&Settings::focused_beam>("focused_beam"),
    Effect{"slice_thickness", 0, 1, true, [](const Settings& s) { return double(s.slice_planes > 1); },
           [](Settings& s, double on) {
             if (on == 0) s.slice_planes = 1;
           }},
    flag_effect<&Settings::reverberation>("reverberation"),
    strength_effect<&Settings::face_reflection>("face_reverberation"),
    strength_effect<&Settings::mirror_image>("mirror_image"),
    flag_effect<&Settings::edge_shadow>("edge_shadow"),
    flag_effect<&Settings::clutter>("clutter"),
    flag_effect<&Settings::electronic_noise>("noise"),
    strength_effect<&Settings::ring_down>("ring_down"),
    flag_effect<&Settings::two_way>("two_way"),
    number_effect<&Settings::focus_mm>("focus_mm", 10, 240),
    number_effect<&Settings::f_number>("f_number", 1, 10),
    Effect{"scattering_db", -20, 20, false,
           [](const Settings& s) { return 10 * std::log10(s.blend / Settings().blend); },
           [](Settings& s, double db) { s.blend = Settings().blend * std::pow(10.0, db / 10); }},
    Effect{"grey_map", 0, 3, true, [](const Settings& s) { return double(s.grey_map); },
           [](Settings& s, double map) { s.grey_map = GreyMap(int(map)); }},
};

}  // namespace

std::span<const Effect> effects() {
  return kEffects;
}

const Effect* find_effect(std::string_view name) {
  const auto found = std::ranges::find(kEffects, name, &Effect::name);
  return found == kEffects.end() ? nullptr : &*found;
}

}  // namespace insonate
