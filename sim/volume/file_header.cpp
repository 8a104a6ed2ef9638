#include "sim/volume/file_header.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <optional>
#include <sstream>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

// Deflate packs at most 1032 bytes into one (zlib's technical notes).
constexpr std::uint64_t kMostDeflated = 1032;
// What may follow the voxels in a packed stream, such as a tool's own extension.
constexpr std::uint64_t kMostTrailing = 1u << 24;
constexpr std::size_t kLongestTextHeader = 1u << 20;

[[noreturn]] void refuse(const fs::path& file, const std::string& problem, const std::string& remedy) {
  throw InputError(file.string(), "header", problem, remedy);
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// What all three formats claim.
struct Claim {
  std::array<std::uint64_t, 3> size{};
  VoxelType type = VoxelType::int16;
  fs::path data_file;
  std::uint64_t data_offset = 0;         ///< where the voxels begin in that file, or the packed stream that holds them
  bool packed = false;                   ///< by zlib or gzip
  std::uint64_t packed_with_header = 0;  ///< bytes in the packed stream that come before the voxels
};

/// Unpacks a zlib or gzip stream to nowhere and counts; stops beyond `enough`. Empty when the stream is damaged or cut
/// off: ITK would fill what is missing with zeros.
std::optional<std::uint64_t> unpacked_size(const fs::path& file, std::uint64_t offset, std::uint64_t enough) {
  constexpr std::size_t kChunk = 1u << 18;
  constexpr int kZlibOrGzip = 15 + 32;
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(std::streamoff(offset));
  z_stream unpacker{};
  if (inflateInit2(&unpacker, kZlibOrGzip) != Z_OK) throw std::bad_alloc();
  std::vector<char> packed(kChunk), plain(kChunk);
  std::uint64_t size = 0;
  int state = Z_OK;
  while (size <= enough) {
    if (unpacker.avail_in == 0) {
      stream.read(packed.data(), std::streamsize(kChunk));
      unpacker.next_in = reinterpret_cast<Bytef*>(packed.data());
      unpacker.avail_in = uInt(stream.gcount());
      if (unpacker.avail_in == 0) break;
    }
    // gzip allows one stream after another.
    if (state == Z_STREAM_END && inflateReset(&unpacker) != Z_OK) break;
    unpacker.next_out = reinterpret_cast<Bytef*>(plain.data());
    unpacker.avail_out = uInt(kChunk);
    state = inflate(&unpacker, Z_NO_FLUSH);
    size += kChunk - unpacker.avail_out;
    if (state != Z_OK && state != Z_STREAM_END) break;
  }
  inflateEnd(&unpacker);
  if (state != Z_STREAM_END && size <= enough) return std::nullopt;
  return size;
}

void check_against_bytes(const fs::path& file, const Claim& claim) {
  check_size(file.string(), claim.size[0], claim.size[1], claim.size[2]);
  std::error_code error;
  if (!fs::is_regular_file(claim.data_file, error))
    refuse(file, "there is no data file '" + claim.data_file.string() + "'", "put it beside the header");
  const std::uint64_t there = fs::file_size(claim.data_file, error);
  const std::uint64_t voxels = claim.size[0] * claim.size[1] * claim.size[2] * bytes_of(claim.type);
  const std::string claims = "it claims " + std::to_string(voxels) + " bytes of voxels, ";
  const char* const remedy = "copy the file again";
  if (!claim.packed) {
    const std::uint64_t held = there > claim.data_offset ? there - claim.data_offset : 0;
    if (voxels > held) refuse(file, claims + "the file holds " + std::to_string(held), remedy);
    return;
  }
  const std::uint64_t needed = claim.packed_with_header + voxels;
  if (needed / kMostDeflated > there)
    refuse(file, claims + "which its " + std::to_string(there) + " packed bytes cannot hold", remedy);
  const auto size = unpacked_size(claim.data_file, claim.data_offset, needed + kMostTrailing);
  if (!size) refuse(file, "the packed data are damaged or cut off", remedy);
  if (*size < needed)
    refuse(file, claims + "the file holds " + std::to_string(*size - std::min(*size, claim.packed_with_header)),
           remedy);
  if (*size > needed + kMostTrailing) refuse(file, claims + "the file holds far more", remedy);
}

// ---------------------------------------------------------------------------------------------------------------------
// NIfTI: https://nifti.nimh.nih.gov, nifti1.h and nifti2.h; offsets are those headers' fields.

/// A binary header with its byte order.
class Bytes {
public:
  Bytes(std::string bytes, bool swapped) : bytes_(std::move(bytes)), swapped_(swapped) {}
  template <typename T>
  T at(std::size_t offset) const {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + offset, sizeof(T));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

private:
  std::string bytes_;
  bool swapped_;
};

struct Nifti {
  std::array<std::int64_t, 8> dim{};
  int datatype = 0;
  std::array<double, 8> pixdim{};
  double data_offset = 0;
  bool by_matrix = false;                         ///< sform_code > 0
  std::array<std::array<double, 4>, 3> matrix{};  ///< srow_x, y, z
};

constexpr std::size_t kNifti1Bytes = 348, kNifti2Bytes = 540;

Nifti parse_nifti1(const Bytes& header) {
  Nifti n;
  for (std::size_t d = 0; d < 8; ++d) {
    n.dim[d] = header.at<std::int16_t>(40 + 2 * d);
    n.pixdim[d] = double(header.at<float>(76 + 4 * d));
  }
  n.datatype = header.at<std::int16_t>(70);
  n.data_offset = double(header.at<float>(108));
  n.by_matrix = header.at<std::int16_t>(254) > 0;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c) n.matrix[r][c] = double(header.at<float>(280 + 16 * r + 4 * c));
  return n;
}

Nifti parse_nifti2(const Bytes& header) {
  Nifti n;
  for (std::size_t d = 0; d < 8; ++d) {
    n.dim[d] = header.at<std::int64_t>(16 + 8 * d);
    n.pixdim[d] = header.at<double>(104 + 8 * d);
  }
  n.datatype = header.at<std::int16_t>(12);
  n.data_offset = double(header.at<std::int64_t>(168));
  n.by_matrix = header.at<std::int32_t>(348) > 0;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c) n.matrix[r][c] = header.at<double>(400 + 32 * r + 8 * c);
  return n;
}

VoxelType nifti_type(const fs::path& file, int datatype) {
  static const std::map<int, VoxelType> types = {
      {2, VoxelType::uint8},    {4, VoxelType::int16},    {8, VoxelType::int32},    {16, VoxelType::float32},
      {64, VoxelType::float64}, {256, VoxelType::int8},   {512, VoxelType::uint16}, {768, VoxelType::uint32},
      {1024, VoxelType::int64}, {1280, VoxelType::uint64}};
  const auto known = types.find(datatype);
  if (known == types.end())
    refuse(file, "the voxels have NIfTI's data type " + std::to_string(datatype) + ", no plain number",
           "save it with one integer or float a voxel");
  return known->second;
}

/// The first bytes of a file, unpacked if it is gzip; `packed` says whether.
std::string first_bytes(const fs::path& file, std::size_t count, bool& packed) {
  std::string bytes(count, '\0');
  const gzFile stream = gzopen(file.c_str(), "rb");
  if (!stream) refuse(file, "it cannot be read", "check its permissions");
  const int read = gzread(stream, bytes.data(), unsigned(count));
  packed = gzdirect(stream) == 0;
  gzclose(stream);
  bytes.resize(std::size_t(std::max(read, 0)));
  return bytes;
}

FileHeader check_nifti(const fs::path& file) {
  bool packed = false;
  const std::string bytes = first_bytes(file, kNifti2Bytes, packed);
  const auto begins_with = [&](std::uint32_t length, bool swapped) {
    return bytes.size() >= length && Bytes(bytes, swapped).at<std::uint32_t>(0) == length;
  };
  std::optional<Nifti> found;
  for (const bool swapped : {false, true}) {
    if (begins_with(kNifti1Bytes, swapped) && bytes.compare(344, 4, std::string("n+1\0", 4)) == 0)
      found = parse_nifti1(Bytes(bytes, swapped));
    if (begins_with(kNifti2Bytes, swapped) && bytes.compare(4, 4, std::string("n+2\0", 4)) == 0)
      found = parse_nifti2(Bytes(bytes, swapped));
  }
  if (!found)
    refuse(file, bytes.size() < kNifti1Bytes ? "the file ends within the header" : "this is no NIfTI file",
           "check that it is the right file");
  const Nifti& n = *found;

  if (n.dim[0] < 1 || n.dim[0] > 7)
    refuse(file, "it claims " + std::to_string(n.dim[0]) + " dimensions", "save it again");
  for (std::size_t d = 4; d <= std::size_t(n.dim[0]); ++d)
    if (n.dim[d] != 1)
      refuse(file,
             "the image has more than 3 dimensions: " + std::to_string(n.dim[d]) + " along axis " + std::to_string(d),
             "save one volume of it");
  if (n.dim[0] < 3) refuse(file, "the image has " + std::to_string(n.dim[0]) + " dimensions", "give a 3D volume");
  Claim claim;
  for (std::size_t a = 0; a < 3; ++a) {
    claim.size[a] = std::uint64_t(std::max<std::int64_t>(0, n.dim[a + 1]));
    if (!(n.pixdim[a + 1] > 0) || !std::isfinite(n.pixdim[a + 1]))
      refuse(file, "the spacing along axis " + std::to_string(a + 1) + " is " + std::to_string(n.pixdim[a + 1]),
             "correct the header's pixdim");
  }
  for (const auto& row : n.matrix)
    for (const double element : row)
      if (n.by_matrix && !std::isfinite(element))
        refuse(file, "the sform matrix holds a number that is not finite", "correct it");
  claim.type = nifti_type(file, n.datatype);
  if (!(n.data_offset >= 0 && n.data_offset < 1e12))
    refuse(file, "it claims that the voxels begin at byte " + std::to_string(n.data_offset), "save it again");
  claim.data_file = file;
  claim.packed = packed;
  (packed ? claim.packed_with_header : claim.data_offset) = std::uint64_t(n.data_offset);
  check_against_bytes(file, claim);
  return {ImageFormat::nifti, to_string(claim.type)};
}

// ---------------------------------------------------------------------------------------------------------------------
// NRRD (https://teem.sourceforge.net/nrrd/format.html) and MetaImage (https://itk.org/Wiki/ITK/MetaIO/Documentation):
// lines of text.

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t\r");
  if (from == std::string::npos) return "";
  return text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

struct TextHeader {
  std::map<std::string, std::string>
      values;               ///< by key in lower case, the last one wins as in the formats' own readers
  std::uint64_t bytes = 0;  ///< up to and with the line that ends it

  std::string value(const std::string& key) const {
    const auto found = values.find(key);
    return found == values.end() ? "" : found->second;
  }
};

/// Reads "key SEPARATOR value" lines up to an empty line or the key `last`.
TextHeader read_text_header(const fs::path& file, const std::string& separator, const std::string& last) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(file, "it cannot be read", "check its permissions");
  TextHeader header;
  std::string line;
  for (char c = 0; header.bytes < kLongestTextHeader && stream.get(c);) {
    ++header.bytes;
    if (c != '\n') {
      line += c;
      continue;
    }
    if (last.empty() && trimmed(line).empty()) return header;
    if (const auto at = line.find(separator); at != std::string::npos && line[0] != '#') {
      const std::string key = lower_case(trimmed(line.substr(0, at)));
      header.values[key] = trimmed(line.substr(at + separator.size()));
      if (key == last) return header;
    }
    line.clear();
  }
  if (header.bytes >= kLongestTextHeader) refuse(file, "the header does not end", "check that it is the right file");
  return header;  // a detached header may end with the file
}

std::vector<std::uint64_t> whole_numbers(const std::string& text) {
  std::vector<std::uint64_t> numbers;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) {
    if (word.size() > 18 || word.find_first_not_of("0123456789") != std::string::npos) return {};
    numbers.push_back(std::stoull(word));
  }
  return numbers;
}

std::array<std::uint64_t, 3> three_sizes(const fs::path& file, const std::string& dimensions,
                                         const std::string& sizes) {
  if (dimensions != "3") refuse(file, "the image has '" + dimensions + "' dimensions", "give a volume of 3");
  const auto numbers = whole_numbers(sizes);
  if (numbers.size() != 3) refuse(file, "the sizes are '" + sizes + "'", "give three whole numbers");
  return {numbers[0], numbers[1], numbers[2]};
}

/// A data file named by a detached header. ITK would read lists and patterns of files too, which no check here covers.
fs::path named_data_file(const fs::path& file, const std::string& name) {
  if (lower_case(name).rfind("list", 0) == 0 || name.find('%') != std::string::npos ||
      name.find(' ') != std::string::npos)
    refuse(file, "the voxels lie in several files", "save them in one");
  return file.parent_path() / name;
}

FileHeader check_nrrd(const fs::path& file) {
  const TextHeader header = read_text_header(file, ":", "");
  std::string magic(4, '\0');
  std::ifstream(file, std::ios::binary).read(magic.data(), 4);
  if (magic != "NRRD") refuse(file, "this is no NRRD file", "check that it is the right file");
  static const std::map<std::string, VoxelType> types = {{"signed char", VoxelType::int8},
                                                         {"int8", VoxelType::int8},
                                                         {"int8_t", VoxelType::int8},
                                                         {"uchar", VoxelType::uint8},
                                                         {"unsigned char", VoxelType::uint8},
                                                         {"uint8", VoxelType::uint8},
                                                         {"uint8_t", VoxelType::uint8},
                                                         {"short", VoxelType::int16},
                                                         {"short int", VoxelType::int16},
                                                         {"signed short", VoxelType::int16},
                                                         {"signed short int", VoxelType::int16},
                                                         {"int16", VoxelType::int16},
                                                         {"int16_t", VoxelType::int16},
                                                         {"ushort", VoxelType::uint16},
                                                         {"unsigned short", VoxelType::uint16},
                                                         {"unsigned short int", VoxelType::uint16},
                                                         {"uint16", VoxelType::uint16},
                                                         {"uint16_t", VoxelType::uint16},
                                                         {"int", VoxelType::int32},
                                                         {"signed int", VoxelType::int32},
                                                         {"int32", VoxelType::int32},
                                                         {"int32_t", VoxelType::int32},
                                                         {"uint", VoxelType::uint32},
                                                         {"unsigned int", VoxelType::uint32},
                                                         {"uint32", VoxelType::uint32},
                                                         {"uint32_t", VoxelType::uint32},
                                                         {"longlong", VoxelType::int64},
                                                         {"long long", VoxelType::int64},
                                                         {"long long int", VoxelType::int64},
                                                         {"int64", VoxelType::int64},
                                                         {"int64_t", VoxelType::int64},
                                                         {"ulonglong", VoxelType::uint64},
                                                         {"unsigned long long", VoxelType::uint64},
                                                         {"unsigned long long int", VoxelType::uint64},
                                                         {"uint64", VoxelType::uint64},
                                                         {"uint64_t", VoxelType::uint64},
                                                         {"float", VoxelType::float32},
                                                         {"double", VoxelType::float64}};
  Claim claim;
  claim.size = three_sizes(file, header.value("dimension"), header.value("sizes"));
  const auto type = types.find(lower_case(header.value("type")));
  if (type == types.end()) refuse(file, "the type is '" + header.value("type") + "'", "save it as short");
  claim.type = type->second;
  const std::string encoding = lower_case(header.value("encoding"));
  if (encoding != "raw" && encoding != "gzip" && encoding != "gz")
    refuse(file, "the encoding is '" + encoding + "'", "save it as raw or gzip");
  claim.packed = encoding != "raw";
  std::string data_file = header.value("data file");
  if (data_file.empty()) data_file = header.value("datafile");
  claim.data_file = data_file.empty() ? file : named_data_file(file, data_file);
  claim.data_offset = data_file.empty() ? header.bytes : 0;
  for (const char* key : {"line skip", "lineskip", "byte skip", "byteskip"})
    if (const std::string skip = header.value(key); !skip.empty() && skip != "0")
      refuse(file, std::string("the header asks for a ") + key, "save it without");
  check_against_bytes(file, claim);
  return {ImageFormat::nrrd, to_string(claim.type)};
}

FileHeader check_meta_image(const fs::path& file) {
  const TextHeader header = read_text_header(file, "=", "elementdatafile");
  static const std::map<std::string, VoxelType> types = {
      {"MET_CHAR", VoxelType::int8},       {"MET_UCHAR", VoxelType::uint8},
      {"MET_SHORT", VoxelType::int16},     {"MET_USHORT", VoxelType::uint16},
      {"MET_INT", VoxelType::int32},       {"MET_UINT", VoxelType::uint32},
      {"MET_LONG_LONG", VoxelType::int64}, {"MET_ULONG_LONG", VoxelType::uint64},
      {"MET_FLOAT", VoxelType::float32},   {"MET_DOUBLE", VoxelType::float64},
      {"MET_LONG", VoxelType::int32},      {"MET_ULONG", VoxelType::uint32}};  // 4 bytes on every machine
  if (header.value("ndims").empty() || header.value("elementdatafile").empty())
    refuse(file, "this is no MetaImage file", "check that it is the right file");
  Claim claim;
  claim.size = three_sizes(file, header.value("ndims"), header.value("dimsize"));
  const auto type = types.find(header.value("elementtype"));
  if (type == types.end())
    refuse(file, "the ElementType is '" + header.value("elementtype") + "'", "save it as MET_SHORT");
  claim.type = type->second;
  const std::string channels = header.value("elementnumberofchannels");
  if (!channels.empty() && channels != "1")
    refuse(file, "each voxel has " + channels + " components, as in colour images",
           "give a volume with one number a voxel");
  if (lower_case(header.value("binarydata")) == "false")
    refuse(file, "the voxels are written as text", "save them as binary");
  if (const std::string skip = header.value("headersize"); !skip.empty() && skip != "0")
    refuse(file, "the header asks for a HeaderSize of " + skip, "save it without");
  claim.packed = lower_case(header.value("compresseddata")) == "true";
  const std::string data_file = header.value("elementdatafile");
  const bool local = lower_case(data_file) == "local";
  claim.data_file = local ? file : named_data_file(file, data_file);
  claim.data_offset = local ? header.bytes : 0;
  check_against_bytes(file, claim);
  return {ImageFormat::meta_image, to_string(claim.type)};
}

}  // namespace

FileHeader check_file_header(const fs::path& file) {
  const std::string name = lower_case(file.filename().string());
  const auto ends_with = [&](std::string_view end) { return name.size() > end.size() && name.ends_with(end); };
  if (ends_with(".nii") || ends_with(".nii.gz")) return check_nifti(file);
  if (ends_with(".nrrd") || ends_with(".nhdr")) return check_nrrd(file);
  if (ends_with(".mha") || ends_with(".mhd")) return check_meta_image(file);
  throw InputError(file.string(), "", "the name does not end as a volume's does",
                   "give a .nii, .nii.gz, .nrrd, .nhdr, .mha or .mhd file, or a DICOM folder");
}

}  // namespace insonate
