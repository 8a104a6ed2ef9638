#include "scenarios/results/pass_mark.h"

#include <catch2/catch.hpp>

#include <array>
#include <stdexcept>
#include <string>

using namespace insonate;

namespace {

std::string refusal(std::initializer_list<double> novices, std::initializer_list<double> experts) {
  try {
    contrasting_groups(std::span(novices.begin(), novices.size()), std::span(experts.begin(), experts.size()));
    return "";
  } catch (const std::domain_error& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("the pass mark by contrasting groups is where the normals cross, as computed by hand") {
  // Novices 30, 50: mean 40, variance 200. Experts 80, 90: mean 85, variance 50. The equation, over -150:
  //   x^2 - 200 x + (80000 - 1445000 + 20000 ln 2) / -150 = 0,  x = 100 - sqrt(10000 - 9007.580370) = 68.497308.
  // Distances to the means in deviations: 28.497308 / 14.142136 = 2.015064, 16.502692 / 7.071068 = 2.333833; the
  // normal's tails there are 2.1949 % and 0.9802 % (tables).
  const std::array novices{30.0, 50.0}, experts{80.0, 90.0};
  const PassMark mark = contrasting_groups(novices, experts);
  CHECK(mark.novices.mean == Approx(40));
  CHECK(mark.experts.deviation == Approx(7.0710678));
  CHECK(mark.percent == Approx(68.497308).margin(1e-5));
  CHECK(mark.false_passes.theoretical_percent == Approx(2.1949).margin(1e-3));
  CHECK(mark.false_fails.theoretical_percent == Approx(0.9802).margin(1e-3));
  CHECK(mark.false_passes.observed_percent == 0);
  CHECK(mark.false_fails.observed_percent == 0);
}

TEST_CASE("with equal deviations the pass mark is the middle, and tends to it as they become equal") {
  const std::array novices{20.0, 30.0, 40.0}, experts{70.0, 80.0, 90.0};
  CHECK(contrasting_groups(novices, experts).percent == Approx(55));
  const std::array nearly{70.0, 80.0, 90.0 + 1e-9};
  CHECK(contrasting_groups(novices, nearly).percent == Approx(55).margin(1e-6));
}

TEST_CASE("observed errors are counted: novices at the mark or above, experts below it") {
  // Means 40 and 80, equal deviations: the mark is 60.
  const std::array novices{10.0, 40.0, 70.0}, experts{50.0, 80.0, 110.0};
  const PassMark mark = contrasting_groups(novices, experts);
  REQUIRE(mark.percent == Approx(60));
  CHECK(mark.false_passes.observed_percent == Approx(100.0 / 3));
  CHECK(mark.false_fails.observed_percent == Approx(100.0 / 3));
}

TEST_CASE("groups that make no pass mark are refused in words") {
  CHECK(refusal({30}, {80, 90}).find("fewer than two scores of novices") != std::string::npos);
  CHECK(refusal({30, 40}, {}).find("fewer than two scores of experts") != std::string::npos);
  CHECK(refusal({30, 30}, {80, 90}).find("the same") != std::string::npos);
  CHECK(refusal({80, 90}, {30, 50}).find("no better") != std::string::npos);
  // Experts so much wider than novices that at every score between the means theirs is the rarer: no crossing there.
  CHECK(refusal({49.9, 50.1}, {-100, 200.4}).find("do not cross") != std::string::npos);
}
