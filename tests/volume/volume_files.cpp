#include "tests/volume/volume_files.h"

#include <zlib.h>

#include <stdexcept>

namespace insonate {
namespace {

template <typename T>
void put(std::string& bytes, std::size_t offset, const T& value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

std::string deflated(const std::string& bytes, int window_bits) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib");
  std::string packed(deflateBound(&stream, uLong(bytes.size())) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = uInt(packed.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::runtime_error("zlib");
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace

std::string gzip(const std::string& bytes) {
  return deflated(bytes, 15 + 16);  // 16 asks zlib for gzip's header and trailer
}

std::string zlib(const std::string& bytes) {
  return deflated(bytes, 15);
}

std::string nifti(const NiftiSpec& spec, const std::string& voxels) {
  std::string bytes(352, '\0');
  put(bytes, 0, std::int32_t(348));
  put(bytes, 40, spec.dim);
  put(bytes, 70, spec.datatype);
  put(bytes, 72, spec.bits);
  put(bytes, 76, spec.pixdim);
  put(bytes, 108, spec.vox_offset);
  put(bytes, 112, spec.slope);
  put(bytes, 116, spec.inter);
  put(bytes, 68, spec.intent);
  bytes[123] = spec.units;
  put(bytes, 252, spec.qform_code);
  put(bytes, 256, spec.quaternion);
  put(bytes, 268, spec.qoffset);
  put(bytes, 254, spec.sform_code);
  put(bytes, 280, spec.sform);
  bytes.replace(344, 4, spec.magic);
  return bytes + voxels;
}

std::string nrrd(const std::vector<std::string>& lines, const std::string& data) {
  std::string bytes = "NRRD0004\n";
  for (const std::string& line : lines) bytes += line + "\n";
  return bytes + "\n" + data;
}

std::string meta_image(const std::vector<std::string>& lines, const std::string& data, const std::string& data_file) {
  std::string bytes = "ObjectType = Image\n";
  for (const std::string& line : lines) bytes += line + "\n";
  return bytes + "ElementDataFile = " + data_file + "\n" + data;
}

std::vector<std::string> with_line(std::vector<std::string> lines, const std::string& key, const std::string& by) {
  for (std::size_t l = 0; l < lines.size(); ++l)
    if (lines[l].rfind(key, 0) == 0) {
      if (by.empty())
        lines.erase(lines.begin() + std::ptrdiff_t(l));
      else
        lines[l] = by;
      return lines;
    }
  if (!by.empty()) lines.push_back(by);
  return lines;
}

std::vector<std::string> nrrd_lines() {
  return {"type: short",
          "dimension: 3",
          "space: left-posterior-superior",
          "sizes: 4 3 2",
          "space directions: (10,0,0) (0,20,0) (0,0,30)",
          "kinds: domain domain domain",
          "endian: little",
          "encoding: raw",
          "space origin: (10,20,30)"};
}

std::vector<std::string> meta_lines() {
  return {"NDims = 3",
          "BinaryData = True",
          "BinaryDataByteOrderMSB = False",
          "CompressedData = False",
          "TransformMatrix = 1 0 0 0 1 0 0 0 1",
          "Offset = 10 20 30",
          "CenterOfRotation = 0 0 0",
          "ElementSpacing = 10 20 30",
          "DimSize = 4 3 2",
          "ElementType = MET_SHORT"};
}

std::vector<std::string> packed_meta_lines(const std::string& packed) {
  return with_line(meta_lines(), "CompressedData",
                   "CompressedData = True\nCompressedDataSize = " + std::to_string(packed.size()));
}

}  // namespace insonate
