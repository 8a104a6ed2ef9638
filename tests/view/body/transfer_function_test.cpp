#include "sim/view/body/transfer_function.h"

#include <catch2/catch.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <filesystem>
#include <random>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/view/body/transfer_function_file.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;
using namespace insonate::view;

namespace {

TransferFunction random_function(std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1), hu(kFirstTransfer_hu, kLastTransfer_hu);
  std::vector<double> places(2 + random() % 6);
  for (double& place : places) place = hu(random);
  std::sort(places.begin(), places.end());
  TransferFunction function;
  for (const double place : places)
    function.points.push_back(
        {place, {share(random), share(random), share(random)}, random() % 2 ? 0.0 : kMaxOpacity * share(random)});
  return function;
}

double extinction_at(const TransferFunction& function, double hu) {
  return -std::log1p(-function.at(hu).opacity);
}

}  // namespace

TEST_CASE("a transfer function is linear between its points and constant beyond them") {
  const TransferFunction function{"", {{0, {1, 0, 0}, 0.2}, {100, {0, 1, 0}, 0.6}}};
  CHECK(function.at(-500).opacity == 0.2);
  CHECK(function.at(25).opacity == Approx(0.3));
  CHECK(function.at(25).colour.g == Approx(0.25));
  CHECK(function.at(100).opacity == 0.6);
  CHECK(function.at(2000).colour == glm::dvec3(0, 1, 0));
  CHECK(TransferFunction().at(40).opacity == 0);
}

TEST_CASE("between equal opacities and colours a transfer function has exactly these") {
  const TransferFunction even{"even", {{0, {0.3, 0.7, 1}, kMaxOpacity}, {3017, {0.3, 0.7, 1}, kMaxOpacity}}};
  for (int hu = 0; hu <= 3017; ++hu) {
    const TransferPoint at = even.at(hu);
    if (at.opacity != kMaxOpacity || at.colour != glm::dvec3(0.3, 0.7, 1)) FAIL("at " << hu << " HU");
  }
}

TEST_CASE("moving a transfer function scales it about its middle and keeps it within the range") {
  const TransferFunction moved = TransferFunction{"", {{0, {}, 0}, {50, {}, 0.5}, {200, {}, 0.1}}}.moved(30, 2);
  CHECK(moved.points[0].hu == -70);
  CHECK(moved.points[1].hu == 30);
  CHECK(moved.points[2].hu == 330);
  CHECK(TransferFunction{"", {{0, {}, 0}, {3000, {}, 0.5}}}.moved(500, 1).points[1].hu == kLastTransfer_hu);
}

// Extinction of up to 5.3 per mm changes by at most 0.2 within one HU, between which the table is linear.
TEST_CASE("the mean between two values is the integral of the function") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> hu(kFirstTransfer_hu, kLastTransfer_hu);
  for (int round = 0; round < 20; ++round) {
    const TransferFunction function = random_function(random);
    const TransferTable table(function);
    for (int pair = 0; pair < 10; ++pair) {
      const double front = hu(random), back = hu(random);
      if (std::abs(front - back) < 10) continue;
      constexpr int kParts = 20000;
      double sum = 0, red = 0;
      for (int part = 0; part < kParts; ++part) {
        const double at = front + (back - front) * (part + 0.5) / kParts;
        sum += extinction_at(function, at) / kParts;
        red += extinction_at(function, at) * function.at(at).colour.r / kParts;
      }
      const glm::dvec4 mean = table.mean(front, back);
      INFO("from " << front << " to " << back);
      CHECK(mean.a == Approx(sum).margin(2e-3));
      CHECK(mean.r == Approx(red).margin(2e-3));
      CHECK(table.mean(back, front).a == Approx(mean.a).margin(1e-9));
    }
  }
}

TEST_CASE("a range shows something exactly if a value in it, or beside it, is visible") {
  std::mt19937 random(6);
  std::uniform_int_distribution<int> hu(kFirstTransfer_hu - 50, kLastTransfer_hu + 50);
  int shown = 0, hidden = 0;
  for (int round = 0; round < 50; ++round) {
    const TransferTable table(random_function(random));
    const VisibleRanges visible(table);
    for (int pair = 0; pair < 40; ++pair) {
      const int a = hu(random), b = std::min(a + int(random() % 200), kLastTransfer_hu);
      const int low = std::min(a, b), high = std::max(a, b);
      bool expected = false;
      for (int at = low - 1; at <= high + 1; ++at) expected = expected || table.value(at).a > 0;
      CHECK(visible.shows(low, high) == expected);
      ++(expected ? shown : hidden);
    }
  }
  CHECK(shown > 100);
  CHECK(hidden > 100);
}

TEST_CASE("a transfer function that was written is read again as it was") {
  std::mt19937 random(7);
  TransferFunction function = random_function(random);
  function.name = "Ducts, \"thin\"";
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "function.toml";
  write_transfer_function(file, function);
  CHECK(read_transfer_function(file) == function);
}

TEST_CASE("the bundled transfer functions can be read and each shows something") {
  const std::vector<TransferFunction> functions = bundled_transfer_functions();
  REQUIRE(functions.size() >= 6);
  CHECK(functions.front().name == "Skin");
  for (const TransferFunction& function : functions) {
    INFO(function.name);
    CHECK(VisibleRanges(TransferTable(function)).shows(kFirstTransfer_hu, kLastTransfer_hu));
  }
}

TEST_CASE("a transfer function that cannot be used is refused with line and reason") {
  const std::string head = "name = \"A\"\n[[point]]\nhu = 0\ncolour = [0, 0, 0]\nopacity = 0\n[[point]]\n";
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      read_transfer_function(folder.put("function.toml", text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  using Catch::Contains;
  CHECK(refusal(head + "hu = 10\ncolour = [1, 1, 1]\nopacity = 0.5\n").empty());
  CHECK_THAT(refusal(head + "hu = 0\ncolour = [1, 1, 1]\nopacity = 0.5\n"),
             Contains("line 7") && Contains("rising hu"));
  CHECK_THAT(refusal(head + "hu = 5000\ncolour = [1, 1, 1]\nopacity = 0.5\n"), Contains("hu"));
  CHECK_THAT(refusal(head + "hu = 10\ncolour = [1, 2, 1]\nopacity = 0.5\n"), Contains("colour"));
  CHECK_THAT(refusal(head + "hu = 10\ncolour = [1, 1, 1]\nopacity = 1\n"), Contains("opacity"));
  CHECK_THAT(refusal(head + "hu = 10\ncolour = [1, 1, 1]\nopacity = 0.5\nopaque = 1\n"), Contains("opaque"));
  CHECK_THAT(refusal("name = \"A\"\n"), Contains("2 points"));
  CHECK_THAT(refusal(head.substr(11) + "hu = 10\ncolour = [1, 1, 1]\nopacity = 0.5\n"), Contains("name"));
}
