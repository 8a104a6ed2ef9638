#pragma once

#include "app/registration/registration_options.h"

namespace insonate {

/// Registers without a window until the registration has converged or its time is over, and saves what it found.
/// Returns 0 if it converged and 3 if not. Throws InputError for input that cannot be used, and for a stream with which
/// no round could begin.
int run_registration_headless(const RegistrationOptions& options);

}  // namespace insonate
