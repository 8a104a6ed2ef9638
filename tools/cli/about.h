#pragma once

#include <string>
#include <vector>

namespace insonate {

/// One line of a program's version information.
struct AboutLine {
  std::string name, text;
};

/// Returns the version, the commit, the build and the licence of this program.
std::vector<AboutLine> about_this_build();

inline constexpr const char* kNoMedicalDevice =
    "Insonate is a trainer. It is not a medical device and must not guide the care of a patient.";

/// Returns the output of `--version`: the lines of about_this_build(), those of `more`, and kNoMedicalDevice.
std::string version_text(const std::string& program, const std::vector<AboutLine>& more);

}  // namespace insonate
