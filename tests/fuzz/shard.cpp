// A shard of a dataset, whose structure HDF5 reads.
#include <hdf5.h>

#include "tests/fuzz/fuzz_target.h"
#include "tools/dataset/shard_file.h"

namespace insonate::fuzz {
namespace {

const Target shard_target("shard", [](std::string_view bytes) -> std::string {
  // The library allocates half a MiB for every file. It keeps that memory for the next input if its lists are
  // unlimited.
  [[maybe_unused]] static const herr_t kept = H5set_free_list_limits(-1, -1, -1, -1, -1, -1);
  const std::filesystem::path file = file_with("00000.h5", bytes);
  const std::string damage = damage_of_shard(file);
  if (damage.find('\n') != std::string::npos) return "the damage is not a sentence";
  const ShardSummary summary = read_shard_summary(file);
  return summary.digest.empty() || summary.study_digest.empty() ? "a shard without digests was taken" : "";
});

}  // namespace
}  // namespace insonate::fuzz
