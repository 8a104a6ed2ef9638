#include "tests/volume/dicom_files.h"

#include <gdcmAttribute.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageWriter.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>
#include <gdcmWriter.h>

#include <cstring>
#include <functional>
#include <stdexcept>

namespace insonate {
namespace {

void must(bool done, const char* what) {
  if (!done) throw std::runtime_error(std::string("GDCM cannot ") + what);
}

gdcm::TransferSyntax::TSType transfer_syntax(DicomCoding coding) {
  switch (coding) {
    case DicomCoding::raw:
      break;
    case DicomCoding::jpeg:
      return gdcm::TransferSyntax::JPEGLosslessProcess14_1;
    case DicomCoding::jpeg_ls:
      return gdcm::TransferSyntax::JPEGLSLossless;
    case DicomCoding::jpeg_2000:
      return gdcm::TransferSyntax::JPEG2000Lossless;
    case DicomCoding::rle:
      return gdcm::TransferSyntax::RLELossless;
    case DicomCoding::big_endian:
      return gdcm::TransferSyntax::ExplicitVRBigEndian;
  }
  return gdcm::TransferSyntax::ExplicitVRLittleEndian;
}

template <std::uint16_t group, std::uint16_t element>
void set_text(gdcm::DataSet& data, const std::string& text) {
  gdcm::Attribute<group, element> attribute;
  attribute.SetValue(text);
  data.Replace(attribute.GetAsDataElement());
}

template <std::uint16_t group, std::uint16_t element, typename Number>
void set_number(gdcm::DataSet& data, Number number) {
  gdcm::Attribute<group, element> attribute;
  attribute.SetValue(number);
  data.Replace(attribute.GetAsDataElement());
}

void changed_file(const std::filesystem::path& file, const std::function<void(gdcm::File&)>& change) {
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  must(reader.Read(), "read");
  change(reader.GetFile());
  gdcm::Writer writer;
  writer.SetFile(reader.GetFile());
  writer.SetFileName(file.c_str());
  writer.CheckFileMetaInformationOff();
  must(writer.Write(), "write");
}

void changed(const std::filesystem::path& file, const std::function<void(gdcm::DataSet&)>& change) {
  changed_file(file, [&](gdcm::File& dicom) { change(dicom.GetDataSet()); });
}

gdcm::DataElement sequence_of(const gdcm::Tag& tag, const std::vector<gdcm::DataSet>& sets) {
  gdcm::SmartPointer<gdcm::SequenceOfItems> items = new gdcm::SequenceOfItems;
  items->SetLengthToUndefined();
  for (const gdcm::DataSet& set : sets) {
    gdcm::Item item;
    item.SetVLToUndefined();
    item.SetNestedDataSet(set);
    items->AddItem(item);
  }
  gdcm::DataElement sequence(tag);
  sequence.SetVR(gdcm::VR::SQ);
  sequence.SetValue(*items);
  sequence.SetVLToUndefined();
  return sequence;
}

}  // namespace

void write_dicom(const std::filesystem::path& file, const DicomSlice& slice) {
  gdcm::SmartPointer<gdcm::Image> image = new gdcm::Image;
  image->SetNumberOfDimensions(2);
  image->SetDimension(0, unsigned(slice.columns));
  image->SetDimension(1, unsigned(slice.rows));
  image->SetPixelFormat(gdcm::PixelFormat::UINT16);
  image->SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image->SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  image->SetSpacing(0, slice.between_columns_mm);
  image->SetSpacing(1, slice.between_rows_mm);
  for (unsigned a = 0; a < 3; ++a) image->SetOrigin(a, slice.position[a]);
  image->SetDirectionCosines(slice.orientation.data());
  image->SetSlope(slice.slope);
  image->SetIntercept(slice.intercept);
  std::string bytes(slice.stored.size() * 2, '\0');
  std::memcpy(bytes.data(), slice.stored.data(), bytes.size());
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetByteValue(bytes.data(), std::uint32_t(bytes.size()));
  image->SetDataElement(pixels);

  gdcm::ImageWriter writer;
  writer.SetImage(*image);
  if (slice.coding != DicomCoding::raw) {
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(transfer_syntax(slice.coding));
    change.SetInput(*image);
    must(change.Change(), "compress");
    writer.SetImage(change.GetOutput());
  }
  gdcm::DataSet& data = writer.GetFile().GetDataSet();
  const std::string instance = slice.instance.empty()
                                   ? slice.series + "." + std::to_string(int(slice.position[2] * 1000) + 1000000) +
                                         "." + std::to_string(int(slice.position[1] * 1000) + 1000000)
                                   : slice.instance;
  const bool is_ct = slice.modality == "CT";
  set_text<0x0008, 0x0016>(data, is_ct ? "1.2.840.10008.5.1.4.1.1.2" : "1.2.840.10008.5.1.4.1.1.4");  // CT, MR
  set_text<0x0008, 0x0018>(data, instance);
  set_text<0x0008, 0x0060>(data, slice.modality);
  set_text<0x0008, 0x103e>(data, slice.description);
  set_text<0x0020, 0x000e>(data, slice.series);
  gdcm::Attribute<0x0020, 0x0011> number;
  number.SetValue(std::stoi(slice.series_number));
  data.Replace(number.GetAsDataElement());
  writer.SetFileName(file.c_str());
  must(writer.Write(), "write");
}

void write_dicom_clip(const std::filesystem::path& file, const DicomClip& clip) {
  gdcm::Trace::WarningOff();
  using Photometric = gdcm::PhotometricInterpretation;
  gdcm::SmartPointer<gdcm::Image> image = new gdcm::Image;
  image->SetNumberOfDimensions(3);
  const int sides[] = {clip.columns, clip.rows, clip.frames};
  for (unsigned axis = 0; axis < 3; ++axis) image->SetDimension(axis, unsigned(sides[axis]));
  gdcm::PixelFormat format(gdcm::PixelFormat::UINT8);
  const bool is_colour = clip.colours != DicomColours::grey && clip.colours != DicomColours::palette;
  format.SetSamplesPerPixel(is_colour ? 3 : 1);
  image->SetPhotometricInterpretation(clip.colours == DicomColours::grey      ? Photometric::MONOCHROME2
                                      : clip.colours == DicomColours::palette ? Photometric::PALETTE_COLOR
                                      : clip.colours == DicomColours::ybr     ? Photometric::YBR_FULL
                                                                              : Photometric::RGB);
  image->SetPixelFormat(format);
  image->SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  // GDCM writes the spacing over that of the only region.
  if (clip.regions.size() == 1) {
    image->SetSpacing(0, clip.regions[0].across_cm);
    image->SetSpacing(1, clip.regions[0].down_cm);
  }
  std::string bytes(clip.stored.begin(), clip.stored.end());
  if (clip.colours == DicomColours::rgb_planes) {
    image->SetPlanarConfiguration(1);
    const std::size_t of_image = std::size_t(clip.columns) * std::size_t(clip.rows);
    for (std::size_t i = 0; i < bytes.size() / 3; ++i)
      for (std::size_t sample = 0; sample < 3; ++sample)
        bytes[i / of_image * 3 * of_image + sample * of_image + i % of_image] = char(clip.stored[3 * i + sample]);
  }
  if (clip.colours == DicomColours::palette) {
    gdcm::SmartPointer<gdcm::LookupTable> palette = new gdcm::LookupTable;
    palette->Allocate(8);
    // Entries of 16 bits, little endian, with the colour in the upper byte.
    std::array<std::array<unsigned char, 512>, 3> entries{};
    for (unsigned n = 0; n < 256; ++n) {
      entries[0][2 * n + 1] = static_cast<unsigned char>(255 - n);
      entries[1][2 * n + 1] = static_cast<unsigned char>(n);
      entries[2][2 * n + 1] = 7;
    }
    const gdcm::LookupTable::LookupTableType colours[] = {gdcm::LookupTable::RED, gdcm::LookupTable::GREEN,
                                                          gdcm::LookupTable::BLUE};
    for (std::size_t colour = 0; colour < 3; ++colour) {
      palette->InitializeLUT(colours[colour], 256, 0, 16);
      palette->SetLUT(colours[colour], entries[colour].data(), 512);
    }
    image->SetLUT(*palette);
  }
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetVR(gdcm::VR::OB);
  pixels.SetByteValue(bytes.data(), std::uint32_t(bytes.size()));
  image->SetDataElement(pixels);
  gdcm::ImageWriter writer;
  writer.SetImage(*image);
  if (clip.coding != DicomCoding::raw) {
    gdcm::ImageChangeTransferSyntax change;
    change.SetTransferSyntax(transfer_syntax(clip.coding));
    change.SetInput(*image);
    must(change.Change(), "compress");
    writer.SetImage(change.GetOutput());
  }
  gdcm::DataSet& data = writer.GetFile().GetDataSet();
  set_text<0x0008, 0x0016>(data, "1.2.840.10008.5.1.4.1.1.3.1");  // ultrasound, multi-frame
  set_text<0x0008, 0x0018>(data, "1.2.3.4.5");
  set_text<0x0008, 0x0060>(data, "US");
  std::vector<gdcm::DataSet> regions;
  for (const DicomRegion& region : clip.regions) {
    gdcm::DataSet& of_region = regions.emplace_back();
    set_number<0x0018, 0x6012>(of_region, region.spatial_format);
    set_number<0x0018, 0x6014>(of_region, region.data_type);
    set_number<0x0018, 0x6018>(of_region, region.left);
    set_number<0x0018, 0x601a>(of_region, region.top);
    set_number<0x0018, 0x601c>(of_region, region.right);
    set_number<0x0018, 0x601e>(of_region, region.bottom);
    set_number<0x0018, 0x6024>(of_region, region.units);
    set_number<0x0018, 0x6026>(of_region, region.units);
    set_number<0x0018, 0x602c>(of_region, region.across_cm);
    set_number<0x0018, 0x602e>(of_region, region.down_cm);
  }
  if (!regions.empty()) data.Replace(sequence_of({0x0018, 0x6011}, regions));
  writer.SetFileName(file.c_str());
  must(writer.Write(), "write");
}

void set_tag(const std::filesystem::path& file, std::uint16_t group, std::uint16_t element, const std::string& bytes) {
  changed(file, [&](gdcm::DataSet& data) {
    must(data.FindDataElement(gdcm::Tag(group, element)), "find the element");
    gdcm::DataElement changed_element = data.GetDataElement(gdcm::Tag(group, element));
    const std::string even = bytes + std::string(bytes.size() % 2, ' ');
    changed_element.SetByteValue(even.data(), std::uint32_t(even.size()));
    data.Replace(changed_element);
  });
}

void set_kind(const std::filesystem::path& file, const std::string& sop_class) {
  changed_file(file, [&](gdcm::File& dicom) {
    set_text<0x0008, 0x0016>(dicom.GetDataSet(), sop_class);
    set_text<0x0002, 0x0002>(dicom.GetHeader(), sop_class);
  });
}

void remove_tag(const std::filesystem::path& file, std::uint16_t group, std::uint16_t element) {
  changed(file, [&](gdcm::DataSet& data) { data.Remove(gdcm::Tag(group, element)); });
}

void move_rescale(const std::filesystem::path& file, std::uint16_t groups) {
  changed(file, [&](gdcm::DataSet& data) {
    gdcm::DataSet rescale;
    for (const gdcm::Tag& tag : {gdcm::Tag(0x0028, 0x1052), gdcm::Tag(0x0028, 0x1053)}) {
      rescale.Insert(data.GetDataElement(tag));
      data.Remove(tag);
    }
    gdcm::DataSet group;
    group.Insert(sequence_of({0x0028, 0x9145}, {rescale}));
    data.Insert(sequence_of({0x5200, groups}, {group}));
  });
}

}  // namespace insonate
