#include "sim/imaging/picture_programs.h"

#include "sim/imaging/stage_tables.h"

namespace insonate::gl {
namespace {

Defines conversion(const PictureVariant& variant) {
  return {{"REFLECTION_SMOOTHED", flag(variant.reflection_radius_px > 0)},
          {"TRANSMISSION_SMOOTHED", flag(variant.transmission_radius_px > 0)},
          {"SMOOTHED", variant.transmission_radius_px > 0 ? "vec2" : "float"},
          {"WAVES", flag(variant.settings.waves)},
          {"LOOKS", std::to_string(variant.looks)},
          {"NOISE", flag(is_noisy(variant.settings))},
          {"CLUTTER", flag(variant.settings.clutter)}};
}

Defines smoothing(const PictureVariant& variant) {
  return {{"REFLECTION_RADIUS", std::to_string(variant.reflection_radius_px)},
          {"TRANSMISSION_RADIUS", std::to_string(variant.transmission_radius_px)},
          {"SMOOTHED", variant.transmission_radius_px > 0 ? "vec2" : "float"}};
}

Defines display(const PictureVariant& variant) {
  return {{"GREY_MAP", std::to_string(int(variant.settings.grey_map))},
          {"KEEP_SHOWN", flag(variant.settings.persistence > 0 || variant.filter_radius_px > 0)},
          {"FILTERED", flag(variant.filter_radius_px > 0)}};
}

Defines fusion(const PictureVariant& variant) {
  Defines defines = smoothing(variant);
  for (const auto& define : display(variant)) defines.push_back(define);
  defines.emplace_back("LOOKS", std::to_string(variant.looks));
  defines.emplace_back("TIME_GAIN", flag(has_time_gain(variant.settings)));
  defines.emplace_back("FRAME_MAXIMUM", flag(variant.settings.reference_level == ReferenceLevel::frame_maximum));
  defines.emplace_back("KEEP_FUSED", flag(variant.keeps_fused));
  return defines;
}

Defines filtering(const PictureVariant& variant) {
  return {{"RADIUS", std::to_string(variant.filter_radius_px)},
          {"GREY_MAP", std::to_string(int(variant.settings.grey_map))}};
}

// The variant for shaders that are built before settings are known.
PictureVariant plain(const Settings& settings) {
  return {settings, 0, 0, 1, 0, false};
}

}  // namespace

PicturePrograms::PicturePrograms(const ShaderSources& sources)
    : scan_convert(sources, {"imaging/scan_convert.comp"}, conversion(plain({}))),
      smooth(sources, {"imaging/smooth.comp"}, smoothing(plain({}))),
      fuse(sources, {"imaging/fuse.comp"}, fusion(plain({}))),
      maximum(sources, {"imaging/maximum.comp"}),
      compress(sources, {"imaging/compress.comp"}, display(plain({}))),
      enhance_rows(sources, {"imaging/enhance_rows.comp"}, filtering(plain({}))),
      enhance(sources, {"imaging/enhance.comp"}, filtering(plain({}))) {}

void PicturePrograms::build_from(Stage first, const PictureVariant& variant) {
  if (first <= Stage::scan_convert) scan_convert.define(conversion(variant));
  if (first <= Stage::smooth) smooth.define(smoothing(variant));
  if (first <= Stage::fuse) fuse.define(fusion(variant));
  compress.define(display(variant));
  if (variant.filter_radius_px == 0) return;
  enhance_rows.define(filtering(variant));
  enhance.define(filtering(variant));
}

}  // namespace insonate::gl
