// The tissue table.
#include <cmath>

#include "sim/tissue/tissue.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

bool is_echogenicity(double db) {
  return db >= -60 && db <= 30;
}

const Target tissues_target("tissues", [](std::string_view bytes) -> std::string {
  const TissueTable table = read_tissue_table(file_with("tissues.toml", bytes));
  if (table.knots.size() < 2) return "fewer than two knots were taken";
  int before = kMinKnot_hu - 1;
  for (const TissueKnot& knot : table.knots) {
    if (knot.hu <= before || knot.hu > kMaxKnot_hu) return "the knots do not rise within their range";
    before = knot.hu;
  }
  for (int hu = kMinKnot_hu - 100; hu <= kMaxKnot_hu + 100; hu += 13) {
    const TissueKnot at = table.at(hu + 0.5);
    if (!(at.impedance_mrayl > 0) || !(at.absorption_db_cm_mhz >= 0) || !is_echogenicity(at.echogenicity_db) ||
        !std::isfinite(at.impedance_mrayl) || !std::isfinite(at.absorption_db_cm_mhz))
      return "between the knots a value is out of range";
  }
  for (const auto& [name, tissue] : table.labelled)
    if (name.empty() || !is_echogenicity(tissue.echogenicity_db)) return "a tissue is out of range";
  if (table.densest_air_hu() > kMaxAir_hu) return "air is denser than air";
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
