// Lists of shards, as a person and Slurm's arrays write them.
#include <algorithm>

#include "tests/fuzz/fuzz_target.h"
#include "tools/dataset/ranks.h"

namespace insonate::fuzz {
namespace {

constexpr std::uint32_t kShards = 1000;

const Target shard_list_target("shard_list", [](std::string_view bytes) -> std::string {
  const std::vector<std::uint32_t> shards = read_shard_list("--shards", std::string(bytes), kShards);
  if (shards.empty() || shards.back() >= kShards || !std::ranges::is_sorted(shards)) return "a shard is out of range";
  if (read_shard_list("--shards", shard_list(shards), kShards) != shards)
    return "written and read again the list is another";
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
