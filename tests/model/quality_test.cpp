// Levels of quality as settings.

#include "sim/model/quality.h"

#include <catch2/catch.hpp>

#include "sim/model/settings_file.h"

using namespace insonate;

TEST_CASE("a level of quality changes samples and pixels alone, balanced nothing") {
  const Settings balanced = trainer_settings(3.5, 160);
  CHECK(at_quality(balanced, Quality::balanced) == balanced);
  const Settings fast = at_quality(balanced, Quality::fast), exact = at_quality(balanced, Quality::exact);
  CHECK(fast.samples < balanced.samples);
  CHECK(fast.image_width < balanced.image_width);
  CHECK(fast.image_width * balanced.image_height == fast.image_height * balanced.image_width);
  CHECK(exact.samples > balanced.samples);
  for (Settings other : {fast, exact}) {
    other.samples = balanced.samples;
    other.image_width = balanced.image_width;
    other.image_height = balanced.image_height;
    CHECK(other == balanced);
  }
}

TEST_CASE("settings at the ends of their ranges stay within them at every quality") {
  Settings settings;
  for (const int count : {1, 8192}) {
    settings.samples = settings.image_width = settings.image_height = count;
    for (const Quality quality : kQualities) CHECK_FALSE(why_not_valid(at_quality(settings, quality)));
  }
}

TEST_CASE("levels of quality are known by their names") {
  for (const Quality quality : kQualities) CHECK(quality_named(name_of(quality)) == quality);
  CHECK(quality_names() == std::vector<std::string>{"fast", "balanced", "exact"});
  CHECK_THROWS_AS(quality_named("best"), std::invalid_argument);
}
