// A stream of OpenIGTLink messages; the first byte is the size of the portions that it comes in.
#include "tests/devices/igtl/igtl_promises.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target igtl_target("igtl", [](std::string_view bytes) -> std::string {
  if (bytes.empty()) return "";
  const igtl::ByteView stream(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  return igtl::broken_promise(stream.subspan(1), 1 + std::size_t(stream[0]));
});

}  // namespace
}  // namespace insonate::fuzz
