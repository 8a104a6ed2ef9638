#include "tools/render/wein.h"

#include <memory>

#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/upload.h"
#include "sim/wein/wein_reference.h"
#include "sim/wein/wein_settings_file.h"
#include "sim/wein/wein_simulator.h"
#include "tools/render/stage_description.h"
#include "tools/render/stage_files.h"

namespace insonate {

RenderedWein render_wein(const std::string& file, const WeinScene& scene, bool by_reference) {
  if (by_reference) {
    const WeinStages<double> stages =
        wein_reference(wein_field(scene.volume, scene.settings.reflection_length_mm), scene.probe, scene.depth_mm,
                       scene.settings, scene.patient_from_probe);
    return {WeinStages<float>{in_single_precision(stages.intensity),
                              in_single_precision(stages.scan_echogenicity),
                              in_single_precision(stages.scan_reflection),
                              {},
                              {},
                              stages.grey},
            kMadeByReference};
  }
  const gl::HeadlessContext context;
  std::unique_ptr<gl::WeinSimulator> simulator;
  gl::upload_ct(file, scene.volume.grid, [&] {
    simulator = std::make_unique<gl::WeinSimulator>(scene.volume, scene.probe, scene.depth_mm, scene.settings);
  });
  return {simulator->read_stages(scene.patient_from_probe), gl::device_description()};
}

void write_stages(const std::filesystem::path& folder, const WeinScene& scene, const RenderedWein& rendered) {
  const WeinSettings& settings = scene.settings;
  const StageGeometry geometry(scene.probe, scene.depth_mm, settings.samples, settings.image_width,
                               settings.image_height);
  nlohmann::ordered_json text =
      describe_geometry("W", geometry, scene.patient_from_probe, scene.volume, rendered.made_by);
  describe_settings(text, named_settings(settings));
  text["air_mu"] = kAirMu;
  text["contact_tissue_hu"] = kCouplingTissue_hu;
  text["contact_air_hu"] = kCouplingAir_hu;
  write_file(folder / "scanlines.json", text.dump(1) + "\n");
  write_hounsfield(folder, scene.volume);
  write_among_lines(folder, "intensity", rendered.stages.intensity, "I, relative to the intensity at the face");
  write_among_lines(folder, "scan_echogenicity", rendered.stages.scan_echogenicity, "E, times I if 'shadows' is true");
  write_among_lines(folder, "scan_reflection", rendered.stages.scan_reflection, "R, 0 to 1");
  write_pixel_positions(folder, geometry);
  write_as_picture(folder, "image", in_single_precision(rendered.stages.grey), "s R + (1 - s) E, 255 for 1");
}

}  // namespace insonate
