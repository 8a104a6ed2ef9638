// NIfTI volumes, and the extensions and label tables in their headers.
#include "scenarios/cases/nifti_label_table.h"
#include "tests/fuzz/volume_promises.h"

namespace insonate::fuzz {
namespace {

const Target nifti_target("nifti", [](std::string_view bytes) -> std::string {
  const std::filesystem::path file = file_with("volume.nii", bytes);
  if (const std::string broken = broken_by_volume(file); !broken.empty()) return broken;
  for (const auto& [value, name] : read_nifti_label_table(file))
    if (value < 1 || value > 255 || name.empty()) return "a label without a value or name was taken";
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
