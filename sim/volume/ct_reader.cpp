#include "sim/volume/ct_reader.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstring>
#include <new>

#include "sim/core/input_error.h"
#include "sim/volume/dicom_image.h"
#include "sim/volume/dicom_series.h"
#include "sim/volume/subprocess.h"
#include "sim/volume/text_volumes.h"
#include "sim/volume/volume_checks.h"
#include "sim/volume/volume_header.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr double kMin_hu = -1024, kMax_hu = 32767;
// Fat is above -200 HU. Dense bone and contrast agent are below 3071 HU, where the scanners' usual 12 bits end.
constexpr std::int16_t kMinBody_hu = -300, kMaxBody_hu = 3071;
// Metal may exceed int16's range, but a tenth of a CT cannot be metal.
constexpr double kMaxTooDense = 0.1;
// TotalSegmentator's 117 structures and the background. A CT has noise, and air below 0 HU.
constexpr int kMaxLabel = 255;
constexpr std::size_t kMaxLabels = 128;
// A volume with fewer voxels per value is too small to be told from a label map.
constexpr std::size_t kMinVoxelsPerLabel = 100;

const char* const kDicom = "DICOM series";

std::string voxel_at(const Grid& grid, std::size_t offset) {
  const std::size_t x = std::size_t(grid.size.x), y = std::size_t(grid.size.y);
  return "voxel (" + std::to_string(offset % x) + ", " + std::to_string(offset / x % y) + ", " +
         std::to_string(offset / (x * y)) + ")";
}

const fs::path& existing_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError(file.string(), "", "there is no such file", "check the name");
  if (!fs::is_regular_file(status))
    throw InputError(file.string(), "", "it is not an ordinary file", "name a file on disk");
  if (fs::file_size(file, error) == 0) throw InputError(file.string(), "", "the file is empty", "copy it again");
  return file;
}

/// Appends values, rounded and clamped, to a CT whose grid is known.
void append_hounsfield(const fs::path& file, const std::vector<double>& values, Volume<std::int16_t>& ct,
                       CtSource& source) {
  for (const double hu : values) {
    if (!std::isfinite(hu))
      throw InputError(file.string(), voxel_at(ct.grid, ct.voxels.size()), "the value is not a finite number",
                       "export the CT again");
    const double kept = std::clamp(hu, kMin_hu, kMax_hu);
    source.clamped += kept != hu;
    source.too_dense += hu > kMax_hu;
    source.rounded += hu != std::round(hu);
    ct.voxels.push_back(std::int16_t(std::lround(kept)));
  }
}

Volume<std::int16_t> read_dicom_folder(const fs::path& folder, CtSource& source) {
  DicomSeries series = find_dicom_series(folder);
  Volume<std::int16_t> ct{series.grid, {}};
  source = {kDicom, "", std::move(series.other_series)};
  // Memory grows slice by slice: a header may claim more than its file holds.
  for (const fs::path& slice : series.slices) {
    check_dicom_slice(slice);
    const DicomImage image = read_dicom_image(slice, glm::uvec2(ct.grid.size));
    source.stored_as = image.type;
    append_hounsfield(slice, image.values, ct, source);
  }
  return ct;
}

/// Refuses the numbers of structures, which would pass as Hounsfield units of soft tissue.
void check_no_labels(const std::string& file, const Volume<std::int16_t>& ct, const CtSource& source) {
  if (source.rounded > 0) return;
  std::bitset<kMaxLabel + 1> found;
  for (const std::int16_t value : ct.voxels) {
    if (value < 0 || value > kMaxLabel) return;
    found.set(std::size_t(value));
  }
  if (found.count() > kMaxLabels || ct.voxels.size() < kMinVoxelsPerLabel * found.count()) return;
  const std::int16_t most = *std::max_element(ct.voxels.begin(), ct.voxels.end());
  throw InputError(file, "voxels",
                   "this is a label map, not a CT: it has " + std::to_string(found.count()) +
                       " different values, all whole numbers from 0 to " + std::to_string(most),
                   "open the CT that it belongs to, or make a case of both with 'insonate-case import --ct CT --labels "
                   "LABELS --out FOLDER'");
}

/// Refuses values that cannot come from a CT of a body, as after a wrong rescale.
void check_values(const std::string& file, const Volume<std::int16_t>& ct, const CtSource& source) {
  const auto refuse = [&](const std::string& problem) {
    throw InputError(file, "voxels", problem,
                     "check the rescale slope and intercept, or export the CT again in Hounsfield units");
  };
  const auto [least, most] = std::minmax_element(ct.voxels.begin(), ct.voxels.end());
  if (*least == *most) refuse("all voxels have the same value, " + std::to_string(*least) + " HU");
  if (*most < kMinBody_hu || *least > kMaxBody_hu)
    refuse("the values reach from " + std::to_string(*least) + " to " + std::to_string(*most) +
           " HU, where those of a body reach from about " + std::to_string(kMinBody_hu) + " to " +
           std::to_string(kMaxBody_hu) + " HU");
  if (double(source.too_dense) > kMaxTooDense * double(ct.voxels.size()))
    refuse(std::to_string(100 * source.too_dense / ct.voxels.size()) + " % of the voxels are above " +
           std::to_string(int(kMax_hu)) + " HU, denser than any metal in a CT");
  check_no_labels(file, ct, source);
}

const char* const kExportAgain = "export the series again, or take the file out of the folder";

/// Serializes a CT and its source, to pass them between two processes of the same program.
std::string packed(const Volume<std::int16_t>& ct, const CtSource& source) {
  std::string bytes(reinterpret_cast<const char*>(&ct.grid), sizeof ct.grid);
  const auto add_number = [&](std::uint64_t number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  const auto add_text = [&](const std::string& text) {
    add_number(text.size());
    bytes += text;
  };
  add_number(source.clamped);
  add_number(source.too_dense);
  add_number(source.rounded);
  add_text(source.stored_as);
  add_number(source.other_series.size());
  for (const std::string& line : source.other_series) add_text(line);
  return bytes.append(reinterpret_cast<const char*>(ct.voxels.data()), ct.voxels.size() * sizeof ct.voxels[0]);
}

Volume<std::int16_t> unpacked(const std::string& bytes, CtSource& source) {
  std::size_t at = 0;
  const auto take = [&](void* into, std::size_t size) {
    std::memcpy(into, bytes.data() + at, size);
    at += size;
  };
  const auto take_number = [&] {
    std::uint64_t number = 0;
    take(&number, sizeof number);
    return number;
  };
  const auto take_text = [&] {
    std::string text(take_number(), '\0');
    take(text.data(), text.size());
    return text;
  };
  Volume<std::int16_t> ct;
  take(&ct.grid, sizeof ct.grid);
  source = {kDicom, "", {}, take_number(), take_number(), take_number()};
  source.stored_as = take_text();
  for (std::uint64_t left = take_number(); left > 0; --left) source.other_series.push_back(take_text());
  ct.voxels.resize(ct.grid.count());
  take(ct.voxels.data(), ct.voxels.size() * sizeof ct.voxels[0]);
  return ct;
}

/// Reads a DICOM folder in a subprocess. If the subprocess dies, finds the file that caused it.
Volume<std::int16_t> read_dicom_folder_in_subprocess(const fs::path& folder, CtSource& source) {
  const std::vector<std::string> files = files_below(folder);
  std::error_code error;
  std::uintmax_t bytes = 0;
  for (const std::string& file : files)
    if (const std::uintmax_t size = fs::file_size(file, error); !error) bytes += size;
  try {
    const std::string result = in_subprocess(bytes, [&] {
      CtSource found;
      const Volume<std::int16_t> ct = read_dicom_folder(folder, found);
      return packed(ct, found);
    });
    return unpacked(result, source);
  } catch (const SubprocessDied&) {
  }
  std::string blamed = folder.string();
  std::string problem = "a DICOM file in it is damaged, or the series needs more memory than there is";
  for (const std::string& file : files) try {
      in_subprocess(fs::file_size(file, error), [&] {
        scan_dicom_file(file);
        read_dicom_image(file);
        check_dicom_slice(file);
        return std::string();
      });
    } catch (const SubprocessDied&) {
      blamed = file;
      problem = "the DICOM file is damaged";
      break;
    } catch (const InputError&) {
      // This file is not an image, or its damage is detected: it did not end the process.
    }
  throw InputError(blamed, "", problem, kExportAgain);
}

VolumeHeader ct_header(const fs::path& file) {
  if (is_dicom_file(existing_file(file)))
    throw InputError(file.string(), "", "this is one DICOM file", "name the folder of its series");
  return read_volume_header(file);
}

/// Reads the voxels that a header describes onto the checked grid. `append` gets the values in pieces, in order.
template <typename T, typename Append>
Volume<T> read_voxels(const fs::path& file, const VolumeHeader& header, Append append) {
  Volume<T> volume{checked_grid(file.string(), header.grid), {}};
  const std::size_t count = volume.grid.count();
  // The size of a packed file is not checked yet, so its memory grows with what it holds.
  if (!header.data.packed) volume.voxels.reserve(count);
  read_values(file, header.data, count, [&](const std::vector<double>& values) { append(values, volume); });
  return volume;
}

/// Calls `read`, which reads a volume file. Refuses a file for which the memory has no room.
template <typename Read>
auto within_memory(const fs::path& file, Read read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw InputError(file.string(), "", "there is not enough memory for it", "resample it to fewer voxels");
  }
}

Volume<std::int16_t> read_ct_file(const fs::path& file, const VolumeHeader& header, CtSource& source) {
  source = {header.format, to_string(header.data.type), {}};
  return read_voxels<std::int16_t>(file, header, [&](const std::vector<double>& values, Volume<std::int16_t>& ct) {
    append_hounsfield(file, values, ct, source);
  });
}

}  // namespace

Volume<std::int16_t> read_ct(const fs::path& file_or_folder, CtSource* source) {
  const std::string name = file_or_folder.string();
  CtSource found;
  Volume<std::int16_t> ct;
  std::error_code error;
  if (fs::is_directory(file_or_folder, error)) {
    ct = read_dicom_folder_in_subprocess(file_or_folder, found);
    check_body_size(name, ct.grid.size, ct.grid.spacing);
  } else {
    ct = within_memory(file_or_folder, [&] {
      const VolumeHeader header = ct_header(file_or_folder);
      check_body_size(name, header.grid.size, header.grid.spacing);
      return read_ct_file(file_or_folder, header, found);
    });
  }
  check_values(name, ct, found);
  if (source) *source = std::move(found);
  return ct;
}

Volume<std::int16_t> read_case_ct(const fs::path& file) {
  CtSource unused;
  return within_memory(file, [&] { return read_ct_file(file, ct_header(file), unused); });
}

Volume<std::uint8_t> read_labels(const fs::path& file) {
  const auto append = [&](const std::vector<double>& values, Volume<std::uint8_t>& labels) {
    for (const double value : values) {
      if (!(value >= 0 && value <= 255 && value == std::floor(value)))
        throw InputError(file.string(), voxel_at(labels.grid, labels.voxels.size()),
                         "the value is not a whole number from 0 to 255", "give a label volume, not a CT");
      labels.voxels.push_back(std::uint8_t(value));
    }
  };
  return within_memory(
      file, [&] { return read_voxels<std::uint8_t>(file, read_volume_header(existing_file(file)), append); });
}

void write_ct(const fs::path& nrrd_file, const Volume<std::int16_t>& ct) {
  write_nrrd(nrrd_file, ct.grid, ElementType::int16, ct.voxels.data());
}

void write_labels(const fs::path& nrrd_file, const Volume<std::uint8_t>& labels) {
  write_nrrd(nrrd_file, labels.grid, ElementType::uint8, labels.voxels.data());
}

}  // namespace insonate
