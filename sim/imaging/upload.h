#pragma once

#include <functional>
#include <string>

#include "sim/core/grid.h"
#include "sim/core/input_error.h"

namespace insonate::gl {

/// Runs `upload`, which uploads a CT to the device. Throws InputError that refuses the CT if the device refuses a
/// texture of it.
/// @param file  the CT's name as the user gave it
/// @param grid  of the CT as uploaded; it may have been resampled since it was read
void upload_ct(const std::string& file, const Grid& grid, const std::function<void()>& upload);

/// Runs `work`. Throws InputError if the device cannot hold what the user asked for.
/// @param asked   where the user asked for it: a settings file, an option
/// @param remedy  what to ask for instead
void within_device(const std::string& asked, const std::string& remedy, const std::function<void()>& work);

/// Returns the error for a CT that the device cannot hold.
/// @param limit  of the device, voxels along an axis; 0 if its memory does not suffice
InputError too_large_for_device(const std::string& file, const Grid& grid, int limit);

}  // namespace insonate::gl
