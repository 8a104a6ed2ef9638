#pragma once

#include "app/registration/registration_options.h"

namespace insonate {

/// Registers in a window until it is closed or options.seconds have passed. Returns the exit code. Throws InputError
/// for input that cannot be used, and std::runtime_error if no window with OpenGL 4.5 can be created.
int run_registration_window(const RegistrationOptions& options);

}  // namespace insonate
