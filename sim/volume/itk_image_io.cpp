#include "sim/volume/itk_image_io.h"

// Debian's itk_compiler_detection.h refuses every compiler but GNU's. These definitions replace it.
#define ITK_COMPILER_DETECTION_H
#define ITK_NOEXCEPT noexcept

#include <gdcmTrace.h>
#include <itkGDCMImageIO.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <new>
#include <sstream>

#include "sim/core/files.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

/// Discards, while it exists, what ITK and its libraries would print. Errors reach the user as exceptions.
class Silence {
public:
  Silence() : cerr_(std::cerr.rdbuf(nowhere_.rdbuf())), cout_(std::cout.rdbuf(nowhere_.rdbuf())) {
    itk::Object::GlobalWarningDisplayOff();
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
  }
  ~Silence() {
    std::cerr.rdbuf(cerr_);
    std::cout.rdbuf(cout_);
  }

private:
  std::ostringstream nowhere_;
  std::streambuf* cerr_;
  std::streambuf* cout_;
};

/// Runs a call into ITK. Replaces its exceptions, whose texts are meant for ITK's developers, by one sentence about the
/// file.
template <typename Call>
auto guarded(const std::filesystem::path& file, const std::string& place, const std::string& problem,
             const std::string& remedy, Call call) {
  const Silence silence;
  try {
    return call();
  } catch (const std::bad_alloc&) {
    throw InputError(file.string(), place, "there is not enough memory for it", "resample it to fewer voxels");
  } catch (const std::exception&) {
    throw InputError(file.string(), place, problem, remedy);
  }
}

itk::ImageIOBase::Pointer make_reader(ImageFormat format) {
  switch (format) {
    case ImageFormat::nifti:
      return itk::NiftiImageIO::New().GetPointer();
    case ImageFormat::nrrd:
      return itk::NrrdImageIO::New().GetPointer();
    case ImageFormat::meta_image:
      return itk::MetaImageIO::New().GetPointer();
    case ImageFormat::dicom:
      break;
  }
  return itk::GDCMImageIO::New().GetPointer();
}

const char* const kExportUncompressed = "export it again, uncompressed";

using Itk = itk::IOComponentEnum;

template <typename Integer>
VoxelType integer_type() {
  constexpr bool is_signed = std::is_signed_v<Integer>;
  switch (sizeof(Integer)) {
    case 1:
      return is_signed ? VoxelType::int8 : VoxelType::uint8;
    case 2:
      return is_signed ? VoxelType::int16 : VoxelType::uint16;
    case 4:
      return is_signed ? VoxelType::int32 : VoxelType::uint32;
    default:
      return is_signed ? VoxelType::int64 : VoxelType::uint64;
  }
}

VoxelType from_itk(Itk component) {
  switch (component) {
    case Itk::CHAR:
      return VoxelType::int8;
    case Itk::UCHAR:
      return VoxelType::uint8;
    case Itk::SHORT:
      return VoxelType::int16;
    case Itk::USHORT:
      return VoxelType::uint16;
    case Itk::INT:
      return VoxelType::int32;
    case Itk::UINT:
      return VoxelType::uint32;
    case Itk::LONG:
      return integer_type<long>();
    case Itk::ULONG:
      return integer_type<unsigned long>();
    case Itk::LONGLONG:
      return VoxelType::int64;
    case Itk::ULONGLONG:
      return VoxelType::uint64;
    case Itk::FLOAT:
      return VoxelType::float32;
    default:  // a double: check_file_header() refuses other types, and DICOM has no others
      return VoxelType::float64;
  }
}

Itk to_itk(VoxelType type) {
  switch (type) {
    case VoxelType::int8:
      return Itk::CHAR;
    case VoxelType::uint8:
      return Itk::UCHAR;
    case VoxelType::int16:
      return Itk::SHORT;
    case VoxelType::uint16:
      return Itk::USHORT;
    case VoxelType::int32:
      return Itk::INT;
    case VoxelType::uint32:
      return Itk::UINT;
    case VoxelType::int64:
      return Itk::LONGLONG;
    case VoxelType::uint64:
      return Itk::ULONGLONG;
    case VoxelType::float32:
      return Itk::FLOAT;
    case VoxelType::float64:
      break;
  }
  return Itk::DOUBLE;
}

}  // namespace

std::string to_string(VoxelType type) {
  static const char* const names[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                      "uint32", "int64", "uint64", "float32", "float64"};
  return names[std::size_t(type)];
}

std::size_t bytes_of(VoxelType type) {
  static const std::size_t bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return bytes[std::size_t(type)];
}

struct ImageFile::Reader {
  itk::ImageIOBase::Pointer itk;
};

ImageFile::ImageFile(const std::filesystem::path& file, ImageFormat format) : reader_(new Reader), file_(file) {
  const bool dicom = format == ImageFormat::dicom;
  const std::string problem = dicom ? "the header of its image is damaged or of a kind that is not read here"
                                    : "it gives an orientation or another field that its format does not allow";
  guarded(file, "header", problem, dicom ? kExportUncompressed : "save it again as NRRD by 3D Slicer", [&] {
    reader_->itk = make_reader(format);
    reader_->itk->SetFileName(file.string());
    reader_->itk->ReadImageInformation();
    const auto& io = *reader_->itk;
    components_ = int(io.GetNumberOfComponents());
    type_ = from_itk(io.GetComponentType());
    for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a)
      axes_.push_back({io.GetDimensions(a), io.GetSpacing(a), io.GetOrigin(a), io.GetDirection(a)});
  });
}

ImageFile::~ImageFile() = default;

std::unique_ptr<std::byte[]> ImageFile::read_voxels() {
  const std::string problem = "the voxels are damaged or packed in a way that is not read here";
  return guarded(file_, "voxels", problem, kExportUncompressed, [&] {
    auto& io = *reader_->itk;
    itk::ImageIORegion whole(io.GetNumberOfDimensions());
    for (unsigned a = 0; a < io.GetNumberOfDimensions(); ++a) whole.SetSize(a, io.GetDimensions(a));
    io.SetIORegion(whole);
    auto voxels = std::make_unique_for_overwrite<std::byte[]>(std::size_t(io.GetImageSizeInBytes()));
    io.Read(voxels.get());
    return voxels;
  });
}

void write_nrrd(const std::filesystem::path& file, const Grid& grid, VoxelType type, const void* voxels, bool gzip) {
  write_atomically(file, [&](const std::filesystem::path& temporary) {
    const Silence silence;
    try {
      const auto io = itk::NrrdImageIO::New();
      io->SetFileName(temporary.string());
      io->SetNumberOfDimensions(3);
      io->SetNumberOfComponents(1);
      io->SetPixelType(itk::IOPixelEnum::SCALAR);
      io->SetComponentType(to_itk(type));
      io->SetFileType(itk::IOFileEnum::Binary);
      io->SetByteOrder(itk::IOByteOrderEnum::LittleEndian);
      io->SetUseCompression(gzip);
      itk::ImageIORegion whole(3);
      for (int a = 0; a < 3; ++a) {
        io->SetDimensions(unsigned(a), itk::SizeValueType(grid.size[a]));
        io->SetSpacing(unsigned(a), grid.spacing[a]);
        io->SetOrigin(unsigned(a), grid.origin[a]);
        const glm::dvec3 axis = grid.direction[a];
        io->SetDirection(unsigned(a), std::vector<double>{axis.x, axis.y, axis.z});
        whole.SetSize(unsigned(a), itk::SizeValueType(grid.size[a]));
      }
      io->SetIORegion(whole);
      io->Write(voxels);
    } catch (const itk::ExceptionObject&) {
      throw InputError(file.string(), "", "it cannot be written", "check the folder's permissions and free space");
    }
  });
}

}  // namespace insonate
