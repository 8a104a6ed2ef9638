#include "devices/latency_histogram.h"

#include <catch2/catch.hpp>

using namespace insonate;

TEST_CASE("a latency histogram counts by the millisecond and returns what a share stays below") {
  LatencyHistogram histogram;
  CHECK(histogram.quantile_s(0.5) == 0);
  for (int i = 0; i < 90; ++i) histogram.add(0.0045);
  for (int i = 0; i < 9; ++i) histogram.add(0.0121);
  histogram.add(3600);
  CHECK(histogram.count() == 100);
  CHECK(histogram.counts()[4] == 90);
  CHECK(histogram.counts()[12] == 9);
  CHECK(histogram.counts()[LatencyHistogram::kSteps - 1] == 1);
  CHECK(histogram.quantile_s(0.5) == Approx(0.005));
  CHECK(histogram.quantile_s(0.95) == Approx(0.013));
  CHECK(histogram.quantile_s(1) == Approx(0.2));
  CHECK(histogram.text().find("median 5 ms, 95 % below 13 ms") == 0);
}

TEST_CASE("histograms become columns of a CSV, down to the last step in use") {
  LatencyHistogram a, b;
  a.add(0.0002);
  b.add(0.0025);
  b.add(-1);
  CHECK(to_csv({"a", "b"}, {a, b}) == "from_ms,a,b\n0,1,1\n1,0,0\n2,0,1\n");
}
