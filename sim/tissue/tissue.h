#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace insonate {

/// The range of Hounsfield units of knots: what a CT scanner's 12 bits hold. Denser metal gets the last knot's values,
/// so a table with one entry per unit over this range holds all information of a tissue table.
inline constexpr int kMinKnot_hu = -1024, kMaxKnot_hu = 3071;

/// The densest air. Coupling gel replaces voxels up to this density completely (kCouplingAir_hu, coupling.h).
inline constexpr int kMaxAir_hu = -301;

/// The acoustic properties of a Hounsfield unit; linear between knots, constant beyond the ends.
struct TissueKnot {
  int hu = 0;                       ///< strictly rising from knot to knot, kMinKnot_hu to kMaxKnot_hu
  double impedance_mrayl = 0;       ///< characteristic acoustic impedance, > 0
  double absorption_db_cm_mhz = 0;  ///< one way, >= 0
  double echogenicity_db = 0;  ///< backscatter relative to liver, used for voxels without a labelled tissue; -60 to 30
};

/// What a tissue is made of on the scale of millimetres, see tissue_structure.h.
enum class Structure { none, even, organ, glandular, muscle, fat, mixed, kidney, medulla, sinus };

/// The properties of a labelled tissue: its backscatter is known from its name, not guessed from its density.
struct LabelledTissue {
  double echogenicity_db = 0;             ///< relative to liver, -60 (echo-free) to 30
  Structure structure = Structure::none;  ///< in pictures with Settings::waves
};

/// Maps Hounsfield units and tissue names to acoustic properties. Air and bone are knots too. Two steep ramps replace
/// the paper's two thresholds, because partial-volume voxels of a CT would otherwise punch holes into thin ribs.
struct TissueTable {
  std::vector<TissueKnot> knots;  ///< 2 or more
  std::map<std::string, LabelledTissue> labelled;

  /// Returns the interpolated properties at a density; shaders tabulate this function.
  TissueKnot at(double hu) const;

  /// Returns the highest density, at most kMaxAir_hu, with the impedance and absorption of the first knot. To the sound
  /// it is the same as any other air.
  int densest_air_hu() const;
};

/// Reads a table such as `assets/tissues.toml`, which gives the source of each number. Throws InputError.
TissueTable read_tissue_table(const std::filesystem::path& toml_file);

}  // namespace insonate
