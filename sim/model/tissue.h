#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace insonate {

/// The Hounsfield units that knots may lie at: what a CT scanner's 12 bits hold. Denser metal is as good as the last
/// knot, so a table of one entry a unit over this range holds all that a tissue table says.
inline constexpr int kLeastKnotHu = -1024, kMostKnotHu = 3071;

/// What is no denser is air: coupling gel takes its place whole (kCouplingAirHu, sim/reference/reference.h).
inline constexpr int kMostAirHu = -301;

/// What a Hounsfield unit means acoustically; between knots linear, beyond the ends constant.
struct TissueKnot {
  int hu = 0;                       ///< rising from knot to knot, kLeastKnotHu to kMostKnotHu
  double impedance_mrayl = 0;       ///< characteristic acoustic impedance, > 0
  double absorption_db_cm_mhz = 0;  ///< one way, >= 0
  double echogenicity_db = 0;       ///< backscatter relative to liver, used where no label says better; -60 to 30
};

/// What a labelled tissue adds: its backscatter is known from its name rather than guessed from its density.
struct LabelledTissue {
  double echogenicity_db = 0;  ///< relative to liver, -60 (echo-free) to 30
};

/// Air and bone are knots too: two steep ramps that take the place of the paper's two thresholds, because a CT's
/// partial-volume voxels would otherwise punch holes into thin ribs.
struct TissueTable {
  std::vector<TissueKnot> knots;  ///< 2 or more
  std::map<std::string, LabelledTissue> labelled;

  /// The knots at one Hounsfield unit; this is the definition that shaders tabulate.
  TissueKnot at(double hu) const;

  /// The densest air, kMostAirHu or less, that has the impedance and absorption of the first knot: sound tells it from
  /// no other air.
  int densest_air_hu() const;
};

/// Reads a table such as `assets/tissues.toml`, which gives the source of each number. Throws InputError.
TissueTable read_tissue_table(const std::filesystem::path& toml_file);

}  // namespace insonate
