#include "sim/volume/volume_header.h"

#include "sim/core/input_error.h"
#include "sim/image_headers/header_text.h"
#include "sim/volume/nifti_volume.h"
#include "sim/volume/text_volumes.h"

namespace insonate {

VolumeHeader read_volume_header(const std::filesystem::path& file) {
  const std::string name = lower_case(file.filename().string());
  const auto ends_with = [&](std::string_view end) { return name.size() > end.size() && name.ends_with(end); };
  if (ends_with(".nii") || ends_with(".nii.gz")) return read_nifti_volume_header(file);
  if (ends_with(".nrrd") || ends_with(".nhdr")) return read_nrrd_volume_header(file);
  if (ends_with(".mha") || ends_with(".mhd")) return read_metaimage_volume_header(file);
  throw InputError(file.string(), "", "the name does not end as a volume's does",
                   "give a .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd file, or a DICOM folder");
}

}  // namespace insonate
