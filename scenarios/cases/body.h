#pragma once

#include "sim/core/grid.h"

namespace insonate {

/// 1 for the patient, including lungs and gas, 0 for the surroundings. The patient is the largest connected piece of
/// everything denser than -500 HU, after everything thinner than about 7 mm (table tops, tubes, clothes) is removed.
/// All voxels that it encloses in an axial slice are inside.
using BodyMask = Volume<std::uint8_t>;

/// Returns the body, or an empty mask if nothing in the CT is as thick as a body.
BodyMask find_body(const Volume<std::int16_t>& ct);

/// Sets to air all voxels outside the body, except those within two voxels of it, where the skin's partial volume lies.
/// Returns the number of removed voxels above -500 HU.
std::size_t clear_around(const BodyMask& body, Volume<std::int16_t>& ct);

}  // namespace insonate
