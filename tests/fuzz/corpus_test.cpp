#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>

#include "sim/files/files.h"
#include "tests/fuzz/fuzz_target.h"

using namespace insonate;
namespace fs = std::filesystem;

TEST_CASE("every reader keeps its promises of all seeds, and of each seed cut short") {
  for (const fuzz::Target* target : fuzz::targets()) {
    std::size_t seeds = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(fs::path(INSONATE_FUZZ_CORPORA) / target->name)) {
      ++seeds;
      const std::string bytes = read_file(entry.path());
      CAPTURE(entry.path());
      for (const std::size_t size : {bytes.size(), bytes.size() / 2, bytes.size() - 1})
        CHECK(fuzz::broken_by([&] { return target->promises(std::string_view(bytes).substr(0, size)); }) == "");
    }
    CAPTURE(target->name);
    CHECK(seeds > 0);
  }
  CHECK(fuzz::targets().size() > 20);
}
