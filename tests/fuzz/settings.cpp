// Settings of model S.
#include "sim/model/settings_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target settings_target("settings", [](std::string_view bytes) -> std::string {
  return why_not_valid(read_settings(file_with("settings.toml", bytes), 3.5, 160)).value_or("");
});

}  // namespace
}  // namespace insonate::fuzz
