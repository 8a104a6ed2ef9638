// Segmentations of many labels in one NIfTI file, brought onto a CT's grid, by the names in its header and by a
// standard table.
#include "scenarios/cases/segmentation.h"

#include "tests/fuzz/volume_promises.h"

namespace insonate::fuzz {
namespace {

std::string broken_in(const Segmentation& found, const Grid& ct) {
  if (found.labels.grid != ct) return "the labels are not on the CT's grid";
  if (const std::string broken = broken_in_grid(found.labels.grid, found.labels.voxels.size()); !broken.empty())
    return broken;
  if (found.table.empty()) return "a segmentation without structures was taken";
  std::array<bool, 256> present{}, listed{};
  for (const std::uint8_t value : found.labels.voxels) present[value] = true;
  for (const Label& label : found.table) {
    if (label.name.empty() || label.tissue.empty() || listed[label.value]) return "a label's name or value is bad";
    listed[label.value] = true;
  }
  present[0] = listed[0] = false;
  return present == listed ? "" : "the table does not list what has voxels";
}

const Target segmentation_target("segmentation", [](std::string_view bytes) -> std::string {
  const std::filesystem::path file = file_with("labels.nii", bytes);
  Grid ct;
  ct.size = {4, 4, 4};
  const std::string broken = broken_by([&] { return broken_in(read_segmentation(file, ct), ct); });
  return broken.empty() ? broken_in(read_segmentation(file, ct, "total"), ct) : broken;
});

}  // namespace
}  // namespace insonate::fuzz
