#include "sim/volume/ct_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/core/input_error.h"
#include "sim/volume/dicom_series.h"
#include "sim/volume/file_header.h"
#include "sim/volume/itk_image_io.h"
#include "sim/volume/subprocess.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr double kLeastHu = -1024, kMostHu = 32767;
// Fat is above -200 HU. Dense bone and contrast agent are below 3071 HU, where the scanners' usual 12 bits end.
constexpr std::int16_t kLeastBodyHu = -300, kMostBodyHu = 3071;
// Metal may exceed int16's range, but a tenth of a CT cannot be metal.
constexpr double kMostTooDense = 0.1;

const char* format_name(ImageFormat format) {
  switch (format) {
    case ImageFormat::nifti:
      return "NIfTI";
    case ImageFormat::nrrd:
      return "NRRD";
    case ImageFormat::meta_image:
      return "MetaImage";
    case ImageFormat::dicom:
      break;
  }
  return "DICOM series";
}

/// Calls `use` with a pointer of the voxels' own type.
template <typename Use>
void with_typed(VoxelType type, const std::byte* bytes, Use use) {
  switch (type) {
    case VoxelType::int8:
      return use(reinterpret_cast<const std::int8_t*>(bytes));
    case VoxelType::uint8:
      return use(reinterpret_cast<const std::uint8_t*>(bytes));
    case VoxelType::int16:
      return use(reinterpret_cast<const std::int16_t*>(bytes));
    case VoxelType::uint16:
      return use(reinterpret_cast<const std::uint16_t*>(bytes));
    case VoxelType::int32:
      return use(reinterpret_cast<const std::int32_t*>(bytes));
    case VoxelType::uint32:
      return use(reinterpret_cast<const std::uint32_t*>(bytes));
    case VoxelType::int64:
      return use(reinterpret_cast<const std::int64_t*>(bytes));
    case VoxelType::uint64:
      return use(reinterpret_cast<const std::uint64_t*>(bytes));
    case VoxelType::float32:
      return use(reinterpret_cast<const float*>(bytes));
    case VoxelType::float64:
      return use(reinterpret_cast<const double*>(bytes));
  }
}

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

/// Appends an image's voxels, rounded and clamped, to a CT whose grid is known.
void append_hounsfield(const fs::path& file, ImageFile& image, Volume<std::int16_t>& ct, CtSource& source) {
  std::size_t count = 1;
  for (const ImageFile::Axis& axis : image.axes()) count *= axis.size;
  const auto bytes = image.read_voxels();
  const std::size_t first = ct.voxels.size();
  ct.voxels.resize(first + count);
  with_typed(image.voxel_type(), bytes.get(), [&](const auto* voxels) {
    for (std::size_t v = 0; v < count; ++v) {
      const double hu = double(voxels[v]);
      if (!std::isfinite(hu))
        throw InputError(file.string(), voxel_at(ct.grid, first + v), "the value is not a finite number",
                         "export the CT again");
      const double kept = std::clamp(hu, kLeastHu, kMostHu);
      source.clamped += kept != hu;
      source.too_dense += hu > kMostHu;
      ct.voxels[first + v] = std::int16_t(std::lround(kept));
    }
  });
}

Volume<std::int16_t> read_dicom_folder(const fs::path& folder, CtSource& source) {
  DicomSeries series = find_dicom_series(folder);
  Volume<std::int16_t> ct{series.grid, {}};
  source = {format_name(ImageFormat::dicom), "", std::move(series.other_series), 0, 0};
  // Allocate slice by slice: a header may claim more than its file holds.
  for (const fs::path& slice : series.slices) {
    check_dicom_slice(slice);
    ImageFile image(slice, ImageFormat::dicom);
    const auto& axes = image.axes();
    const bool as_expected = axes.size() >= 2 && axes[0].size == std::uint64_t(ct.grid.size.x) &&
                             axes[1].size == std::uint64_t(ct.grid.size.y) && (axes.size() < 3 || axes[2].size == 1);
    if (!as_expected || image.components() != 1)
      throw InputError(slice.string(), "header", "it is not a grey image of the series' size",
                       "export the series again");
    source.stored_as = to_string(image.voxel_type());
    append_hounsfield(slice, image, ct, source);
  }
  return ct;
}

/// Refuses values that cannot come from a CT of a body, as after a wrong rescale.
void check_values(const std::string& file, const Volume<std::int16_t>& ct, const CtSource& source) {
  const auto refuse = [&](const std::string& problem) {
    throw InputError(file, "voxels", problem,
                     "check the rescale slope and intercept, or export the CT again in Hounsfield units");
  };
  const auto [least, most] = std::minmax_element(ct.voxels.begin(), ct.voxels.end());
  if (*least == *most) refuse("all voxels have the same value, " + std::to_string(*least) + " HU");
  if (*most < kLeastBodyHu || *least > kMostBodyHu)
    refuse("the values reach from " + std::to_string(*least) + " to " + std::to_string(*most) +
           " HU, where those of a body reach from about " + std::to_string(kLeastBodyHu) + " to " +
           std::to_string(kMostBodyHu) + " HU");
  if (double(source.too_dense) > kMostTooDense * double(ct.voxels.size()))
    refuse(std::to_string(100 * source.too_dense / ct.voxels.size()) + " % of the voxels are above " +
           std::to_string(int(kMostHu)) + " HU, denser than any metal in a CT");
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
  source = {format_name(ImageFormat::dicom), "", {}, take_number(), take_number()};
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
        ImageFile(file, ImageFormat::dicom).read_voxels();
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

FileHeader ct_header(const fs::path& file) {
  if (is_dicom_file(existing_file(file)))
    throw InputError(file.string(), "", "this is one DICOM file", "name the folder of its series");
  return check_file_header(file);
}

Volume<std::int16_t> read_ct_file(const fs::path& file, const FileHeader& header, CtSource& source) {
  ImageFile image(file, header.format);
  Volume<std::int16_t> ct{checked_grid(file.string(), image), {}};
  source = {format_name(header.format), header.stored_as, {}, 0, 0};
  append_hounsfield(file, image, ct, source);
  return ct;
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
    // Check before ITK opens the file: ITK takes the small numbers of a spacing in another unit for a singular
    // orientation.
    const FileHeader header = ct_header(file_or_folder);
    check_body_size(name, header.size, header.spacing);
    ct = read_ct_file(file_or_folder, header, found);
  }
  check_values(name, ct, found);
  if (source) *source = std::move(found);
  return ct;
}

Volume<std::int16_t> read_case_ct(const fs::path& file) {
  CtSource unused;
  return read_ct_file(file, ct_header(file), unused);
}

Volume<std::uint8_t> read_labels(const fs::path& file) {
  ImageFile image(file, check_file_header(existing_file(file)).format);
  Volume<std::uint8_t> labels{checked_grid(file.string(), image), {}};
  const auto bytes = image.read_voxels();
  labels.voxels.resize(labels.grid.count());
  with_typed(image.voxel_type(), bytes.get(), [&](const auto* voxels) {
    for (std::size_t v = 0; v < labels.voxels.size(); ++v) {
      const double value = double(voxels[v]);
      if (!(value >= 0 && value <= 255 && value == std::floor(value)))
        throw InputError(file.string(), voxel_at(labels.grid, v), "the value is not a whole number from 0 to 255",
                         "give a label volume, not a CT");
      labels.voxels[v] = std::uint8_t(value);
    }
  });
  return labels;
}

void write_ct(const fs::path& nrrd_file, const Volume<std::int16_t>& ct) {
  write_nrrd(nrrd_file, ct.grid, VoxelType::int16, ct.voxels.data(), false);
}

void write_labels(const fs::path& nrrd_file, const Volume<std::uint8_t>& labels) {
  write_nrrd(nrrd_file, labels.grid, VoxelType::uint8, labels.voxels.data(), false);
}

}  // namespace insonate
