// libFuzzer over the reader of OpenIGTLink; the first byte is the size of the portions. The test igtl_test runs the
// same promises over messages with a few changes each.
//   build/dev/tests/fuzz_igtl -max_len=4096 -max_total_time=600 FOLDER tests/devices/igtl/corpus
// puts what it finds into FOLDER.
#include "igtl_promises.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string broken = insonate::igtl::broken_promise({data + 1, size - 1}, 1 + std::size_t(data[0]));
  if (broken.empty()) return 0;
  std::fprintf(stderr, "%s\n", broken.c_str());
  std::abort();
}
