#include "tests/volume/volume_files.h"

#include <zlib.h>

#include <stdexcept>

namespace insonate {
namespace {

/// A binary header that is filled field by field.
class Header {
public:
  Header(std::size_t size, bool big_endian) : bytes_(size, '\0'), big_endian_(big_endian) {}

  template <typename T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof value);
    const auto first = bytes_.begin() + std::ptrdiff_t(offset);
    if (big_endian_) std::reverse(first, first + sizeof value);
  }
  /// Puts the numbers one behind the other, each as a T.
  template <typename T, typename Number, std::size_t count>
  void put_all(std::size_t offset, const std::array<Number, count>& values) {
    for (std::size_t i = 0; i < count; ++i) put(offset + i * sizeof(T), T(values[i]));
  }
  void put_text(std::size_t offset, const std::string& text) { bytes_.replace(offset, text.size(), text); }
  const std::string& bytes() const { return bytes_; }

private:
  std::string bytes_;
  bool big_endian_;
};

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
  Header header(352, spec.big_endian);
  header.put(0, std::int32_t(348));
  header.put_all<std::int16_t>(40, spec.dim);
  header.put(68, spec.intent);
  header.put(70, spec.datatype);
  header.put(72, spec.bits);
  header.put_all<float>(76, spec.pixdim);
  header.put(108, spec.vox_offset);
  header.put(112, spec.slope);
  header.put(116, spec.inter);
  header.put(123, spec.units);
  header.put(252, spec.qform_code);
  header.put(254, spec.sform_code);
  header.put_all<float>(256, spec.quaternion);
  header.put_all<float>(268, spec.qoffset);
  header.put_all<float>(280, spec.sform);
  header.put_text(344, spec.magic);
  return header.bytes() + voxels;
}

std::string nifti_2(const NiftiSpec& spec, const std::string& voxels) {
  Header header(544, spec.big_endian);
  header.put(0, std::int32_t(540));
  header.put_text(4, std::string("n+2\0\r\n\x1a\n", 8));
  header.put(12, spec.datatype);
  header.put(14, spec.bits);
  header.put_all<std::int64_t>(16, spec.dim);
  header.put_all<double>(104, spec.pixdim);
  header.put(168, std::int64_t(544));
  header.put(176, double(spec.slope));
  header.put(184, double(spec.inter));
  header.put(344, std::int32_t(spec.qform_code));
  header.put(348, std::int32_t(spec.sform_code));
  header.put_all<double>(352, spec.quaternion);
  header.put_all<double>(376, spec.qoffset);
  header.put_all<double>(400, spec.sform);
  header.put(500, std::int32_t(spec.units));
  header.put(504, std::int32_t(spec.intent));
  return header.bytes() + voxels;
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
