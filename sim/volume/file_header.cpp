#include "sim/volume/file_header.h"

#include <glm/geometric.hpp>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <optional>
#include <sstream>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

// Deflate packs at most 1032 bytes into one (zlib's technical notes).
constexpr std::uint64_t kMostDeflated = 1032;
// How many bytes beyond the claimed voxels a packed stream is counted.
constexpr std::uint64_t kMostCounted = 1u << 24;
// The precision of headers in single precision and of matrices computed in it.
constexpr double kSpacingShare = 1e-2, kRightAngle = 1e-3;
constexpr std::size_t kLongestTextHeader = 1u << 20;

[[noreturn]] void refuse(const fs::path& file, const std::string& problem, const std::string& remedy) {
  throw InputError(file.string(), "header", problem, remedy);
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The claims of a header, common to the three formats.
struct Claim {
  std::array<std::uint64_t, 3> size{};
  glm::dvec3 spacing{0.0};
  VoxelType type = VoxelType::int16;
  fs::path data_file;
  std::uint64_t data_offset = 0;         ///< start of the voxels in that file, or of the packed stream that holds them
  bool packed = false;                   ///< by zlib or gzip
  std::uint64_t packed_with_header = 0;  ///< bytes in the packed stream that come before the voxels
};

/// Unpacks a zlib or gzip stream, discards the data and returns their size. Stops beyond `enough`. Returns nothing if
/// the stream is damaged or truncated: ITK would fill the missing part with zeros.
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
    // gzip allows several streams in a row.
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
  const auto refuse_when_different = [&](std::uint64_t held, bool all_counted) {
    if (held == voxels) return;
    refuse(file,
           "it claims " + std::to_string(voxels) + " bytes of voxels, the file holds " +
               (all_counted ? "" : "more than ") + std::to_string(held),
           held < voxels ? "copy the file again" : "correct the sizes and the type in the header, or export it again");
  };
  if (!claim.packed) {
    refuse_when_different(there > claim.data_offset ? there - claim.data_offset : 0, true);
    return;
  }
  const std::uint64_t needed = claim.packed_with_header + voxels;
  if (needed / kMostDeflated > there)
    refuse(file,
           "it claims " + std::to_string(voxels) + " bytes of voxels, which its " + std::to_string(there) +
               " packed bytes cannot hold",
           "copy the file again");
  const auto size = unpacked_size(claim.data_file, claim.data_offset, needed + kMostCounted);
  if (!size) refuse(file, "the packed data are damaged or cut off", "copy the file again");
  refuse_when_different(*size - std::min(*size, claim.packed_with_header), *size <= needed + kMostCounted);
}

/// Returns the numbers in a text that may have brackets and commas; nothing if there are not `count` finite ones.
std::vector<double> finite_numbers(std::string text, std::size_t count) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (std::string word; stream >> word;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0' || !std::isfinite(numbers.back())) return {};
  }
  return numbers.size() == count ? numbers : std::vector<double>{};
}

glm::dvec3 checked_spacing(const fs::path& file, const glm::dvec3& spacing, const std::string& remedy) {
  for (int a = 0; a < 3; ++a)
    if (!(spacing[a] > 0) || !std::isfinite(spacing[a]))
      refuse(file, "the spacing along axis " + std::to_string(a + 1) + " is " + short_number(spacing[a]), remedy);
  return spacing;
}

FileHeader header_of(ImageFormat format, const Claim& claim) {
  return {format, to_string(claim.type), glm::ivec3(claim.size[0], claim.size[1], claim.size[2]), claim.spacing};
}

// ---------------------------------------------------------------------------------------------------------------------
// NIfTI: https://nifti.nimh.nih.gov, nifti1.h; offsets are that header's fields.

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

constexpr std::size_t kNiftiBytes = 348;

struct Nifti {
  std::array<std::int64_t, 8> dim{};
  int datatype = 0;
  std::array<double, 8> pixdim{};
  double data_offset = 0;
  double slope = 0, intercept = 0;  ///< a slope of 0 means none
  int units = 0;                    ///< of lengths: 1 metre, 2 mm, 3 micrometre, 0 unknown
  int intent = 0;
  bool by_quaternion = false;                     ///< qform_code > 0
  std::array<double, 3> quaternion{};             ///< b, c, d
  std::array<double, 3> offset{};                 ///< qoffset_x, y, z
  bool by_matrix = false;                         ///< sform_code > 0
  std::array<std::array<double, 4>, 3> matrix{};  ///< srow_x, y, z
};

Nifti parse_nifti(const Bytes& header) {
  Nifti n;
  for (std::size_t d = 0; d < 8; ++d) {
    n.dim[d] = header.at<std::int16_t>(40 + 2 * d);
    n.pixdim[d] = double(header.at<float>(76 + 4 * d));
  }
  n.datatype = header.at<std::int16_t>(70);
  n.data_offset = double(header.at<float>(108));
  n.slope = double(header.at<float>(112));
  n.intercept = double(header.at<float>(116));
  n.units = header.at<std::int8_t>(123) & 7;
  n.intent = header.at<std::int16_t>(68);
  n.by_quaternion = header.at<std::int16_t>(252) > 0;
  for (std::size_t q = 0; q < 3; ++q) n.quaternion[q] = double(header.at<float>(256 + 4 * q));
  for (std::size_t q = 0; q < 3; ++q) n.offset[q] = double(header.at<float>(268 + 4 * q));
  n.by_matrix = header.at<std::int16_t>(254) > 0;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c) n.matrix[r][c] = double(header.at<float>(280 + 16 * r + 4 * c));
  return n;
}

VoxelType nifti_type(const fs::path& file, int datatype) {
  static const std::map<int, VoxelType> types = {
      {2, VoxelType::uint8},    {4, VoxelType::int16},    {8, VoxelType::int32},    {16, VoxelType::float32},
      {64, VoxelType::float64}, {256, VoxelType::int8},   {512, VoxelType::uint16}, {768, VoxelType::uint32},
      {1024, VoxelType::int64}, {1280, VoxelType::uint64}};
  const auto known = types.find(datatype);
  if (known == types.end())
    refuse(file, "the voxels have NIfTI's data type " + std::to_string(datatype) + ", not one number per voxel",
           "save it with one integer or float a voxel");
  return known->second;
}

/// Returns the first bytes of a file, unpacked if it is gzip; `packed` reports whether it is.
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

/// Refuses a number beyond 1 km. ITK's singular value decomposition does not return for a matrix with numbers near the
/// largest of single precision.
void check_nifti_reach(const fs::path& file, const std::string& what, double number) {
  if (!(std::abs(number) <= kFurthestOriginMm))
    refuse(file, "the " + what + " holds " + short_number(number) + ", further than 1 km", "correct it");
}

/// Checks the placement in the patient as ITK reads it: from the sform, else the qform, with the spacing from pixdim.
/// Returns the spacing.
glm::dvec3 check_nifti_place(const fs::path& file, const Nifti& n) {
  if (n.units == 1 || n.units == 3)
    refuse(file, std::string("its unit of length is the ") + (n.units == 1 ? "metre" : "micrometre"),
           "save it in millimetres");
  const glm::dvec3 spacing =
      checked_spacing(file, {n.pixdim[1], n.pixdim[2], n.pixdim[3]}, "correct the header's pixdim");
  for (const double offset : n.offset) check_nifti_reach(file, "qform's offset", offset);
  if (n.by_matrix) {
    std::array<glm::dvec3, 3> columns;
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 4; ++c) {
        if (!std::isfinite(n.matrix[r][c]))
          refuse(file, "the sform matrix holds a number that is not finite", "correct it");
        check_nifti_reach(file, "sform matrix", n.matrix[r][c]);
        if (c < 3) columns[c][int(r)] = n.matrix[r][c];
      }
    if (n.by_quaternion) return spacing;  // ITK falls back on the qform
    for (std::size_t a = 0; a < 3; ++a)
      if (const double length = glm::length(columns[a]);
          std::abs(length - n.pixdim[a + 1]) > kSpacingShare * n.pixdim[a + 1])
        refuse(file,
               "the spacing along axis " + std::to_string(a + 1) + " is " + short_number(length) +
                   " mm by the sform matrix and " + short_number(n.pixdim[a + 1]) + " mm by pixdim",
               "correct the header");
    for (std::size_t a = 0; a < 3; ++a) {
      const double cosine = glm::dot(glm::normalize(columns[a]), glm::normalize(columns[(a + 1) % 3]));
      if (std::abs(cosine) > kRightAngle)
        refuse(file, "the axes of the sform matrix are not at right angles", "resample it to orthogonal axes");
    }
  } else if (n.by_quaternion) {
    double square = 0;
    for (const double q : n.quaternion) square += q * q;
    if (!(square <= 1 + kRightAngle)) refuse(file, "the qform's quaternion is not a rotation", "correct the header");
  }
  return spacing;
}

FileHeader check_nifti(const fs::path& file) {
  bool packed = false;
  const std::string bytes = first_bytes(file, kNiftiBytes, packed);
  const auto begins_with = [&](std::uint32_t length, bool swapped) {
    return bytes.size() >= sizeof length && Bytes(bytes, swapped).at<std::uint32_t>(0) == length;
  };
  constexpr std::uint32_t kNifti2Bytes = 540;
  if (begins_with(kNifti2Bytes, false) || begins_with(kNifti2Bytes, true))
    refuse(file, "this is a NIfTI-2 file", "save it as NIfTI-1 or NRRD");
  if (bytes.size() < kNiftiBytes) refuse(file, "the file ends within the header", "check that it is the right file");
  std::optional<Nifti> found;
  for (const bool swapped : {false, true})
    if (begins_with(kNiftiBytes, swapped) && bytes.compare(344, 4, std::string("n+1\0", 4)) == 0)
      found = parse_nifti(Bytes(bytes, swapped));
  if (!found) refuse(file, "this is not a NIfTI file", "check that it is the right file");
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
  }
  claim.spacing = check_nifti_place(file, n);
  constexpr int kMatrixIntent = 1004;
  if (n.intent == kMatrixIntent) refuse(file, "each voxel is a matrix, by the intent code 1004", "save the CT alone");
  if (n.slope != 0) check_rescale(file.string(), "scl_slope", n.slope, "scl_inter", n.intercept);
  if (n.slope == 0 && n.intercept != 0)
    refuse(file, "its scl_slope is 0, which means no rescale, yet its scl_inter is " + short_number(n.intercept),
           "correct the header");
  claim.type = nifti_type(file, n.datatype);
  if (!(n.data_offset >= double(kNiftiBytes) && n.data_offset < 1e12))
    refuse(file,
           "it claims that the voxels begin at byte " + short_number(n.data_offset) + ", and its header has " +
               std::to_string(kNiftiBytes) + " bytes",
           "save it again");
  claim.data_file = file;
  claim.packed = packed;
  (packed ? claim.packed_with_header : claim.data_offset) = std::uint64_t(n.data_offset);
  check_against_bytes(file, claim);
  return header_of(ImageFormat::nifti, claim);
}

// ---------------------------------------------------------------------------------------------------------------------
// NRRD (https://teem.sourceforge.net/nrrd/format.html) and MetaImage (https://itk.org/Wiki/ITK/MetaIO/Documentation):
// lines of text.

struct TextHeader {
  std::map<std::string, std::string>
      values;               ///< by key in lower case; the last one wins, as in the formats' own readers
  std::uint64_t bytes = 0;  ///< up to and including the line that ends it

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
      const std::string key = lower_case(std::string(trimmed(line.substr(0, at))));
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

/// Returns the path of a data file that a detached header names. ITK would also read lists and patterns of files, which
/// no check here covers.
fs::path named_data_file(const fs::path& file, const std::string& name) {
  if (lower_case(name).rfind("list", 0) == 0 || name.find('%') != std::string::npos ||
      name.find(' ') != std::string::npos)
    refuse(file, "the voxels lie in several files", "save them in one");
  return file.parent_path() / name;
}

/// Refuses units of length other than mm. `units` holds texts in quotation marks, or nothing.
void check_nrrd_units(const fs::path& file, const std::string& units) {
  std::istringstream stream(units);
  std::string between, unit;
  while (std::getline(stream, between, '"') && std::getline(stream, unit, '"'))
    if (!unit.empty() && unit != "mm") refuse(file, "its unit of length is '" + unit + "'", "save it in mm");
}

/// Refuses a placement in the patient that ITK would guess or refuse. Returns the spacing.
glm::dvec3 check_nrrd_place(const fs::path& file, const TextHeader& header) {
  for (const char* key : {"space units", "units"}) check_nrrd_units(file, header.value(key));
  if (const std::string origin = header.value("space origin"); !origin.empty() && finite_numbers(origin, 3).empty())
    refuse(file, "the space origin is '" + origin + "'", "give one vector of three numbers");
  if (const std::string directions = header.value("space directions"); !directions.empty()) {
    const auto n = finite_numbers(directions, 9);
    if (n.empty()) refuse(file, "the space directions are '" + directions + "'", "give three vectors of three numbers");
    return checked_spacing(file,
                           {std::hypot(n[0], n[1], n[2]), std::hypot(n[3], n[4], n[5]), std::hypot(n[6], n[7], n[8])},
                           "correct the space directions");
  }
  const std::string spacings = header.value("spacings");
  const auto n = finite_numbers(spacings, 3);
  if (n.empty())
    refuse(file, spacings.empty() ? "it gives no spacing" : "the spacings are '" + spacings + "'",
           "add the space directions");
  return checked_spacing(file, {n[0], n[1], n[2]}, "correct the spacings");
}

FileHeader check_nrrd(const fs::path& file) {
  const TextHeader header = read_text_header(file, ":", "");
  std::string magic(4, '\0');
  std::ifstream(file, std::ios::binary).read(magic.data(), 4);
  if (magic != "NRRD") refuse(file, "this is not an NRRD file", "check that it is the right file");
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
  const std::string endian = lower_case(header.value("endian"));
  if (bytes_of(claim.type) > 1 && endian != "little" && endian != "big")
    refuse(file, "it does not give the order of its bytes", "add: endian: little");
  claim.spacing = check_nrrd_place(file, header);
  for (const char* key : {"old min", "oldmin", "old max", "oldmax"})
    if (!header.value(key).empty())
      refuse(file, std::string("the header asks for a rescale by '") + key + "'", "save it in Hounsfield units");
  std::string data_file = header.value("data file");
  if (data_file.empty()) data_file = header.value("datafile");
  claim.data_file = data_file.empty() ? file : named_data_file(file, data_file);
  claim.data_offset = data_file.empty() ? header.bytes : 0;
  for (const char* key : {"line skip", "lineskip", "byte skip", "byteskip"})
    if (const std::string skip = header.value(key); !skip.empty() && skip != "0")
      refuse(file, std::string("the header asks for a ") + key, "save it without");
  check_against_bytes(file, claim);
  return header_of(ImageFormat::nrrd, claim);
}

/// Returns the value of the first of these synonymous keys that the header has; empty if it has none.
std::string any_value(const TextHeader& header, const std::vector<std::string>& keys) {
  for (const std::string& key : keys)
    if (const std::string value = header.value(key); !value.empty()) return value;
  return "";
}

/// Refuses a placement in the patient that ITK would guess or refuse. Returns the spacing.
glm::dvec3 check_meta_place(const fs::path& file, const TextHeader& header) {
  const std::string units = header.value("distanceunits");
  if (!units.empty() && units != "?" && units != "mm")
    refuse(file, "its unit of length is '" + units + "'", "save it in mm");
  const std::string spacings = any_value(header, {"elementspacing", "elementsize"});
  const auto numbers = finite_numbers(spacings, 3);
  if (numbers.empty())
    refuse(file, spacings.empty() ? "it gives no ElementSpacing" : "the ElementSpacing is '" + spacings + "'",
           "give three numbers in mm");
  const std::string matrix = any_value(header, {"transformmatrix", "rotation", "orientation"});
  if (!matrix.empty() && finite_numbers(matrix, 9).empty())
    refuse(file, "the TransformMatrix is '" + matrix + "'", "give nine numbers");
  const std::string offset = any_value(header, {"offset", "position", "origin"});
  if (!offset.empty() && finite_numbers(offset, 3).empty())
    refuse(file, "the Offset is '" + offset + "'", "give three numbers in mm");
  return checked_spacing(file, {numbers[0], numbers[1], numbers[2]}, "correct the ElementSpacing");
}

/// Refuses a wrong CompressedDataSize. ITK unpacks as many bytes as the header states, and leaves voxels unset if it
/// states none or too few.
void check_packed_size(const fs::path& file, const Claim& claim, const std::string& given) {
  const std::string there = std::to_string(fs::file_size(claim.data_file) - claim.data_offset);
  if (given == there) return;
  refuse(file, given.empty() ? "it gives no CompressedDataSize" : "the CompressedDataSize is '" + given + "'",
         "write 'CompressedDataSize = " + there + "' into the header");
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
    refuse(file, "this is not a MetaImage file", "check that it is the right file");
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
  claim.spacing = check_meta_place(file, header);
  for (const auto& [key, none] :
       {std::pair("elementtointensityfunctionslope", 1.0), std::pair("elementtointensityfunctionoffset", 0.0)})
    if (const std::string value = header.value(key); !value.empty() && finite_numbers(value, 1) != std::vector{none})
      refuse(file, "the header asks for a rescale by ElementToIntensityFunction", "save it in Hounsfield units");
  claim.packed = lower_case(header.value("compresseddata")) == "true";
  const std::string data_file = header.value("elementdatafile");
  const bool local = lower_case(data_file) == "local";
  claim.data_file = local ? file : named_data_file(file, data_file);
  claim.data_offset = local ? header.bytes : 0;
  check_against_bytes(file, claim);
  if (claim.packed) check_packed_size(file, claim, header.value("compresseddatasize"));
  return header_of(ImageFormat::meta_image, claim);
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
