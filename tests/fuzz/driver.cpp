// libFuzzer's entry into the one target that is linked.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace insonate::fuzz;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::string broken = broken_by([&] { return targets().front()->promises(bytes); });
  if (broken.empty()) return 0;
  std::fprintf(stderr, "broken promise: %s\n", broken.c_str());
  std::abort();
}
