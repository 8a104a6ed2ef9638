// Settings of model W.
#include "sim/wein/wein_settings_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target wein_settings_target("wein_settings", [](std::string_view bytes) -> std::string {
  return why_not_valid(read_wein_settings(file_with("wein.toml", bytes))).value_or("");
});

}  // namespace
}  // namespace insonate::fuzz
