#include "sim/model/settings.h"

#include <algorithm>

namespace insonate {

Settings paper_settings(double depth_mm, int samples) {
  Settings settings;
  settings.samples = samples;
  settings.reflection_length_mm = depth_mm / samples;
  settings.absorption = false;
  settings.gel_mm = 0;
  settings.two_way = false;
  settings.reference_level = ReferenceLevel::frame_maximum;
  return settings;
}

Settings trainer_settings(double frequency_mhz, double depth_mm) {
  constexpr double kSoftTissueAbsorption = 0.5;  // dB/(cm MHz), what machines assume of an abdomen
  Settings settings;
  settings.frequency_mhz = frequency_mhz;
  const double two_way_db = 2 * kSoftTissueAbsorption * frequency_mhz * depth_mm / 10;
  for (std::size_t i = 0; i < settings.tgc_db.size(); ++i)
    settings.tgc_db[i] = std::min(two_way_db * double(i) / double(settings.tgc_db.size() - 1), kMostTimeGainDb);
  return settings;
}

}  // namespace insonate
