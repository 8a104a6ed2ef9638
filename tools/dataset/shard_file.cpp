#include "tools/dataset/shard_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "tools/cli/hdf5_id.h"
#include "tools/dataset/study.h"

namespace insonate {
namespace {

constexpr unsigned kDeflateLevel = 1;  // of 9: each further level saves 1 % and takes a third more time
constexpr std::size_t kDigestSize = 16;
// A shard is damaged if it claims more. Its images and texts are far smaller.
constexpr std::uint64_t kMaxPixels = std::uint64_t(1) << 26, kMaxBytes = std::uint64_t(1) << 30;
constexpr std::size_t kLongestText = 1 << 20;

/// Opens a dataset, or returns an invalid one.
Hdf5Id opened(hid_t file, const char* name) {
  return {H5Dopen2(file, name, H5P_DEFAULT), H5Dclose};
}

std::string attribute_of(hid_t file, const char* name) {
  const Hdf5Id attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
  if (attribute < 0) return "";
  const Hdf5Id type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  const std::size_t size = H5Tget_size(type);
  // The library writes as many texts, or pointers, as a damaged file claims.
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || H5Sget_simple_extent_npoints(space) != 1 ||
      size > kLongestText)
    return "";
  std::string text(size, '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return "";
  return text.substr(0, text.find('\0'));
}

constexpr const char* kMaps[] = {"image", "label", "visible_label", "reach"};
constexpr const char* kOtherData[] = {
    "patient_from_pixel", "patient_from_probe", "depth_mm", "mm_per_pixel", "skin_mm", "settings", "probe",
    "pose_source"};

}  // namespace

struct ShardWriter::State {
  std::filesystem::path temporary, shown;
  ShardShape shape;
  Hdf5Id file;
  std::array<Hdf5Id, std::size(kMaps)> maps;
  // One entry per row of these; they are written at the end.
  std::vector<double> patient_from_pixel, patient_from_probe, depth_mm, mm_per_pixel;
  std::vector<float> skin_mm;
  std::vector<std::string> settings, probe, pose_source, digest;
  std::vector<std::uint8_t> put;

  [[noreturn]] void refuse() const {
    const std::string why = errno == 0 ? "" : std::string(" (") + std::strerror(errno) + ")";
    hdf5_given_up = true;
    throw InputError(shown.string(), "", "it cannot be written" + why, "check the folder's permissions and free space");
  }
  void need(bool done) const {
    if (!done) refuse();
  }

  /// Makes a dataset of rows. Its chunk is one row of a map; other data are one chunk.
  Hdf5Id make(const char* name, hid_t type, const std::vector<hsize_t>& of_row, bool row_by_row) {
    std::vector<hsize_t> size{shape.images}, chunk{row_by_row ? 1 : shape.images};
    size.insert(size.end(), of_row.begin(), of_row.end());
    chunk.insert(chunk.end(), of_row.begin(), of_row.end());
    const Hdf5Id space(H5Screate_simple(int(size.size()), size.data(), nullptr), H5Sclose);
    const Hdf5Id how = hdf5_without_time(H5P_DATASET_CREATE);
    H5Pset_chunk(how, int(chunk.size()), chunk.data());
    H5Pset_deflate(how, kDeflateLevel);
    H5Pset_fletcher32(how);
    Hdf5Id made(H5Dcreate2(file, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose);
    need(made >= 0);
    return made;
  }

  void write_all(const char* name, hid_t stored, hid_t in_memory, const std::vector<hsize_t>& of_row,
                 const void* values) {
    const Hdf5Id made = make(name, stored, of_row, false);
    need(H5Dwrite(made, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
  }

  void write_texts(const char* name, const std::vector<std::string>& texts) {
    std::size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    std::string joined(longest * texts.size(), '\0');
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(joined.data() + i * longest, longest);
    const Hdf5Id type = hdf5_text(longest);
    write_all(name, type, type, {}, joined.data());
  }
};

ShardWriter::ShardWriter(const std::filesystem::path& temporary, const std::filesystem::path& shown,
                         const ShardShape& shape, const std::vector<std::pair<std::string, std::string>>& about)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  use_hdf5();
  s.temporary = temporary;
  s.shown = shown;
  s.shape = shape;
  errno = 0;
  const Hdf5Id how(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(how, H5F_LIBVER_V110, H5F_LIBVER_V110);  // the first whose structures have checksums too
  const Hdf5Id made = hdf5_without_time(H5P_FILE_CREATE);
  s.file = Hdf5Id(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, made, how), H5Fclose);
  s.need(s.file >= 0);
  for (const auto& [name, text] : about) s.need(write_hdf5_attribute(s.file, name, text));
  for (std::size_t i = 0; i < s.maps.size(); ++i)
    s.maps[i] = s.make(kMaps[i], H5T_STD_U8LE, {hsize_t(shape.height), hsize_t(shape.width)}, true);
  const std::size_t n = shape.images;
  s.patient_from_pixel.resize(16 * n);
  s.patient_from_probe.resize(16 * n);
  s.depth_mm.resize(n);
  s.mm_per_pixel.resize(n);
  s.skin_mm.assign(n * std::size_t(shape.most_lines), std::numeric_limits<float>::quiet_NaN());
  s.settings.resize(n);
  s.probe.resize(n);
  s.pose_source.resize(n);
  s.digest.resize(n);
  s.put.resize(n);
}

ShardWriter::~ShardWriter() = default;

void ShardWriter::put(std::uint32_t row, const DatasetImage& image) {
  State& s = *state_;
  use_hdf5();
  errno = 0;
  const hsize_t start[] = {row, 0, 0}, size[] = {1, hsize_t(s.shape.height), hsize_t(s.shape.width)};
  const Image<std::uint8_t>* maps[] = {&image.grey, &image.truth.label, &image.truth.visible_label, &image.truth.reach};
  const Hdf5Id in_memory(H5Screate_simple(3, size, nullptr), H5Sclose);
  for (std::size_t i = 0; i < s.maps.size(); ++i) {
    const Hdf5Id in_file(H5Dget_space(s.maps[i]), H5Sclose);
    H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start, nullptr, size, nullptr);
    s.need(H5Dwrite(s.maps[i], H5T_NATIVE_UINT8, in_memory, in_file, H5P_DEFAULT, maps[i]->pixels.data()) >= 0);
  }
  const glm::dmat4 probe = image.shot.patient_from_probe.matrix();
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) {
      s.patient_from_pixel[16 * row + std::size_t(4 * r + c)] = image.patient_from_pixel[c][r];
      s.patient_from_probe[16 * row + std::size_t(4 * r + c)] = probe[c][r];
    }
  s.depth_mm[row] = image.shot.depth_mm;
  s.mm_per_pixel[row] =
      image_geometry(image.shot.probe, image.shot.depth_mm, image.grey.width, image.grey.height).mm_per_pixel;
  std::copy(image.truth.skin_mm.begin(), image.truth.skin_mm.end(),
            s.skin_mm.begin() + std::ptrdiff_t(row) * s.shape.most_lines);
  s.settings[row] = image.settings;
  s.probe[row] = image.shot.probe.name;
  s.pose_source[row] = image.shot.pose_source;
  s.digest[row] = image.digest;
  s.put[row] = 1;
}

void ShardWriter::finish() {
  State& s = *state_;
  if (std::count(s.put.begin(), s.put.end(), 1) != std::ptrdiff_t(s.put.size()))
    throw std::logic_error("a shard lacks an image");
  use_hdf5();
  errno = 0;
  s.write_all("patient_from_pixel", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {4, 4}, s.patient_from_pixel.data());
  s.write_all("patient_from_probe", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {4, 4}, s.patient_from_probe.data());
  s.write_all("depth_mm", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {}, s.depth_mm.data());
  s.write_all("mm_per_pixel", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {}, s.mm_per_pixel.data());
  s.write_all("skin_mm", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {hsize_t(s.shape.most_lines)}, s.skin_mm.data());
  s.write_texts("settings", s.settings);
  s.write_texts("probe", s.probe);
  s.write_texts("pose_source", s.pose_source);
  s.write_texts("digest", s.digest);
  std::string all_digests;
  for (const std::string& digest : s.digest) all_digests += digest;
  s.need(write_hdf5_attribute(s.file, "digest", digest_of(all_digests)));
  bool closed = true;
  for (Hdf5Id& map : s.maps) closed = map.close() && closed;
  closed = s.file.close() && closed;
  s.need(closed);
  s.need(flush_to_disk(s.temporary));
}

bool flush_to_disk(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY);
  const bool kept = descriptor >= 0 && fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  return kept;
}

ShardSummary read_shard_summary(const std::filesystem::path& path) {
  use_hdf5();
  const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const ShardSummary summary{attribute_of(file, "study_digest"), attribute_of(file, "case_digest"),
                             attribute_of(file, "device"), attribute_of(file, "digest")};
  if (file < 0 || summary.study_digest.empty() || summary.digest.empty())
    throw InputError(path.string(), "", "it is not a shard of a dataset, or it is damaged",
                     "remove it, and make the shard again");
  return summary;
}

std::string damage_of_shard(const std::filesystem::path& path) {
  use_hdf5();
  const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file < 0) return "it is not an HDF5 file, or its structure is damaged";
  hsize_t images = 0;
  for (const char* name : kMaps) {
    const Hdf5Id data = opened(file, name);
    const Hdf5Id space(H5Dget_space(data), H5Sclose);
    hsize_t size[3] = {};
    if (data < 0 || H5Sget_simple_extent_ndims(space) != 3 || H5Sget_simple_extent_dims(space, size, nullptr) < 0)
      return std::string("it has no data '") + name + "'";
    images = size[0];
    if (images > kMaxShardImages || size[1] > kMaxPixels || size[2] > kMaxPixels / std::max<hsize_t>(size[1], 1))
      return std::string("the size of its data '") + name + "' is damaged";
    const hsize_t row[] = {1, size[1], size[2]};
    const Hdf5Id in_memory(H5Screate_simple(3, row, nullptr), H5Sclose);
    std::vector<std::uint8_t> pixels(size[1] * size[2]);
    for (hsize_t i = 0; i < size[0]; ++i) {
      const hsize_t start[] = {i, 0, 0};
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, row, nullptr);
      if (H5Dread(data, H5T_NATIVE_UINT8, in_memory, space, H5P_DEFAULT, pixels.data()) < 0)
        return "'" + std::string(name) + "' of its image " + std::to_string(i) + " is damaged";
    }
  }
  for (const char* name : kOtherData) {
    const Hdf5Id data = opened(file, name);
    const Hdf5Id type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
    const hssize_t values = H5Sget_simple_extent_npoints(space);
    if (data < 0 || values < 0) return std::string("it has no data '") + name + "'";
    const std::size_t of_value = H5Tget_size(type);
    if (H5Tis_variable_str(type) != 0 || H5Tdetect_class(type, H5T_VLEN) != 0 || of_value == 0 ||
        std::uint64_t(values) > kMaxBytes / of_value)
      return std::string("the size of its data '") + name + "' is damaged";
    std::vector<char> bytes(std::size_t(values) * of_value);
    if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
      return "its data '" + std::string(name) + "' are damaged";
  }
  const Hdf5Id digests = opened(file, "digest");
  const Hdf5Id space(H5Dget_space(digests), H5Sclose);
  const Hdf5Id type = hdf5_text(kDigestSize);
  if (digests < 0 || H5Sget_simple_extent_npoints(space) != hssize_t(images)) return "its list of digests is damaged";
  std::string all(std::size_t(images) * kDigestSize, '\0');
  if (H5Dread(digests, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0) return "its list of digests is damaged";
  if (digest_of(all) != attribute_of(file, "digest"))
    return "its list of digests is not the one that it was written with";
  return "";
}

}  // namespace insonate
