#pragma once

#include "sim/core/grid.h"

namespace insonate {

/// 1 for the patient, lungs and gas within included, 0 for what is around. The patient is the largest connected piece
/// of what is denser than -500 HU once all that is thinner than about 7 mm (table tops, tubes, clothes) is off; what
/// an axial slice of it encloses is inside.
using BodyMask = Volume<std::uint8_t>;

/// Empty when nothing in the CT is as thick as a body.
BodyMask find_body(const Volume<std::int16_t>& ct);

/// Turns into air what is neither the body nor within two voxels of it, where the skin's partial volume lies. Returns
/// how many voxels above -500 HU went.
std::size_t clear_around(const BodyMask& body, Volume<std::int16_t>& ct);

}  // namespace insonate
