#include "devices/igtl/sender_clock.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "sim/core/hash.h"

namespace insonate::igtl {
namespace {

constexpr double kOffset_s = 12345.5;

/// What a network adds to message `i`: 1 ms at the least, now and then 60 ms, rarely nothing of the sort.
double held_up_s(std::uint32_t i) {
  const double u = double(unit_float(hash(i, 3)));
  return 0.001 + (u < 0.05 ? 0.060 : 0.004 * u);
}

}  // namespace

TEST_CASE("a first message that was held up is not what the others are tied to") {
  SenderClock clock;
  CHECK(clock.time_of(100, 100 + kOffset_s + 0.4) == Approx(100.4 + kOffset_s).epsilon(1e-12));
  for (std::uint32_t i = 1; i < 600; ++i) {
    const double sent_s = 100 + i / 60.0;
    const double time_s = clock.time_of(sent_s, sent_s + kOffset_s + held_up_s(i));
    // Within the least that the network adds and the tolerance.
    CHECK(time_s - sent_s - kOffset_s > 0);
    CHECK(time_s - sent_s - kOffset_s <= 0.001 + 0.004 + 0.010);
  }
}

TEST_CASE("if no message of a window is as early as the first was, later ones are tied to the earliest of them") {
  SenderClock clock;
  const auto delayed = [&](double sent_s) { return clock.time_of(sent_s, kOffset_s + sent_s + 0.05) - kOffset_s; };
  clock.time_of(0, kOffset_s);
  // The first message is in the first window, so the second one decides.
  for (int tenth = 1; tenth < 100; ++tenth) CHECK(delayed(tenth / 10.0) == Approx(tenth / 10.0));
  CHECK(delayed(10.1) == Approx(10.15));
}

TEST_CASE("as long as nothing speaks against it the steps between messages are the sender's own") {
  SenderClock clock;
  double before_s = clock.time_of(100, 100 + kOffset_s + held_up_s(0)), before_sent_s = 100;
  for (std::uint32_t i = 1; i < 3000; ++i) {
    const double sent_s = 100 + i / 60.0;
    const double time_s = clock.time_of(sent_s, sent_s + kOffset_s + held_up_s(i));
    // Sums of ten thousands of seconds round to 4e-12 s.
    CHECK(time_s - before_s == Approx(sent_s - before_sent_s).margin(1e-10));
    before_s = time_s;
    before_sent_s = sent_s;
  }
}

TEST_CASE("a clock that drifts either way is followed within the tolerance, and one that is set at once") {
  for (const double drift : {1e-4, -1e-4}) {  // ten times what a quartz is off
    SenderClock clock;
    for (std::uint32_t i = 0; i < 60 * 1200; ++i) {
      const double now_s = i / 60.0;
      const double sent_s = now_s * (1 + drift);
      const double time_s = clock.time_of(sent_s, now_s + 0.002);
      // The tolerance, and what the clock drifts in a window and a bit.
      CHECK(std::abs(time_s - (now_s + 0.002)) <= 0.010 + 2 * SenderClock::kWindow_s * std::abs(drift) + 1e-9);
    }
  }
  SenderClock clock;
  clock.time_of(50, 1000);
  CHECK(clock.time_of(90000, 1000.1) == Approx(1000.1));
  CHECK(clock.time_of(90000.1, 1000.25) == Approx(1000.2));
  CHECK(clock.time_of(50, 1001) == Approx(1001));
}

}  // namespace insonate::igtl
