#include "sim/tissue/tissue.h"

#include <algorithm>

#include "sim/files/files.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestFile = 1u << 20;
constexpr int kMaxKnots = 256;

// Beyond every tissue and metal in the sources, so that a refused value is a typing error.
constexpr double kMinImpedance = 1e-4, kMaxImpedance = 100;
constexpr double kMaxAbsorption = 1000;
constexpr double kMinEchogenicity = -60, kMaxEchogenicity = 30;

// In the order of Structure.
const std::vector<std::string> kStructureNames = {"none", "even",  "organ",  "glandular", "muscle",
                                                  "fat",  "mixed", "kidney", "medulla",   "sinus"};

TissueKnot read_knot(const TomlTable& entry) {
  return {int(entry.whole_number("hu", kMinKnot_hu, kMaxKnot_hu)),
          entry.number("impedance", {kMinImpedance, kMaxImpedance}), entry.number("absorption", {0, kMaxAbsorption}),
          entry.number("echogenicity", {kMinEchogenicity, kMaxEchogenicity})};
}

}  // namespace

TissueKnot TissueTable::at(double hu) const {
  const auto above =
      std::upper_bound(knots.begin(), knots.end(), hu, [](double value, const TissueKnot& k) { return value < k.hu; });
  if (above == knots.begin()) return knots.front();
  if (above == knots.end()) return knots.back();
  const TissueKnot &a = above[-1], &b = *above;
  const double t = (hu - a.hu) / (b.hu - a.hu);
  return {int(hu), a.impedance_mrayl + t * (b.impedance_mrayl - a.impedance_mrayl),
          a.absorption_db_cm_mhz + t * (b.absorption_db_cm_mhz - a.absorption_db_cm_mhz),
          a.echogenicity_db + t * (b.echogenicity_db - a.echogenicity_db)};
}

int TissueTable::densest_air_hu() const {
  const auto denser = std::find_if(knots.begin(), knots.end(), [&](const TissueKnot& knot) {
    return knot.impedance_mrayl != knots.front().impedance_mrayl ||
           knot.absorption_db_cm_mhz != knots.front().absorption_db_cm_mhz;
  });
  return denser == knots.end() ? kMaxAir_hu : std::min(denser[-1].hu, kMaxAir_hu);
}

TissueTable read_tissue_table(const std::filesystem::path& toml_file) {
  const TomlDocument document(toml_file.string(), read_file(toml_file, kLargestFile));
  const TomlTable root = document.root();
  TissueTable table;
  for (const TomlTable& entry : root.tables("knot")) {
    const TissueKnot knot = read_knot(entry);
    if (!table.knots.empty() && knot.hu <= table.knots.back().hu)
      entry.fail("hu",
                 "'hu' is " + std::to_string(knot.hu) + " after a knot at " + std::to_string(table.knots.back().hu),
                 "order the knots by rising hu");
    table.knots.push_back(knot);
  }
  if (root.has("tissue")) {
    const TomlTable tissues = root.table("tissue");
    for (const std::string& name : tissues.keys()) {
      const TomlTable entry = tissues.table(name);
      table.labelled[name] = {entry.number("echogenicity_db", {kMinEchogenicity, kMaxEchogenicity}),
                              Structure(entry.choice("structure", kStructureNames, 0))};
    }
  }
  root.refuse_unknown_keys();
  if (table.knots.size() < 2 || table.knots.size() > kMaxKnots)
    root.fail("knot", "there are " + std::to_string(table.knots.size()) + " knots",
              "give 2 to " + std::to_string(kMaxKnots) + " [[knot]] entries");
  return table;
}

}  // namespace insonate
