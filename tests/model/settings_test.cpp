// What the trainer starts with.

#include "sim/model/settings.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("the trainer's reflection length is its pulse's at any depth, two samples long") {
  for (const double frequency_mhz : {2.5, 3.5, 7.5})
    for (const double depth_mm : {30.0, 60.0, 160.0, 240.0}) {
      CAPTURE(frequency_mhz, depth_mm);
      const Settings settings = trainer_settings(frequency_mhz, depth_mm);
      const double one_sample_more = 1.0 / settings.samples;  // samples are whole
      CHECK(settings.reflection_length_mm == Approx(2.1 / frequency_mhz).epsilon(one_sample_more));
      CHECK(settings.samples * settings.reflection_length_mm == Approx(2 * depth_mm));
    }
}
