// libFuzzer over the reader of sequence files, MetaImage and NRRD:
//   build/dev/tests/fuzz_sequence -max_len=16384 -max_total_time=600 FOLDER tests/devices/data
// puts what it finds into FOLDER.
#include "sequence_promises.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string broken = insonate::broken_sequence_promise({reinterpret_cast<const char*>(data), size});
  if (broken.empty()) return 0;
  std::fprintf(stderr, "%s\n", broken.c_str());
  std::abort();
}
