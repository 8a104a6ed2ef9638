// What a person hands to insonate-register besides recordings: a probe, and pairs of landmarks for the start.
#include <cmath>

#include "tests/fuzz/fuzz_target.h"
#include "tools/register/read_sweep.h"
#include "tools/register/start_transform.h"

namespace insonate::fuzz {
namespace {

std::string broken_by_probe(const std::string& file) {
  const Probe probe = read_probe(file);
  const ScanLines scan = scan_lines(probe, probe.depth_mm, 64);
  if (scan.lines.size() != std::size_t(probe.lines)) return "the probe has not as many lines as it says";
  return probe.depth_mm >= 10 && probe.depth_mm <= 400 ? "" : "a depth is out of range";
}

std::string broken_by_landmarks(const std::string& file) {
  return why_not_rigid(start_from_landmarks(file).ct_from_sweep, 1e6) ? "the start is not rigid" : "";
}

const Target registration_input_target("registration_input", [](std::string_view bytes) -> std::string {
  const std::string file = file_with("given.toml", bytes).string();
  const std::string broken = broken_by([&] { return broken_by_probe(file); });
  return broken.empty() ? broken_by_landmarks(file) : broken;
});

}  // namespace
}  // namespace insonate::fuzz
