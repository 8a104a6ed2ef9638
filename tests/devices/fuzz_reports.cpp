// libFuzzer over every parser of reports:
//   build/dev/tests/fuzz_reports -max_len=2048 -max_total_time=600 tests/devices/corpus
#include "report_promises.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string broken = insonate::broken_promise({data, size});
  if (broken.empty()) return 0;
  std::fprintf(stderr, "%s\n", broken.c_str());
  std::abort();
}
