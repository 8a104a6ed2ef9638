#pragma once

#include <glm/vec3.hpp>

#include <functional>
#include <string>

#include "tests/volume/volume_files.h"

namespace insonate {

/// Returns the extension that TotalSegmentator's writer puts into a NIfTI header, around the given <Label> elements.
inline std::string label_extension(const std::string& labels) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?> <CaretExtension>  <Date><![CDATA[2013-07-14T05:45:09]]></Date>   "
      "<VolumeInformation Index=\"0\">   <LabelTable>\n" +
      labels +
      "\n  </LabelTable>  <StudyMetaDataLinkSet>  </StudyMetaDataLinkSet>  <VolumeType><![CDATA[Label]]></VolumeType> "
      "  </VolumeInformation></CaretExtension>\n              ";
  xml.resize((xml.size() + 8 + 15) / 16 * 16 - 8, '\0');
  return bytes_of_values<std::int32_t>({std::int32_t(xml.size() + 8), 0}) + xml;
}

inline std::string label_element(const std::string& key, const std::string& name) {
  return "<Label Key=\"" + key + "\" Red=\"1.0\" Green=\"0.0\" Blue=\"0.0\" Alpha=\"1\"><![CDATA[" + name +
         "]]></Label>\n";
}

/// Returns a NIfTI file of uint8 labels with 1 mm voxels, the first at `first` (RAS, mm), with the extension if given.
inline std::string label_file(const glm::ivec3& size, const glm::dvec3& first,
                              const std::function<int(int, int, int)>& label_at, const std::string& extension = "",
                              float voxel_mm = 1) {
  NiftiSpec spec;
  spec.datatype = 2;
  spec.bits = 8;
  spec.dim = {3, std::int16_t(size.x), std::int16_t(size.y), std::int16_t(size.z), 1, 1, 1, 1};
  spec.pixdim = {1, voxel_mm, voxel_mm, voxel_mm, 1, 1, 1, 1};
  spec.sform = {voxel_mm, 0, 0, float(first.x), 0, voxel_mm, 0, float(first.y), 0, 0, voxel_mm, float(first.z)};
  spec.vox_offset = float(352 + extension.size());
  std::string voxels;
  for (int k = 0; k < size.z; ++k)
    for (int j = 0; j < size.y; ++j)
      for (int i = 0; i < size.x; ++i) voxels += char(label_at(i, j, k));
  std::string bytes = nifti(spec, extension + voxels);
  bytes[348] = extension.empty() ? 0 : 1;
  return bytes;
}

}  // namespace insonate
