// A shard of a dataset, whose structure HDF5 reads.
#include "tests/fuzz/fuzz_target.h"
#include "tools/dataset/shard_file.h"

namespace insonate::fuzz {
namespace {

const Target shard_target("shard", [](std::string_view bytes) -> std::string {
  const std::filesystem::path file = file_with("00000.h5", bytes);
  const std::string damage = damage_of_shard(file);
  if (damage.find('\n') != std::string::npos) return "the damage is not a sentence";
  const ShardSummary summary = read_shard_summary(file);
  return summary.digest.empty() || summary.study_digest.empty() ? "a shard without digests was taken" : "";
});

}  // namespace
}  // namespace insonate::fuzz
