#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace insonate {

/// Reads a list of learners' ids (learner_id.h) in the file's order. The file is CSV: a header line `learner`, then one
/// id per line; blank lines are ignored. A file whose name ends in .toml is TOML:
///
///     format = 1
///     learners = ["L-01", "L-02"]
///
/// The file holds only ids; names and groups stay with the lab. Throws InputError with the line for an invalid id, a
/// duplicate id, another column, an empty list, or more than kMaxLearners ids.
std::vector<std::string> read_roster(const std::filesystem::path& file);

inline constexpr std::size_t kMaxLearners = 100'000;

}  // namespace insonate
