// Format: https://nifti.nimh.nih.gov, nifti1.h. Four bytes follow the header; the first is not 0 if extensions follow.
// Each extension is its size in bytes (including these 8, a multiple of 16), its code, and its content.
#include "sim/volume/nifti_extensions.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

constexpr std::size_t kHeaderBytes = 348;
constexpr std::size_t kMostBytes = std::size_t(16) << 20;

template <typename T>
T number_at(const std::string& bytes, std::size_t offset, bool swapped) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes.data() + offset, sizeof(T));
  if (swapped) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

}  // namespace

std::vector<std::string> read_nifti_extensions(const std::filesystem::path& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> stream(gzopen(file.c_str(), "rb"), gzclose);
  if (!stream) throw InputError(file.string(), "", "it cannot be read", "check its name and permissions");
  std::string bytes;
  const auto read_to = [&](std::size_t end) {
    if (end <= bytes.size()) return true;
    const std::size_t had = bytes.size();
    bytes.resize(end);
    const int got = gzread(stream.get(), bytes.data() + had, unsigned(end - had));
    bytes.resize(had + std::size_t(std::max(got, 0)));
    return bytes.size() == end;
  };
  if (!read_to(kHeaderBytes + 4)) return {};

  bool swapped = false;
  if (number_at<std::uint32_t>(bytes, 0, swapped) != kHeaderBytes) swapped = true;
  if (number_at<std::uint32_t>(bytes, 0, swapped) != kHeaderBytes || bytes[kHeaderBytes] == 0) return {};
  const double voxels_at = double(number_at<float>(bytes, 108, swapped));

  const auto refuse = [&](const std::string& problem) {
    throw InputError(file.string(), "header extension", problem, "write the file again");
  };
  if (!(voxels_at <= double(kMostBytes))) refuse("the header claims that the voxels begin beyond 16 MiB");
  std::vector<std::string> extensions;
  std::size_t at = kHeaderBytes + 4;
  while (double(at) + 8 <= voxels_at) {
    if (!read_to(at + 8)) refuse("the file ends within it");
    const std::int32_t size = number_at<std::int32_t>(bytes, at, swapped);
    if (size < 16 || size % 16 != 0 || double(at) + size > voxels_at)
      refuse("it claims " + std::to_string(size) + " bytes");
    if (!read_to(at + std::size_t(size))) refuse("the file ends within it");
    extensions.push_back(bytes.substr(at + 8, std::size_t(size) - 8));
    at += std::size_t(size);
  }
  return extensions;
}

}  // namespace insonate
