// insonate-devices with hidapi, libusb and udev on a kernel of its own, whose USB devices this program makes up. Run by
// tools/test-kernel in a virtual machine; not one of ctest's tests.
#include <catch2/catch.hpp>
#include <sys/stat.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "devices/hydra/hydra_report.h"
#include "devices/polhemus/polhemus_stream.h"
#include "tests/devices/child_process.h"
#include "tests/devices/kernel/gadget.h"
#include "tests/devices/numbered_reports.h"

using namespace insonate;
using kernel::BulkGadget;
using kernel::HidGadget;

namespace {

constexpr const char* kProgram = "/bin/insonate-devices";
const kernel::Identity kHydra{0x1532, 0x0300, "Razer Hydra", "A1"};
const kernel::Identity kViper{0x0f44, 0xbf01, "Polhemus Viper", "V7"};

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

/// An emulated processor is slow; what has not come by then does not come.
bool wait_for(const std::function<bool()>& done) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < limit) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

std::string listed() {
  ChildProcess child({kProgram, "list"});
  CHECK(wait_for([&] {
    child.listen();
    return child.ended();
  }));
  child.listen();
  return child.out;
}

/// `watch` of a tracker.
struct Watch {
  explicit Watch(const std::string& uri) : child({kProgram, "watch", uri}) {}

  void until(const std::function<bool()>& done) {
    const bool came = wait_for([&] {
      child.listen();
      return done();
    });
    CAPTURE(child.out, child.err);
    REQUIRE(came);
  }
  void until_told(const std::string& words) {
    until([&] { return contains(child.err, words); });
  }
  void until_places(std::size_t count) {
    until([&] { return places(child.out).size() >= count; });
  }

  ChildProcess child;
};

/// As the device sees what the program sends: without the number of the report, which is 0 for none.
Report without_number(const auto& feature_report) {
  return Report(feature_report.begin() + 1, feature_report.end());
}

bool started(HidGadget& hydra) {
  const auto& features = hydra.features();
  return !features.empty() && features.back() == without_number(hydra_mode(true));
}

}  // namespace

TEST_CASE("a Hydra is listed, and its node is opened to the user by the project's rule") {
  CHECK(contains(listed(), "no tracker that is known here"));
  HidGadget hydra(kHydra, 0);
  CHECK(wait_for([] { return contains(listed(), "serial A1"); }));
  CHECK(contains(listed(), "1532:0300"));
  CHECK(wait_for([] {
    struct stat node;
    return stat("/dev/hidraw0", &node) == 0 && (node.st_mode & 0777) == 0660;
  }));
}

TEST_CASE("a Hydra that is plugged in late is started, and each of its reports comes once and in order") {
  Watch watch("hydra:?raw=1");
  watch.until_told("The Razer Hydra is not plugged in.");
  HidGadget hydra(kHydra, 0);
  watch.until([&] { return started(hydra); });
  for (int x = 1; x <= 200; ++x) {
    REQUIRE(hydra.send(hydra_report(x)));
    if (x % 20 == 0) watch.until_places(std::size_t(x));  // the kernel keeps 64 reports for who reads late
  }
  CHECK(places(watch.child.out) == counted(1, 200));

  Report corrupt = hydra_report(201);
  corrupt[8] ^= 1;
  for (const Report& report : {corrupt, hydra_report(200), hydra_report(202)}) REQUIRE(hydra.send(report));
  watch.until_places(201);
  CHECK(places(watch.child.out).back() == 202);
  watch.until_told("were damaged or lost");
}

TEST_CASE("a Hydra that is pulled out is missed, and goes on when it is plugged in again") {
  auto hydra = std::make_unique<HidGadget>(kHydra, 0);
  Watch watch("hydra:?raw=1");
  watch.until([&] { return started(*hydra); });
  for (int x : {1, 2}) REQUIRE(hydra->send(hydra_report(x)));
  watch.until_places(2);
  hydra.reset();
  watch.until_told("The Razer Hydra is not plugged in.");
  watch.until([&] { return contains(watch.child.out, "missing"); });

  hydra = std::make_unique<HidGadget>(kHydra, 0);
  watch.until([&] { return started(*hydra); });
  REQUIRE(hydra->send(hydra_report(3)));
  watch.until_places(3);
  CHECK(places(watch.child.out) == counted(1, 3));
}

TEST_CASE("of two Hydras the one with the serial number is used") {
  HidGadget first(kHydra, 0), second({0x1532, 0x0300, "Razer Hydra", "B2"}, 1);
  Watch watch("hydra:B2?raw=1");
  watch.until([&] { return started(second); });
  CHECK(first.features().empty());
}

TEST_CASE("a Hydra that may not be opened is reported with the rule, and used as soon as it may") {
  HidGadget hydra(kHydra, 0);
  REQUIRE(wait_for([] { return contains(listed(), "/dev/hidraw0"); }));
  REQUIRE(wait_for([] { return chmod("/dev/hidraw0", 0) == 0; }));
  Watch watch("hydra:?raw=1");
  watch.until_told(R"(ATTRS{idVendor}=="1532", ATTRS{idProduct}=="0300")");
  REQUIRE(chmod("/dev/hidraw0", 0600) == 0);
  watch.until([&] { return started(hydra); });
}

TEST_CASE("a Viper is listed, set up, and its frames come whole however the transfers cut them") {
  Watch watch("polhemus:?sensor=2&raw=1");
  watch.until_told("The Polhemus tracker is not plugged in.");
  BulkGadget viper(kViper, 0);
  watch.until([&] { return viper.received().size() >= 2; });
  const std::vector<Report> setup = viper.received();
  CHECK(setup[0] == viper::command(viper::kUnits, viper::kSet, {2, 2}));
  CHECK(setup[1] == viper::command(viper::kContinuous, viper::kSet));

  Report stream;
  for (int x = 1; x <= 100; ++x) {
    Report frame = viper_frame(x);
    if (x == 50) frame[30] ^= 1;
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  for (std::size_t begin = 0; begin < stream.size(); begin += 37)
    viper.send(
        {stream.begin() + std::ptrdiff_t(begin), stream.begin() + std::ptrdiff_t(std::min(begin + 37, stream.size()))});
  watch.until_places(99);
  std::vector<int> expected = counted(1, 49);
  for (const int x : counted(51, 100)) expected.push_back(x);
  CHECK(places(watch.child.out) == expected);
  watch.until_told("were damaged or lost");
  const std::string list = listed();
  CHECK(contains(list, "Polhemus Viper"));
  CHECK(contains(list, "serial V7"));
}

TEST_CASE("a Viper that is pulled out in mid-transfer is missed, and goes on when it is plugged in again") {
  auto viper = std::make_unique<BulkGadget>(kViper, 0);
  Watch watch("polhemus:V7?sensor=2&raw=1");
  watch.until([&] { return viper->received().size() >= 2; });
  viper->send(viper_frame(1));
  watch.until_places(1);
  viper.reset();
  watch.until_told("The Polhemus tracker is not plugged in.");
  viper = std::make_unique<BulkGadget>(kViper, 0);
  watch.until([&] { return viper->received().size() >= 2; });
  viper->send(viper_frame(2));
  watch.until_places(2);
  CHECK(places(watch.child.out) == counted(1, 2));
}
