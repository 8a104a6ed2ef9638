#include "tools/render_wein.h"

#include <memory>

#include "sim/gl/headless_context.h"
#include "sim/gl/upload.h"
#include "sim/gl/wein_simulator.h"
#include "sim/reference/wein_reference.h"

namespace insonate {

Image<std::uint8_t> render_wein(const std::string& file, const AcousticVolume& volume, const Probe& probe,
                                double depth_mm, const WeinSettings& settings, const Pose& patient_from_probe,
                                bool by_reference) {
  if (by_reference)
    return wein_reference(wein_field(volume, settings.reflection_length_mm), probe, depth_mm, settings,
                          patient_from_probe)
        .grey;
  const gl::HeadlessContext context;
  std::unique_ptr<gl::WeinSimulator> simulator;
  gl::upload_ct(file, volume.grid,
                [&] { simulator = std::make_unique<gl::WeinSimulator>(volume, probe, depth_mm, settings); });
  return simulator->read_stages(patient_from_probe).grey;
}

}  // namespace insonate
