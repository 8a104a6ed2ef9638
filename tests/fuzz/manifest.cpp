// The manifest of a dataset, in a folder with one shard.
#include "tests/fuzz/fuzz_target.h"
#include "tools/dataset/dataset_folder.h"

namespace insonate::fuzz {
namespace {

const Target manifest_target("manifest", [](std::string_view bytes) -> std::string {
  const std::filesystem::path path = file_with("set/manifest.json", bytes).parent_path();
  file_with("set/shards/00000.h5", "not HDF5");
  const DatasetFolder folder(path);
  const std::uint32_t shards = folder.shards();
  if (shards > kMaxShards || folder.missing().size() != shards - (shards > 0 ? 1 : 0)) return "it lists other shards";
  folder.is_complete();
  for (const std::string& sentence : folder.damage())
    if (sentence.find("00000.h5") == std::string::npos) return "a shard is damaged that is not there";
  const std::string broken = broken_by([&]() -> std::string {
    folder.check_is_of(Study());
    return "it was taken for the manifest of this study";
  });
  if (!broken.empty()) return broken;
  const std::string torn = broken_by([&]() -> std::string {
    folder.take_shards_of(DatasetFolder(path));
    folder.complete();
    return "";
  });
  return torn.empty() && folder.shards() != shards ? "completed it lists other shards" : torn;
});

}  // namespace
}  // namespace insonate::fuzz
