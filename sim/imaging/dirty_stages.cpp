#include "sim/imaging/dirty_stages.h"

#include "sim/imaging/stage_tables.h"
#include "sim/model/beam.h"
#include "sim/model/display_filter.h"

namespace insonate::gl {
namespace {

// Returns the settings with all unused ones at their defaults, so that changes of these compare equal.
Settings in_use(Settings settings) {
  const Settings unset;
  const auto forget = [&](auto... members) { ((settings.*members = unset.*members), ...); };
  using S = Settings;
  if (!has_slice(settings)) forget(&S::slice_thickness_mm, &S::elevation_focus_mm);
  if (!settings.speckle) forget(&S::speckle_seed, &S::speckle_cell_mm);
  if (settings.focused_beam)
    forget(&S::beam_window, &S::beam_lines);
  else
    forget(&S::focus_mm, &S::f_number);
  if (settings.waves)
    forget(&S::reflection_sigma_mm, &S::transmission_sigma_mm);
  else
    forget(&S::specular_exponent, &S::mirror_image, &S::steering_angles, &S::steering_deg, &S::ring_down);
  if (settings.steering_angles == 1) forget(&S::steering_deg);
  if (!settings.absorption && !settings.focused_beam && !has_elevation_focus(settings) &&
      settings.steering_angles == 1 && !is_filtered(settings) && settings.ring_down == 0)
    forget(&S::frequency_mhz);
  if (!settings.clutter) forget(&S::clutter_db);
  if (!settings.electronic_noise) forget(&S::noise_db);
  if (!settings.electronic_noise && settings.ring_down == 0 &&
      settings.reference_level == ReferenceLevel::frame_maximum)
    forget(&S::fixed_level);
  return settings;
}

Settings in_use_by_sweeps(Settings settings) {
  const Settings unset;
  settings.image_width = unset.image_width;
  settings.image_height = unset.image_height;
  settings.reflection_sigma_mm = unset.reflection_sigma_mm;
  settings.transmission_sigma_mm = unset.transmission_sigma_mm;
  settings.steering_angles = unset.steering_angles;
  settings.steering_deg = unset.steering_deg;
  settings.persistence = unset.persistence;
  settings.edge_enhancement = unset.edge_enhancement;
  settings.speckle_reduction = unset.speckle_reduction;
  return settings;
}

// Returns the stage of a sweep that does the work of a picture's stage.
SweepStage sweep_stage(Stage of_picture) {
  switch (of_picture) {
    case Stage::traverse:
      return SweepStage::traverse;
    case Stage::beam:
      return SweepStage::beam;
    case Stage::scan_convert:
    case Stage::smooth:
      return SweepStage::fuse;
    case Stage::fuse:
      return SweepStage::maximum;
    case Stage::compress:
    case Stage::enhance:
      return SweepStage::compress;
  }
  return SweepStage::traverse;
}

}  // namespace

DirtyStages dirty_stages(const Settings& before, const Settings& now) {
  const Settings from = in_use(before), to = in_use(now);
  using S = Settings;
  const auto differ = [&](auto... members) { return ((from.*members != to.*members) || ...); };

  DirtyStages dirty;
  dirty.layout = differ(&S::samples, &S::waves, &S::slice_planes, &S::image_width, &S::image_height,
                        &S::steering_angles, &S::steering_deg);
  dirty.beam = differ(&S::beam_window, &S::beam_lines, &S::focused_beam, &S::focus_mm, &S::f_number, &S::frequency_mhz,
                      &S::speckle, &S::reverberation, &S::face_reflection, &S::speckle_cell_mm, &S::slice_thickness_mm,
                      &S::elevation_focus_mm, &S::waves, &S::reflection_length_mm);

  if (differ(&S::samples, &S::reflection_length_mm, &S::frequency_mhz, &S::absorption, &S::gel_mm, &S::speckle,
             &S::speckle_seed, &S::speckle_cell_mm, &S::slice_planes, &S::slice_thickness_mm, &S::elevation_focus_mm,
             &S::edge_shadow, &S::waves, &S::specular_exponent, &S::mirror_image, &S::image_width, &S::image_height,
             &S::exact_filter, &S::skipping, &S::steering_angles, &S::steering_deg) ||
      (keeps_middle_plane(to) && !keeps_middle_plane(from)) ||
      (to.mirror_image > 0 && differ(&S::face_reflection)) ||  // the face repeats what gas mirrors
      // The scatterers' scale depends on the beam.
      (to.waves && differ(&S::blend, &S::two_way, &S::beam_window, &S::beam_lines, &S::focused_beam, &S::focus_mm,
                          &S::f_number)) ||
      least_alpha_with_normal(to) != least_alpha_with_normal(from))  // other interfaces are worth a normal
    dirty.first = Stage::traverse;
  else if (differ(&S::beam_window, &S::beam_lines, &S::focused_beam, &S::focus_mm, &S::f_number, &S::reverberation,
                  &S::face_reflection, &S::clutter, &S::two_way))
    dirty.first = Stage::beam;
  else if (differ(&S::reflection_sigma_mm, &S::transmission_sigma_mm, &S::blend, &S::clutter_db, &S::electronic_noise,
                  &S::noise_db, &S::ring_down) ||
           ((to.electronic_noise || to.ring_down > 0) && differ(&S::fixed_level)))
    dirty.first = Stage::scan_convert;
  else if (differ(&S::gain_db, &S::tgc_db, &S::reference_level, &S::fixed_level))
    dirty.first = Stage::fuse;
  else if (differ(&S::dynamic_range_db, &S::grey_map) ||
           is_filtered(to) != is_filtered(from))  // what the filter reads is kept for it alone
    dirty.first = to.reference_level == ReferenceLevel::fixed ? Stage::fuse : Stage::compress;
  else if (differ(&S::edge_enhancement, &S::speckle_reduction))
    dirty.first = Stage::enhance;
  return dirty;
}

DirtySweepStages dirty_sweep_stages(const Settings& before, const Settings& now) {
  const DirtyStages dirty = dirty_stages(in_use_by_sweeps(before), in_use_by_sweeps(now));
  DirtySweepStages in_sweep{std::nullopt, dirty.layout, dirty.beam};
  if (dirty.first) in_sweep.first = sweep_stage(*dirty.first);
  return in_sweep;
}

}  // namespace insonate::gl
