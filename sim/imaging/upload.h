#pragma once

#include <functional>
#include <string>

#include "sim/core/grid.h"
#include "sim/core/input_error.h"

namespace insonate::gl {

/// Runs `upload`, which takes a CT to the device, and refuses the CT if the device refuses a texture of it. Throws
/// InputError.
/// @param file  what the person who gave the CT calls it
/// @param grid  of the CT as uploaded: voxels may have been made smaller since it was read
void upload_ct(const std::string& file, const Grid& grid, const std::function<void()>& upload);

/// Runs `work`, and refuses what a person asked for if the device does not hold it. Throws InputError.
/// @param asked   where that is: a settings file, an option
/// @param remedy  what to ask for instead
void within_device(const std::string& asked, const std::string& remedy, const std::function<void()>& work);

/// What a person is told of a CT.
/// @param limit  of the device, voxels along an axis; 0 when it is the memory that does not suffice
InputError too_large_for_device(const std::string& file, const Grid& grid, int limit);

}  // namespace insonate::gl
