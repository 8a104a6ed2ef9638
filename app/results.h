#pragma once

#include <filesystem>
#include <optional>

#include "app/session.h"
#include "sim/core/image.h"

namespace insonate {

/// Where the results of an attempt lie.
struct ResultFiles {
  std::filesystem::path report;  ///< HTML
  std::filesystem::path score;   ///< JSON
};

/// Writes the report and the score of a finished exam to a folder. Throws InputError when it cannot be written to, and
/// std::logic_error when the exam is not finished.
/// @param best_frame  the picture while the view was held best, if there was one; marker on the left
ResultFiles write_results(const std::filesystem::path& folder, const Session& session,
                          const std::optional<Image<Rgba8>>& best_frame);

}  // namespace insonate
