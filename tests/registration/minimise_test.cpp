// Tests the local searches that advance together, and the scattered starts.

#include "sim/registration/minimise.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>
#include <stdexcept>

using namespace insonate;

namespace {

// A paraboloid with its top at (1, -2, 3).
double hill(const Parameters& x) {
  return 5 - std::pow(x[0] - 1, 2) - 2 * std::pow(x[1] + 2, 2) - 0.5 * std::pow(x[2] - 3, 2);
}

LocalSearch within(double bound) {
  LocalSearch search;
  search.low = Parameters(3, -bound);
  search.high = Parameters(3, bound);
  search.tolerance = 1e-4;
  return search;
}

}  // namespace

TEST_CASE("local searches find the top from every start, and share their calls") {
  std::size_t calls = 0, points = 0;
  const EvaluateAll evaluate = [&](std::span<const Parameters> all) {
    ++calls;
    points += all.size();
    std::vector<double> values;
    for (const Parameters& x : all) values.push_back(hill(x));
    return values;
  };
  const std::vector<Parameters> starts{{0, 0, 0}, {8, -8, 8}, {-5, 4, 1}, {2, 2, -9}};
  const std::vector<Optimum> found = maximise_from(starts, evaluate, within(10));
  REQUIRE(found.size() == starts.size());
  int longest = 0, all = 0;
  for (const Optimum& each : found) {
    CHECK(each.within_tolerance);
    CHECK(each.value == Approx(5).margin(1e-6));
    CHECK(each.at[0] == Approx(1).margin(1e-3));
    CHECK(each.at[1] == Approx(-2).margin(1e-3));
    CHECK(each.at[2] == Approx(3).margin(1e-3));
    longest = std::max(longest, each.evaluations);
    all += each.evaluations;
  }
  CHECK(points == std::size_t(all));
  CHECK(calls == std::size_t(longest));  // one call holds a point of every search that goes on
}

TEST_CASE("a local search keeps to its bounds and says when its evaluations were not enough") {
  const EvaluateAll evaluate = [&](std::span<const Parameters> all) {
    std::vector<double> values;
    for (const Parameters& x : all) {
      for (const double each : x) CHECK(std::abs(each) <= 2);
      values.push_back(hill(x));
    }
    return values;
  };
  for (const double start : {0.0, 3.0})  // the second of them outside
    CHECK(maximise_from({{0, 0, start}}, evaluate, within(2)).front().at[2] == Approx(2).margin(1e-3));
  LocalSearch few = within(2);
  few.most_evaluations = 8;
  const Optimum cut = maximise_from({{0, 0, 0}}, evaluate, few).front();
  CHECK_FALSE(cut.within_tolerance);
  CHECK(cut.evaluations == 8);
}

TEST_CASE("an error of the evaluation ends all searches and reaches the caller") {
  int calls = 0;
  const EvaluateAll evaluate = [&](std::span<const Parameters> all) {
    if (++calls == 5) throw std::runtime_error("the device is gone");
    std::vector<double> values;
    for (const Parameters& x : all) values.push_back(hill(x));
    return values;
  };
  CHECK_THROWS_WITH(maximise_from({{0, 0, 0}, {1, 1, 1}}, evaluate, within(10)), "the device is gone");
}

TEST_CASE("a place leads up to a higher one unless a valley lies between them or both are as high") {
  // A slope from 0.8 at x = 0 to 1 at x = 10, with a valley of some depth at x = 2.5.
  double depth = 0;
  const EvaluateAll evaluate = [&](std::span<const Parameters> all) {
    std::vector<double> values;
    for (const Parameters& x : all) values.push_back((0.8 + 0.02 * x[0]) - depth * std::exp(-std::pow(x[0] - 2.5, 2)));
    return values;
  };
  const auto leads = [&](double from, double to) {
    const std::vector<double> values = evaluate(std::vector<Parameters>{{from, 3}, {to, -2}});
    return leads_up({{from, 3}, values[0], 1, true}, {{to, -2}, values[1], 1, true}, evaluate);
  };
  CHECK(leads(0, 10));
  CHECK_FALSE(leads(10, 0));
  CHECK_FALSE(leads(9.5, 10));  // 0.99 of the height
  depth = 0.06;                 // 0.79 at the bottom, 0.987 of 0.8
  CHECK(leads(0, 10));
  depth = 0.08;  // 0.77
  CHECK_FALSE(leads(0, 10));
}

TEST_CASE("scattered motions fill two balls, denser at the middle, and never repeat") {
  const std::vector<Parameters> points = scattered_motions(0, 2000, 30, 20);
  REQUIRE(points.size() == 2000);
  int inner = 0;
  for (const Parameters& p : points) {
    REQUIRE(p.size() == 6);
    const double shift = std::hypot(p[0], p[1], p[2]);
    CHECK(shift <= 30 + 1e-9);
    CHECK(std::hypot(p[3], p[4], p[5]) <= 20 + 1e-9);
    inner += shift < 15;
  }
  // Half of the radius, after squaring, is 0.71 of it before: 0.71^3 = 0.35 of the points, against 0.125 of even ones.
  CHECK(inner / 2000.0 == Approx(0.354).margin(0.03));
  const std::vector<Parameters> more = scattered_motions(2000, 500, 30, 20);
  std::set<Parameters> all(points.begin(), points.end());
  all.insert(more.begin(), more.end());
  CHECK(all.size() == 2500);
  CHECK(scattered_motions(100, 1, 30, 20).front() == points[100]);
}
