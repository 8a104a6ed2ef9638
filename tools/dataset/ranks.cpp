#include "tools/dataset/ranks.h"

#include <array>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <set>
#include <string_view>

#include "sim/core/input_error.h"
#include "sim/core/text.h"

namespace insonate {
namespace {

std::optional<std::uint32_t> whole(std::string_view text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return number;
}

struct Variables {
  const char *rank, *of;
};
/// SLURM_STEP_NUM_TASKS is set in steps of srun alone. In a batch script without srun, one process runs, although
/// SLURM_NTASKS may be larger.
constexpr std::array kVariables{Variables{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
                                Variables{"PMI_RANK", "PMI_SIZE"}, Variables{"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"}};

}  // namespace

Rank rank_of_environment() {
  for (const Variables& names : kVariables) {
    const char *rank = std::getenv(names.rank), *of = std::getenv(names.of);
    if (!rank || !of) continue;
    const auto number = whole(rank), count = whole(of);
    if (!number || !count || *number >= *count)
      throw InputError(names.rank, "",
                       "the rank " + in_quotes(rank) + " of " + in_quotes(of) + " processes does not exist",
                       "start the program by mpirun or srun, or unset " + std::string(names.of));
    return {*number, *count};
  }
  return {};
}

std::vector<std::uint32_t> read_shard_list(const std::string& option, const std::string& text, std::uint32_t shards) {
  const auto refuse = [&](std::string_view part) {
    throw InputError(option, "", in_quotes(part) + " is not a shard, a range or a range with a step",
                     "write numbers as in 3, 0-15, 0-30:10 or 1,4-6");
  };
  std::set<std::uint32_t> listed;
  std::string_view left = text;
  for (;;) {
    const std::string_view part = left.substr(0, left.find(','));
    const std::string_view range = part.substr(0, part.find(':'));
    const auto first = whole(range.substr(0, range.find('-')));
    const auto last = range.find('-') == std::string_view::npos ? first : whole(range.substr(range.find('-') + 1));
    const auto step = range.size() == part.size() ? std::optional(1u) : whole(part.substr(range.size() + 1));
    if (!first || !last || !step || *step == 0 || *last < *first) refuse(part);
    if (*last >= shards)
      throw InputError(option, "", "there is no shard " + std::to_string(*last) + " of " + std::to_string(shards),
                       "count them from 0");
    for (std::uint64_t shard = *first; shard <= *last; shard += *step) listed.insert(std::uint32_t(shard));
    if (part.size() == left.size()) break;
    left = left.substr(part.size() + 1);
  }
  return {listed.begin(), listed.end()};
}

std::string shard_list(const std::vector<std::uint32_t>& shards) {
  std::string text;
  for (std::size_t i = 0; i < shards.size();) {
    std::size_t last = i;
    while (last + 1 < shards.size() && shards[last + 1] == shards[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(shards[i]);
    if (last > i) text += "-" + std::to_string(shards[last]);
    i = last + 1;
  }
  return text;
}

std::vector<std::uint32_t> part_of(const std::vector<std::uint32_t>& shards, const Rank& rank) {
  const std::uint64_t count = shards.size();
  const auto begin = shards.begin() + std::ptrdiff_t(count * rank.rank / rank.of);
  const auto end = shards.begin() + std::ptrdiff_t(count * (rank.rank + 1) / rank.of);
  return {begin, end};
}

}  // namespace insonate
