#pragma once

#include <filesystem>

#include "app/registration/live_session.h"

namespace insonate {

/// Writes what a live registration is doing as JSON, for programs that drive it. Throws InputError if it cannot.
/// @param pictures_per_second  0 without a window
void write_registration_state(const std::filesystem::path& file, const LiveSession& session,
                              double pictures_per_second);

}  // namespace insonate
