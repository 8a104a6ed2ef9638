// What HID and USB devices send: every parser of reports.
#include "tests/devices/report_promises.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target reports_target("reports", [](std::string_view bytes) {
  return broken_promise({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
});

}  // namespace
}  // namespace insonate::fuzz
