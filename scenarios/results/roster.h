#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace insonate {

/// Reads a list of learners' ids (learner_id.h), in the file's order. Either CSV, a header line `learner` and below it
/// an id a line, where blank lines do not count; or, when the name ends in .toml,
///
///     format = 1
///     learners = ["L-01", "L-02"]
///
/// It holds ids alone: names and groups stay with the lab. Throws InputError with the line for what is no id, for an id
/// that stands there twice, for another column, and for a list of none or of more than kMostLearners.
std::vector<std::string> read_roster(const std::filesystem::path& file);

inline constexpr std::size_t kMostLearners = 100'000;

}  // namespace insonate
