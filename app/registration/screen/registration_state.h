#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "app/panels/widgets/widgets.h"
#include "app/registration/live_session.h"

namespace insonate {

/// What a window shows of a live registration.
struct RegistrationScreen {
  long drawn = 0;                          ///< pictures so far
  double pictures_per_second = 0;          ///< in the last second
  std::map<std::string, ui::Rect> places;  ///< of buttons and pictures
};

/// So often a state file is written again.
inline constexpr double kStateEvery_s = 0.1;

/// Writes what a live registration is doing as JSON, for programs that drive it. Throws InputError if it cannot.
void write_registration_state(const std::filesystem::path& file, const LiveSession& session,
                              const RegistrationScreen& screen = RegistrationScreen());

}  // namespace insonate
