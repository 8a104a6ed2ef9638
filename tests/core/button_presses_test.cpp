#include "sim/core/button_presses.h"

#include <catch2/catch.hpp>

using namespace insonate;

namespace {

ProbeSample sample(PoseStatus status, std::uint32_t buttons) {
  return {0, status, Pose{}, buttons};
}

constexpr PoseStatus kSeen[] = {PoseStatus::ok, PoseStatus::switched, PoseStatus::invalid};
constexpr PoseStatus kUnseen[] = {PoseStatus::missing, PoseStatus::out_of_view, PoseStatus::out_of_volume,
                                  PoseStatus::unknown};

}  // namespace

TEST_CASE("a button that is held across a dropout of any kind was pressed once") {
  for (const PoseStatus seen : kSeen)
    for (const PoseStatus unseen : kUnseen) {
      CAPTURE(to_string(seen), to_string(unseen));
      ButtonPresses presses(0);
      CHECK(presses.see(sample(seen, 2)) == 2);
      CHECK(presses.see(sample(unseen, 0)) == 0);
      CHECK(presses.see(sample(unseen, 0)) == 0);
      CHECK(presses.see(sample(seen, 2)) == 0);
      // Let go and pressed again, it was pressed again.
      CHECK(presses.see(sample(seen, 0)) == 0);
      CHECK(presses.see(sample(seen, 2)) == 2);
    }
}

TEST_CASE("a button that is pressed during a dropout acts when it is reported, once") {
  for (const PoseStatus unseen : kUnseen) {
    CAPTURE(to_string(unseen));
    ButtonPresses presses(0);
    CHECK(presses.see(sample(PoseStatus::ok, 0)) == 0);
    CHECK(presses.see(sample(unseen, 4)) == 4);
    CHECK(presses.see(sample(unseen, 0)) == 0);
    CHECK(presses.see(sample(PoseStatus::ok, 4)) == 0);
    CHECK(presses.see(sample(PoseStatus::ok, 5)) == 1);
  }
}

TEST_CASE("buttons that are held at the start are ignored, also behind a dropout") {
  for (const PoseStatus first : {PoseStatus::ok, PoseStatus::missing, PoseStatus::out_of_view}) {
    CAPTURE(to_string(first));
    ButtonPresses presses;
    CHECK(presses.see(sample(first, 0)) == 0);
    if (first == PoseStatus::ok) continue;
    CHECK(presses.see(sample(PoseStatus::ok, 1)) == 0);
    CHECK(presses.see(sample(PoseStatus::ok, 0)) == 0);
    CHECK(presses.see(sample(PoseStatus::ok, 1)) == 1);
  }
}
