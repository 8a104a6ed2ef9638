#include "sim/volume/dicom_ultrasound.h"

#include <gdcmAttribute.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <system_error>
#include <type_traits>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/volume/dicom_image.h"
#include "sim/volume/subprocess.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxPixelsPerSide = 8192;
constexpr std::size_t kMaxFrames = 100000;

// Values of the region's elements (PS3.3, C.8.5.5.1).
constexpr int kSpatialFormat2d = 1, kDataTypeTissue = 1, kUnitsCm = 3;
constexpr double kMinPixel_mm = 0.001, kMaxPixel_mm = 10;

const char* const kExportClipAgain = "export the clip again";

void silence() {
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
}

[[noreturn]] void refuse_damaged_clip(const fs::path& file) {
  throw InputError(file.string(), "", "the DICOM file is damaged or cut off", kExportClipAgain);
}

// Runs `work` in a subprocess, since a damaged file can end it.
std::string guarded(const fs::path& file, const std::function<std::string()>& work) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) throw InputError(file.string(), "", "the file cannot be read", "check its name and its permissions");
  try {
    return in_subprocess(bytes, [&] {
      silence();
      return work();
    });
  } catch (const SubprocessDied&) {
    refuse_damaged_clip(file);
  }
}

template <std::uint16_t group, std::uint16_t element>
auto value_of(const gdcm::DataSet& data) {
  gdcm::Attribute<group, element> attribute{};
  std::optional<std::decay_t<decltype(attribute.GetValue())>> value;
  const gdcm::Tag tag(group, element);
  if (!data.FindDataElement(tag) || data.GetDataElement(tag).IsEmpty()) return value;
  attribute.SetFromDataSet(data);
  value = attribute.GetValue();
  return value;
}

// Nothing if the region is not one of 2D tissue in cm.
std::optional<UltrasoundRegion> region_of(const gdcm::DataSet& item, const DicomUltrasound& clip) {
  const auto x0 = value_of<0x0018, 0x6018>(item), y0 = value_of<0x0018, 0x601a>(item),
             x1 = value_of<0x0018, 0x601c>(item), y1 = value_of<0x0018, 0x601e>(item);
  const auto across_cm = value_of<0x0018, 0x602c>(item), down_cm = value_of<0x0018, 0x602e>(item);
  if (value_of<0x0018, 0x6012>(item) != kSpatialFormat2d || value_of<0x0018, 0x6014>(item) != kDataTypeTissue ||
      value_of<0x0018, 0x6024>(item) != kUnitsCm || value_of<0x0018, 0x6026>(item) != kUnitsCm || !x0 || !y0 || !x1 ||
      !y1 || !across_cm || !down_cm)
    return std::nullopt;
  // Some machines state the last pixel, others the one behind it.
  const auto right = std::min<std::uint64_t>(*x1, std::uint64_t(clip.width) - 1),
             bottom = std::min<std::uint64_t>(*y1, std::uint64_t(clip.height) - 1);
  if (*x0 >= right || *y0 >= bottom) return std::nullopt;
  const glm::dvec2 mm(10 * std::abs(*across_cm), 10 * std::abs(*down_cm));
  for (const double side : {mm.x, mm.y})
    if (!(side >= kMinPixel_mm && side <= kMaxPixel_mm)) return std::nullopt;
  return UltrasoundRegion{{int(*x0), int(*y0), int(right - *x0 + 1), int(bottom - *y0 + 1)}, mm};
}

DicomUltrasound clip_of(const fs::path& file, const gdcm::File& dicom) {
  const gdcm::DataSet& header = dicom.GetDataSet();
  const std::string modality = value_of<0x0008, 0x0060>(header).value_or("").Trim();
  if (modality != "US")
    throw InputError(file.string(), "header",
                     "its modality is " + (modality.empty() ? "missing" : modality) + ", where ultrasound has US",
                     "name a clip of ultrasound");
  gdcm::MediaStorage kind;
  kind.SetFromFile(dicom);
  if (kind == gdcm::MediaStorage::EnhancedUSVolumeStorage)
    throw InputError(file.string(), "", "it is a volume, not a clip of 2D images",
                     "convert it to NRRD in 3D Slicer, and name that with --beam");
  DicomUltrasound clip;
  clip.width = value_of<0x0028, 0x0011>(header).value_or(0);
  clip.height = value_of<0x0028, 0x0010>(header).value_or(0);
  const int frames = value_of<0x0028, 0x0008>(header).value_or(1);
  if (clip.width < 2 || clip.height < 2 || clip.width > kMaxPixelsPerSide || clip.height > kMaxPixelsPerSide ||
      frames < 1 || std::size_t(frames) > kMaxFrames)
    throw InputError(file.string(), "header",
                     formatted("it claims %d images of %d x %d pixels", frames, clip.width, clip.height),
                     kExportClipAgain);
  clip.frames = std::size_t(frames);
  const gdcm::Tag regions(0x0018, 0x6011);
  if (!header.FindDataElement(regions)) return clip;
  const auto items = header.GetDataElement(regions).GetValueAsSQ();
  for (std::size_t i = 1; items && i <= items->GetNumberOfItems(); ++i) {
    const auto region = region_of(items->GetItem(i).GetNestedDataSet(), clip);
    const auto area = [](const UltrasoundRegion& of) { return of.rectangle[2] * of.rectangle[3]; };
    if (region && (!clip.region || area(*region) > area(*clip.region))) clip.region = region;
  }
  return clip;
}

// Returns the luminance of a pixel whose first sample lies at `at`, and the others `apart` behind each other.
std::uint8_t luminance(const char* at, std::size_t apart) {
  const auto sample = [&](std::size_t n) { return double(std::uint8_t(at[n * apart])); };
  return std::uint8_t(std::lround(0.299 * sample(0) + 0.587 * sample(1) + 0.114 * sample(2)));
}

std::string decoded(const fs::path& file, const std::vector<std::size_t>& numbers) {
  gdcm::ImageReader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read()) refuse_damaged_clip(file);
  const DicomUltrasound clip = clip_of(file, reader.GetFile());
  const gdcm::Image& image = reader.GetImage();
  const auto refuse_kind = [&](const std::string& what) {
    throw InputError(file.string(), "header", "its pixels are " + what + ", which is not read here",
                     "export the clip as RGB or in grey, with 8 bits");
  };
  using Photometric = gdcm::PhotometricInterpretation;
  const Photometric shown = image.GetPhotometricInterpretation();
  const bool is_ybr = shown == Photometric::YBR_FULL || shown == Photometric::YBR_FULL_422,
             is_rgb = shown == Photometric::RGB, is_palette = shown == Photometric::PALETTE_COLOR;
  const std::size_t samples = image.GetPixelFormat().GetSamplesPerPixel();
  if (image.GetPixelFormat().GetBitsAllocated() != 8)
    refuse_kind(std::to_string(image.GetPixelFormat().GetBitsAllocated()) + " bits large");
  if ((!is_ybr && !is_rgb && !is_palette && shown != Photometric::MONOCHROME2) || samples != (is_ybr || is_rgb ? 3 : 1))
    refuse_kind("in " + std::string(Photometric::GetPIString(shown)));
  std::array<char, 4 * 256> palette{};  // red, green, blue, and one that is not used
  // GDCM reads no such image without its palette, and a palette for 8 bits always has 256 colours.
  if (is_palette) image.GetLUT().GetBufferAsRGBA(reinterpret_cast<unsigned char*>(palette.data()));
  const std::size_t of_image = std::size_t(clip.width) * std::size_t(clip.height);
  if (const auto& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax(); !syntax.IsEncapsulated())
    check_raw_pixels(file, of_image * samples * clip.frames, syntax == gdcm::TransferSyntax::ExplicitVRBigEndian);
  std::string bytes(of_image * samples * clip.frames, '\0');
  if (image.GetBufferLength() != bytes.size() || !image.GetBuffer(bytes.data())) refuse_damaged_clip(file);
  const bool by_planes = samples == 3 && image.GetPlanarConfiguration() == 1;
  const std::size_t step = by_planes ? 1 : samples, apart = by_planes ? of_image : 1;
  std::string grey;
  grey.reserve(of_image * numbers.size());
  for (const std::size_t number : numbers)
    for (std::size_t i = 0; i < of_image; ++i) {
      const char* at = bytes.data() + number * of_image * samples + i * step;
      grey.push_back(is_rgb       ? char(luminance(at, apart))
                     : is_palette ? char(luminance(palette.data() + 4 * std::uint8_t(*at), 1))
                                  : *at);
    }
  return grey;
}

}  // namespace

DicomUltrasound read_dicom_ultrasound(const fs::path& file) {
  const std::string bytes = guarded(file, [&] {
    gdcm::Reader reader;
    reader.SetFileName(file.c_str());
    if (!reader.Read()) refuse_damaged_clip(file);
    const DicomUltrasound clip = clip_of(file, reader.GetFile());
    return std::string(reinterpret_cast<const char*>(&clip), sizeof clip);
  });
  static_assert(std::is_trivially_copyable_v<DicomUltrasound>);
  DicomUltrasound clip;
  std::memcpy(&clip, bytes.data(), sizeof clip);
  return clip;
}

std::vector<Image<std::uint8_t>> read_dicom_frames(const fs::path& file, const std::vector<std::size_t>& numbers) {
  const DicomUltrasound clip = read_dicom_ultrasound(file);
  const std::string bytes = guarded(file, [&] { return decoded(file, numbers); });
  std::vector<Image<std::uint8_t>> frames;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    Image<std::uint8_t>& frame = frames.emplace_back(clip.width, clip.height);
    std::memcpy(frame.pixels.data(), bytes.data() + i * frame.pixels.size(), frame.pixels.size());
  }
  return frames;
}

}  // namespace insonate
