#pragma once

#include <string_view>

namespace insonate {

/// Returns the text of a file of this folder that reports contain (report.css, turn.js), as it was at build time.
/// Returns an empty text for another name. The build generates the definition (insonate_embed).
std::string_view report_file(std::string_view name);

}  // namespace insonate
