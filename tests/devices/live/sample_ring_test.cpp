#include "devices/live/sample_ring.h"

#include <catch2/catch.hpp>

#include <thread>

#include "sim/core/probe_sample.h"

using namespace insonate;

TEST_CASE("a ring publishes in order, round and round, and counts what it has no room for") {
  SampleRing<int> ring(5);
  CHECK(ring.capacity() == 8);
  std::vector<int> out;
  int next = 0;
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 5; ++i) CHECK(ring.push(next++));
    ring.drain(out);
  }
  REQUIRE(out.size() == 100);
  for (int i = 0; i < 100; ++i) CHECK(out[std::size_t(i)] == i);

  for (int i = 0; i < 11; ++i) CHECK(ring.push(i) == (i < 8));
  CHECK(ring.dropped() == 3);
  out.clear();
  ring.drain(out);
  CHECK(out == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
  ring.drain(out);
  CHECK(out.size() == 8);
  CHECK(ring.push(12));
}

TEST_CASE("between two threads no sample is torn, swapped, repeated or lost without being counted") {
  // Small, so that it is often full; each field of a sample is made from its number.
  SampleRing<ProbeSample> ring(16);
  constexpr std::uint32_t kSamples = 200000;
  std::thread producer([&] {
    for (std::uint32_t i = 1; i <= kSamples; ++i) {
      ProbeSample sample;
      sample.time_s = i;
      sample.buttons = i;
      sample.patient_from_probe.translation = glm::dvec3(i);
      ring.push(sample);
    }
    // The end is not to be lost.
    ProbeSample end;
    end.time_s = kSamples + 1;
    while (!ring.push(end)) std::this_thread::yield();
  });
  std::vector<ProbeSample> samples;
  std::uint64_t received = 0, torn = 0, unordered = 0;
  double last = 0;
  while (last <= kSamples) {
    samples.clear();
    ring.drain(samples);
    for (const ProbeSample& sample : samples) {
      unordered += !(sample.time_s > last);
      last = sample.time_s;
      if (last > kSamples) break;
      ++received;
      torn += sample.buttons != std::uint32_t(last) || sample.patient_from_probe.translation != glm::dvec3(last);
    }
    std::this_thread::yield();
  }
  producer.join();
  CHECK(torn == 0);
  CHECK(unordered == 0);
  // Pushes of the end that found no room are counted as well.
  CHECK(received + ring.dropped() >= kSamples);
  CHECK(received > 0);
}
