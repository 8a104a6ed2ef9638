// Format: https://nifti.nimh.nih.gov, nifti1.h and nifti2.h; offsets are those of the headers' fields.
#include "sim/volume/nifti_volume.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/volume/byte_stream.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNifti1Bytes = 348, kNifti2Bytes = 540;
constexpr std::size_t kMaxExtensionBytes = std::size_t(16) << 20;
// How far the sform's axes may be from pixdim's lengths, mm, and from right angles. ITK has the same tolerances.
constexpr double kLengthTolerance = 1e-3, kAngleTolerance = 1e-4;
// A quaternion is stored in single precision.
constexpr double kQuaternionTolerance = 1e-3;

struct Nifti {
  std::size_t header_bytes = 0;
  bool big_endian = false;
  std::array<std::int64_t, 8> dim{};
  std::array<double, 8> pixdim{};
  int datatype = 0;
  double data_offset = 0;
  double slope = 0, intercept = 0;  ///< a slope of 0 means none
  int units = 0;                    ///< of lengths: 1 metre, 2 mm, 3 micrometre, 0 unknown
  int intent = 0;
  int qform_code = 0, sform_code = 0;  ///< 0: the header has none
  glm::dvec3 quaternion{0.0};          ///< b, c, d
  glm::dvec3 offset{0.0};              ///< qoffset_x, y, z
  glm::dmat3 sform{0.0};               ///< srow_x, y, z without their last numbers
  glm::dvec3 sform_offset{0.0};        ///< those last numbers
};

/// Parses a whole header of either version.
Nifti parse(const std::string& bytes, bool big_endian) {
  Nifti n;
  n.header_bytes = bytes.size();
  n.big_endian = big_endian;
  const bool second = bytes.size() == kNifti2Bytes;
  const auto at = [&]<typename Number>(std::size_t offset, Number) {
    return number_at<Number>(bytes.data() + offset, big_endian);
  };
  const auto whole = [&](std::size_t in_first, std::size_t in_second) {
    return second ? at(in_second, std::int32_t{}) : std::int32_t(at(in_first, std::int16_t{}));
  };
  const auto real = [&](std::size_t in_first, std::size_t in_second, int index = 0) {
    const std::size_t i = std::size_t(index);
    return second ? at(in_second + 8 * i, double{}) : double(at(in_first + 4 * i, float{}));
  };
  for (int d = 0; d < 8; ++d) {
    const std::size_t i = std::size_t(d);
    n.dim[i] = second ? at(16 + 8 * i, std::int64_t{}) : at(40 + 2 * i, std::int16_t{});
    n.pixdim[i] = real(76, 104, d);
  }
  n.datatype = second ? at(12, std::int16_t{}) : at(70, std::int16_t{});
  n.data_offset = second ? double(at(168, std::int64_t{})) : double(at(108, float{}));
  n.slope = real(112, 176);
  n.intercept = real(116, 184);
  n.units = (second ? at(500, std::int32_t{}) : at(123, std::int8_t{})) & 7;
  n.intent = whole(68, 504);
  n.qform_code = std::max(0, whole(252, 344));
  n.sform_code = std::max(0, whole(254, 348));
  for (int a = 0; a < 3; ++a) {
    n.quaternion[a] = real(256, 352, a);
    n.offset[a] = real(268, 376, a);
    for (int c = 0; c < 3; ++c) n.sform[c][a] = real(280, 400, 4 * a + c);
    n.sform_offset[a] = real(280, 400, 4 * a + 3);
  }
  return n;
}

/// Returns whether a file begins as gzip does.
bool is_gzip(const fs::path& file) {
  char magic[2] = {};
  std::ifstream(file, std::ios::binary).read(magic, 2);
  return magic[0] == '\x1f' && magic[1] == '\x8b';
}

/// Reads a header up to its last byte. Returns nothing if the file is not NIfTI, and sets `ends_early` if it ends
/// within the header.
std::optional<Nifti> read_header(ByteStream& stream, bool& ends_early) {
  std::string bytes(kNifti2Bytes, '\0');
  const std::size_t first = stream.read(bytes.data(), kNifti1Bytes);
  for (const bool big_endian : {false, true}) {
    const auto length = number_at<std::uint32_t>(bytes.data(), big_endian);
    if (length != kNifti1Bytes && length != kNifti2Bytes) continue;
    const std::size_t rest = first < kNifti1Bytes ? 0 : stream.read(bytes.data() + first, length - kNifti1Bytes);
    ends_early = first + rest < length;
    bytes.resize(length);
    const bool has_mark = length == kNifti1Bytes ? bytes.compare(344, 4, std::string_view("n+1\0", 4)) == 0
                                                 : bytes.compare(4, 8, std::string_view("n+2\0\r\n\x1a\n", 8)) == 0;
    return has_mark && !ends_early ? std::optional(parse(bytes, big_endian)) : std::nullopt;
  }
  ends_early = first < kNifti1Bytes;
  return std::nullopt;
}

ElementType type_of(const fs::path& file, int datatype) {
  static const std::map<int, ElementType> types = {
      {2, ElementType::uint8},    {4, ElementType::int16},    {8, ElementType::int32},    {16, ElementType::float32},
      {64, ElementType::float64}, {256, ElementType::int8},   {512, ElementType::uint16}, {768, ElementType::uint32},
      {1024, ElementType::int64}, {1280, ElementType::uint64}};
  const auto known = types.find(datatype);
  if (known == types.end())
    refuse_header(file, "the voxels have NIfTI's data type " + std::to_string(datatype) + ", not one number per voxel",
                  "save it with one integer or float a voxel");
  return known->second;
}

/// Refuses a number that is not finite or beyond 1 km.
void check_reach(const fs::path& file, const std::string& what, double number) {
  if (!(std::abs(number) <= kFurthestOrigin_mm))
    refuse_header(file, "the " + what + " holds " + number_text(number) + ", further than 1 km", "correct it");
}

/// Returns why the sform's matrix cannot place the volume; empty if it can.
std::string why_not_placed_by(const glm::dmat3& sform, const glm::dvec3& spacing) {
  glm::dmat3 axes;
  std::string problem;
  for (int a = 0; a < 3; ++a) {
    const double length = glm::length(sform[a]);
    if (problem.empty() && std::abs(length - spacing[a]) > kLengthTolerance)
      problem = "the spacing along axis " + std::to_string(a + 1) + " is " + number_text(length) +
                " mm by the sform matrix and " + number_text(spacing[a]) + " mm by pixdim";
    axes[a] = sform[a] / length;
  }
  // An axis of length 0 makes NaN of this, and is reported by its length.
  const glm::dmat3 excess = axes * glm::transpose(axes) - glm::dmat3(1.0);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (std::abs(excess[c][r]) > kAngleTolerance) return "the axes of the sform matrix are not at right angles";
  return problem;
}

/// Returns the number rounded to single precision.
double in_single_precision(double number) {
  // Volatile, because g++ 12 leaves the rounding out where it does this for two numbers at once (-O2 without NDEBUG).
  const volatile float rounded = float(number);
  return double(rounded);
}

/// Returns the qform's matrix, as nifti1.h defines it under "quaternion representation of rotation matrix". It has
/// single precision, as in the format's own library, so that grids are equal to the last bit in all programs.
glm::dmat3 qform_matrix(const Nifti& n, const glm::dvec3& spacing) {
  double b = n.quaternion[0], c = n.quaternion[1], d = n.quaternion[2];
  double a = 1 - (b * b + c * c + d * d);
  constexpr double kHalfTurn = 1e-7;  // below this rounding has taken a's digits
  if (a < kHalfTurn) {
    const double scale = 1 / std::sqrt(b * b + c * c + d * d);
    a = 0, b *= scale, c *= scale, d *= scale;
  } else {
    a = std::sqrt(a);
  }
  const glm::dmat3 rotation(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c),
                            2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b),
                            2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - c * c - b * b);
  glm::dmat3 matrix;
  for (int axis = 0; axis < 3; ++axis)
    for (int r = 0; r < 3; ++r) {
      const double length = axis == 2 && n.pixdim[0] < 0 ? -spacing[axis] : spacing[axis];
      matrix[axis][r] = in_single_precision(rotation[axis][r] * length);
    }
  return matrix;
}

/// Places the grid in the patient. NIfTI's axes are RAS: x and y change sign.
void place(const fs::path& file, const Nifti& n, Grid& grid) {
  if (n.units == 1 || n.units == 3)
    refuse_header(file, std::string("its unit of length is the ") + (n.units == 1 ? "metre" : "micrometre"),
                  "save it in millimetres");
  grid.spacing = {n.pixdim[1], n.pixdim[2], n.pixdim[3]};
  check_positive_spacing(file.string(), grid.spacing, "correct the header's pixdim");
  for (int a = 0; a < 3; ++a) check_reach(file, "qform's offset", n.offset[a]);
  if (n.qform_code == 0 && n.sform_code == 0) return;

  constexpr int kScannerFrame = 1;
  std::string problem;
  if (n.sform_code > 0) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) {
        const double number = c < 3 ? n.sform[c][r] : n.sform_offset[r];
        if (!std::isfinite(number))
          refuse_header(file, "the sform matrix holds a number that is not finite", "correct it");
        check_reach(file, "sform matrix", number);
      }
    problem = why_not_placed_by(n.sform, grid.spacing);
    if (n.qform_code == 0 && !problem.empty())
      refuse_header(file, problem, "correct the header, or resample it to orthogonal axes");
  }
  glm::dmat3 matrix = n.sform;
  glm::dvec3 origin = n.sform_offset;
  if (n.qform_code > 0 && !(n.sform_code == kScannerFrame && problem.empty())) {
    if (!(glm::dot(n.quaternion, n.quaternion) <= 1 + kQuaternionTolerance))
      refuse_header(file, "the qform's quaternion is not a rotation", "correct the header");
    matrix = qform_matrix(n, grid.spacing);
    origin = n.offset;
  }
  const glm::dvec3 lps_from_ras(-1, -1, 1);
  grid.origin = lps_from_ras * origin;
  for (int a = 0; a < 3; ++a) {
    const glm::dvec3 axis = lps_from_ras * matrix[a];
    grid.direction[a] = axis / glm::length(axis);
  }
}

void check_dimensions(const fs::path& file, const Nifti& n) {
  if (n.dim[0] < 1 || n.dim[0] > 7)
    refuse_header(file, "it claims " + std::to_string(n.dim[0]) + " dimensions", "save it again");
  for (std::size_t d = 4; d <= std::size_t(n.dim[0]); ++d)
    if (n.dim[d] != 1)
      refuse_header(
          file,
          "the image has more than 3 dimensions: " + std::to_string(n.dim[d]) + " along axis " + std::to_string(d),
          "save one volume of it");
  if (n.dim[0] < 3)
    refuse_header(file, "the image has " + std::to_string(n.dim[0]) + " dimensions", "give a 3D volume");
}

}  // namespace

VolumeHeader read_nifti_volume_header(const fs::path& file) {
  const bool packed = is_gzip(file);
  ByteStream stream(file, 0, packed);
  bool ends_early = false;
  const std::optional<Nifti> found = read_header(stream, ends_early);
  if (ends_early) refuse_header(file, "the file ends within the header", "check that it is the right file");
  if (!found) refuse_header(file, "this is not a NIfTI file", "check that it is the right file");
  const Nifti& n = *found;
  check_dimensions(file, n);
  VolumeHeader header{"NIfTI", {}, {}};
  place(file, n, header.grid);
  constexpr int kMatrixIntent = 1004;
  if (n.intent == kMatrixIntent)
    refuse_header(file, "each voxel is a matrix, by the intent code 1004", "save the CT alone");
  VoxelData& data = header.data;
  if (n.slope != 0) {
    check_rescale(file.string(), "scl_slope", n.slope, "scl_inter", n.intercept);
    data.slope = n.slope;
    data.intercept = n.intercept;
  } else if (n.intercept != 0) {
    refuse_header(file, "its scl_slope is 0, which means no rescale, yet its scl_inter is " + number_text(n.intercept),
                  "correct the header");
  }
  data.type = type_of(file, n.datatype);
  data.big_endian = n.big_endian;
  if (!(n.data_offset >= double(n.header_bytes) && n.data_offset < 1e12))
    refuse_header(file,
                  "it claims that the voxels begin at byte " + number_text(n.data_offset) + ", and its header has " +
                      std::to_string(n.header_bytes) + " bytes",
                  "save it again");
  data.file = file;
  data.packed = packed;
  (packed ? data.skipped : data.offset) = std::uint64_t(n.data_offset);
  const auto side = [&](std::size_t axis) { return std::uint64_t(std::max<std::int64_t>(0, n.dim[axis])); };
  check_size(file.string(), side(1), side(2), side(3));
  header.grid.size = glm::ivec3(side(1), side(2), side(3));
  check_voxel_data(file, data, header.grid.count());
  return header;
}

std::vector<std::string> read_nifti_extensions(const fs::path& file) {
  // Four bytes follow the header; the first is not 0 if extensions follow. Each extension is its size in bytes
  // (including these 8, a multiple of 16), its code, and its content.
  const auto refuse_extension = [&](const std::string& problem) {
    throw InputError(file.string(), "header extension", problem, "write the file again");
  };
  ByteStream stream(file, 0, is_gzip(file));
  bool ends_early = false;
  const std::optional<Nifti> found = read_header(stream, ends_early);
  char mark[4];
  if (!found || stream.read(mark, sizeof mark) < sizeof mark || mark[0] == 0) return {};
  if (!(found->data_offset <= double(kMaxExtensionBytes)))
    refuse_extension("the header claims that the voxels begin beyond 16 MiB");
  std::vector<std::string> extensions;
  double at = double(found->header_bytes + sizeof mark);
  while (at + 8 <= found->data_offset) {
    char head[8];
    if (stream.read(head, sizeof head) < sizeof head) refuse_extension("the file ends within it");
    const auto size = number_at<std::int32_t>(head, found->big_endian);
    if (size < 16 || size % 16 != 0 || at + size > found->data_offset)
      refuse_extension("it claims " + std::to_string(size) + " bytes");
    std::string content(std::size_t(size) - sizeof head, '\0');
    if (stream.read(content.data(), content.size()) < content.size()) refuse_extension("the file ends within it");
    extensions.push_back(std::move(content));
    at += size;
  }
  return extensions;
}

}  // namespace insonate
