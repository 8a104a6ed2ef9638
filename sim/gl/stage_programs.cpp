#include "sim/gl/stage_programs.h"

#include <algorithm>
#include <cmath>

#include "sim/model/beam.h"

namespace insonate::gl {
namespace {

std::string flag(bool on) {
  return on ? "1" : "0";
}

// Of the stages that walk along lines.
Defines in_groups(const Scheme& scheme, Defines defines = {}) {
  defines.emplace_back("GROUP", std::to_string(scheme.group));
  return defines;
}

Defines traversal(const Settings& settings, double dr_mm) {
  const double samples_a_length = settings.reflection_length_mm / dr_mm;
  const auto is = [&](double whole) { return std::abs(samples_a_length - whole) < 1e-9; };
  return {{"EDGES_AT", is(2)   ? "kEdgesAtSamples"
                       : is(1) ? "kEdgesAtMiddles"
                               : "kEdgesAnywhere"},
          {"ABSORPTION", flag(settings.absorption)},
          {"SPECKLE", flag(settings.speckle)},
          {"EDGE_SHADOW", flag(settings.edge_shadow)},
          {"EXACT_FILTER", flag(settings.exact_filter)},
          {"SKIPPING", flag(settings.skipping)},
          {"ELEVATION_FOCUS", flag(slice_bends(settings))},
          {"PLANES", std::to_string(settings.slice_planes)},
          {"KEEP_MIDDLE", flag(keeps_middle_plane(settings))}};
}

Defines reverberation_of(const Settings& settings) {
  return {{"IN_TISSUE", flag(settings.reverberation)}, {"AT_FACE", flag(settings.face_reflection > 0)}};
}

Defines beam_of(const Settings& settings) {
  return {{"FOCUSED_BEAM", flag(settings.focused_beam)},
          {"BEAM_HALF", settings.focused_beam ? "0" : std::to_string(settings.beam_lines / 2)},
          {"REVERBERATION", flag(reverberates(settings))}};
}

Defines conversion(const StageVariant& variant) {
  return {{"REFLECTION_SMOOTHED", flag(variant.reflection_radius_px > 0)},
          {"TRANSMISSION_SMOOTHED", flag(variant.transmission_radius_px > 0)},
          {"SMOOTHED", variant.transmission_radius_px > 0 ? "vec2" : "float"},
          {"NOISE", flag(is_noisy(variant.settings))},
          {"CLUTTER", flag(variant.settings.clutter)}};
}

Defines smoothing(const StageVariant& variant) {
  return {{"REFLECTION_RADIUS", std::to_string(variant.reflection_radius_px)},
          {"TRANSMISSION_RADIUS", std::to_string(variant.transmission_radius_px)},
          {"SMOOTHED", variant.transmission_radius_px > 0 ? "vec2" : "float"}};
}

Defines display(const Settings& settings) {
  return {{"GREY_MAP", std::to_string(int(settings.grey_map))}};
}

Defines fusion(const StageVariant& variant) {
  Defines defines = smoothing(variant);
  defines.push_back(display(variant.settings).front());
  const auto none = [](double db) { return db == 0; };
  defines.emplace_back("TIME_GAIN", flag(!std::ranges::all_of(variant.settings.tgc_db, none)));
  defines.emplace_back("FRAME_MAXIMUM", flag(variant.settings.reference_level == ReferenceLevel::frame_maximum));
  defines.emplace_back("KEEP_FUSED", flag(variant.keeps_fused));
  return defines;
}

// Until settings are known.
StageVariant plain(const Settings& settings) {
  return {settings, 1, 0, 0, false};
}

}  // namespace

bool reverberates(const Settings& settings) {
  return settings.reverberation || settings.face_reflection > 0;
}
bool keeps_middle_plane(const Settings& settings) {
  return settings.slice_planes > 1 && reverberates(settings);
}
bool is_noisy(const Settings& settings) {
  return settings.electronic_noise || settings.clutter;
}

StagePrograms::StagePrograms(const ShaderSources& sources, const Scheme& scheme)
    : traverse(sources, {"traverse.comp"}, in_groups(scheme, traversal({}, 1))),
      reverberation(sources, {"reverberation.comp"}, in_groups(scheme, reverberation_of({}))),
      beam(sources, {"beam.comp"}, beam_of({})),
      clutter(sources, {"clutter.comp"}, in_groups(scheme)),
      clutter_tail(sources, {"clutter_tail.comp"}),
      scan_convert(sources, {"scan_convert.comp"}, conversion(plain({}))),
      smooth(sources, {"smooth.comp"}, smoothing(plain({}))),
      fuse(sources, {"fuse.comp"}, fusion(plain({}))),
      maximum(sources, {"maximum.comp"}),
      compress(sources, {"compress.comp"}, display({})),
      sources_(sources),
      scheme_(scheme) {}

void StagePrograms::build_from(Stage first, const StageVariant& variant) {
  const Settings& settings = variant.settings;
  if (first <= Stage::traverse) traverse.define(sources_, in_groups(scheme_, traversal(settings, variant.dr_mm)));
  if (first <= Stage::beam) {
    if (reverberates(settings)) reverberation.define(sources_, in_groups(scheme_, reverberation_of(settings)));
    beam.define(sources_, beam_of(settings));
  }
  if (first <= Stage::scan_convert) scan_convert.define(sources_, conversion(variant));
  if (first <= Stage::smooth) smooth.define(sources_, smoothing(variant));
  if (first <= Stage::fuse) fuse.define(sources_, fusion(variant));
  compress.define(sources_, display(settings));
}

std::optional<std::string> StagePrograms::reload(const ShaderSources& sources) {
  std::string problems;
  for (Program* program :
       {&traverse, &reverberation, &beam, &scan_convert, &smooth, &clutter, &clutter_tail, &fuse, &maximum, &compress})
    if (const auto problem = program->reload(sources)) problems += *problem;
  if (!problems.empty()) return problems;
  sources_ = sources;  // not before: others would fail when a program is built for other settings
  return std::nullopt;
}

}  // namespace insonate::gl
