// NRRD volumes; a detached header may name voxels.raw, which lies beside it.
#include "tests/fuzz/volume_promises.h"

namespace insonate::fuzz {
namespace {

const Target nrrd_target("nrrd", [](std::string_view bytes) {
  static const std::filesystem::path beside = file_with("voxels.raw", std::string(128, '\1'));
  return broken_by_volume(file_with("volume.nrrd", bytes));
});

}  // namespace
}  // namespace insonate::fuzz
