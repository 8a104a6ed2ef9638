#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace insonate {

/// Volume files made byte by byte from the definitions of their formats, so that the reader is not tested against
/// itself.

template <typename T>
std::string bytes_of_values(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// Returns the same with each number's bytes in the other order, as big-endian files have them.
template <typename T>
std::string swapped_bytes_of_values(const std::vector<T>& values) {
  std::string bytes = bytes_of_values(values);
  for (auto at = bytes.begin(); at != bytes.end(); at += sizeof(T)) std::reverse(at, at + sizeof(T));
  return bytes;
}

std::string gzip(const std::string& bytes);
std::string zlib(const std::string& bytes);

struct NiftiSpec {
  std::array<std::int16_t, 8> dim{3, 4, 3, 2, 1, 1, 1, 1};
  std::int16_t datatype = 4;  ///< int16
  std::int16_t bits = 16;
  std::array<float, 8> pixdim{1, 10, 20, 30, 1, 1, 1, 1};
  float vox_offset = 352;
  float slope = 1, inter = 0;
  char units = 2;           ///< mm
  std::int16_t intent = 0;  ///< none
  std::int16_t qform_code = 0;
  std::array<float, 3> quaternion{};
  std::array<float, 3> qoffset{};
  std::int16_t sform_code = 1;
  std::array<float, 12> sform{10, 0, 0, 10, 0, 20, 0, 20, 0, 0, 30, 30};  ///< RAS, row by row
  std::string magic = std::string("n+1\0", 4);
  bool big_endian = false;  ///< of the header; the voxels are the caller's
};

/// Returns a NIfTI-1 file.
std::string nifti(const NiftiSpec& spec, const std::string& voxels);
/// Returns the same as NIfTI-2, whose header has 540 bytes; the voxels begin at byte 544.
std::string nifti_2(const NiftiSpec& spec, const std::string& voxels);

/// Returns an NRRD file with the given header lines between the magic and the empty line.
std::string nrrd(const std::vector<std::string>& lines, const std::string& data);

/// Returns a MetaImage file with the given lines before ElementDataFile.
std::string meta_image(const std::vector<std::string>& lines, const std::string& data,
                       const std::string& data_file = "LOCAL");

/// Returns `lines` with the line that begins with `key` replaced by `by`, removed if `by` is empty, or added if there
/// is none.
std::vector<std::string> with_line(std::vector<std::string> lines, const std::string& key, const std::string& by);

/// Return the lines for a volume of 4 x 3 x 2 voxels, 10 x 20 x 30 mm, int16, origin (10, 20, 30), axes as LPS.
std::vector<std::string> nrrd_lines();
std::vector<std::string> meta_lines();
/// Returns the same for voxels compressed with zlib.
std::vector<std::string> packed_meta_lines(const std::string& packed);

}  // namespace insonate
