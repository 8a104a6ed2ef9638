#include "sim/model/effects.h"

#include <catch2/catch.hpp>

#include <set>
#include <string_view>

#include "sim/model/settings_file.h"

using namespace insonate;

TEST_CASE("every effect has a name of its own, is on in the trainer, and changes the settings") {
  std::set<std::string_view> names;
  const Settings usual = with_usual_display(trainer_settings(3.5, 150));
  for (const Effect& effect : effects()) {
    CAPTURE(effect.name);
    CHECK(names.insert(effect.name).second);
    CHECK(find_effect(effect.name) == &effect);
    CHECK(effect.value(usual) >= effect.least);
    CHECK(effect.value(usual) <= effect.most);
    if (effect.is_switch()) CHECK(effect.value(usual) == 1);
    for (const double value : {effect.least, effect.most}) {
      Settings changed = usual;
      effect.set(changed, value);
      CHECK(effect.value(changed) == Approx(value));
      CHECK_FALSE(why_not_valid(changed));
      CHECK((changed != usual || value == effect.value(usual)));
    }
  }
  CHECK_FALSE(find_effect(""));
  CHECK_FALSE(find_effect("none"));
}
