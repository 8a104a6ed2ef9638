#include "sim/volume/voxel_data.h"

#include <algorithm>
#include <type_traits>

#include "sim/core/input_error.h"
#include "sim/volume/byte_stream.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kValuesAtOnce = 1u << 15;
// Deflate packs at most 1032 bytes into one (zlib's technical notes).
constexpr std::uint64_t kMaxDeflated = 1032;
// How many bytes beyond the claimed voxels are counted.
constexpr std::uint64_t kMaxCounted = 1u << 24;

[[noreturn]] void refuse_size(const fs::path& file, std::uint64_t claimed, std::uint64_t held,
                              const char* more_than = "") {
  refuse_header(
      file,
      "it claims " + std::to_string(claimed) + " bytes of voxels, the file holds " + more_than + std::to_string(held),
      held < claimed ? "copy the file again" : "correct the sizes and the type in the header, or export it again");
}

[[noreturn]] void refuse_as_damaged(const fs::path& file) {
  refuse_header(file, "the packed data are damaged or cut off", "copy the file again");
}

/// Applies the rescale. As in other readers of NIfTI, its result has single precision unless doubles are stored.
template <typename Stored>
double rescaled(Stored stored, const VoxelData& data) {
  if (data.slope == 1 && data.intercept == 0) return double(stored);
  using Kept = std::conditional_t<std::is_same_v<Stored, double>, double, float>;
  return double(Kept(double(Kept(stored)) * data.slope + data.intercept));
}

}  // namespace

void check_voxel_data(const fs::path& header_file, const VoxelData& data, std::uint64_t count) {
  std::error_code error;
  if (!fs::is_regular_file(data.file, error))
    refuse_header(header_file, "there is no data file '" + data.file.string() + "'", "put it beside the header");
  const std::uint64_t there = fs::file_size(data.file, error), claimed = count * bytes_of(data.type);
  if (!data.packed) {
    const std::uint64_t held = there - std::min(there, data.offset);
    if (held != claimed) refuse_size(header_file, claimed, held);
  } else if ((data.skipped + claimed) / kMaxDeflated > there) {
    refuse_header(header_file,
                  "it claims " + std::to_string(claimed) + " bytes of voxels, which its " + std::to_string(there) +
                      " packed bytes cannot hold",
                  "copy the file again");
  }
}

void decode(const VoxelData& data, const char* bytes, std::size_t count, std::vector<double>& values) {
  values.resize(count);
  with_type(data.type, [&](auto zero) {
    using Stored = decltype(zero);
    for (std::size_t v = 0; v < count; ++v)
      values[v] = rescaled(number_at<Stored>(bytes + v * sizeof(Stored), data.big_endian), data);
  });
}

void read_values(const fs::path& header_file, const VoxelData& data, std::uint64_t count,
                 const std::function<void(const std::vector<double>& values)>& take) {
  ByteStream stream(data.file, data.offset, data.packed);
  const std::size_t step = bytes_of(data.type);
  std::vector<char> bytes(kValuesAtOnce * step);
  std::uint64_t held = 0;
  const auto read = [&](std::uint64_t wanted) {
    const std::size_t got = stream.read(bytes.data(), std::size_t(std::min<std::uint64_t>(wanted, bytes.size())));
    if (stream.is_damaged()) refuse_as_damaged(header_file);
    return got;
  };
  for (std::uint64_t left = data.skipped; left > 0;) {
    const std::size_t got = read(left);
    if (got == 0) refuse_size(header_file, count * step, 0);
    left -= got;
  }
  std::vector<double> values;
  for (std::uint64_t left = count; left > 0; left -= values.size()) {
    const std::size_t wanted = std::size_t(std::min<std::uint64_t>(left, kValuesAtOnce)), got = read(wanted * step);
    held += got;
    if (got < wanted * step) refuse_size(header_file, count * step, held);
    decode(data, bytes.data(), wanted, values);
    take(values);
  }
  for (std::size_t got; held <= count * step + kMaxCounted && (got = read(bytes.size())) > 0;) held += got;
  if (held != count * step)
    refuse_size(header_file, count * step, held, held > count * step + kMaxCounted ? "more than " : "");
}

}  // namespace insonate
