#include "sim/volume/dicom_series.h"

#include <gdcmAttribute.h>
#include <gdcmImageHelper.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmScanner.h>
#include <gdcmTrace.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/volume/dicom_image.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

// Positions are decimal text, rounded by some scanners to 0.1 mm. A missing slice doubles a gap.
constexpr double kUnevenShare = 0.1;
// How far the stack may lean, and a slice may be shifted sideways. Within it, no voxel is off by more than a thin
// slice.
constexpr double kMaxLean_mm = 1;
// Directions are decimal text of at most 16 characters; anonymisers and converters keep 4 decimals or more.
constexpr double kUnitTolerance = 1e-3;
// Images whose normals differ by more than 60 degrees are not in one stack: a localizer is perpendicular to it.
constexpr double kSameWay = 0.5;

const gdcm::Tag kMediaStorage(0x0002, 0x0002), kSopClass(0x0008, 0x0016), kSopInstance(0x0008, 0x0018),
    kModality(0x0008, 0x0060), kDescription(0x0008, 0x103e), kSeries(0x0020, 0x000e), kSeriesNumber(0x0020, 0x0011),
    kPosition(0x0020, 0x0032), kOrientation(0x0020, 0x0037), kPhotometric(0x0028, 0x0004), kFrames(0x0028, 0x0008),
    kRows(0x0028, 0x0010), kColumns(0x0028, 0x0011), kPixelSpacing(0x0028, 0x0030), kIntercept(0x0028, 0x1052),
    kSlope(0x0028, 0x1053), kPixelTransformation(0x0028, 0x9145), kSharedGroups(0x5200, 0x9229),
    kFrameGroups(0x5200, 0x9230);

struct Slice {
  fs::path file;
  std::string instance;
  glm::dvec3 position{0.0};
};

/// Images of one series that agree in size, orientation and pixel spacing.
struct Stack {
  std::string series, sop_class, number, description, modality, orientation, pixel_spacing;
  int columns = 0, rows = 0, frames = 1;
  bool placed = true;  ///< its slices state their positions
  std::vector<Slice> slices;

  std::string size() const { return std::to_string(columns) + " x " + std::to_string(rows); }
  std::string name() const {
    std::string text = "series " + (number.empty() ? "?" : number);
    if (!description.empty()) text += " '" + description + "'";
    return text + " (" + (modality.empty() ? "no modality" : modality) + ", " + std::to_string(slices.size()) +
           " images of " + size() + ")";
  }

  bool is_enhanced() const {
    const auto kind = gdcm::MediaStorage::GetMSType(sop_class.c_str());
    return kind == gdcm::MediaStorage::EnhancedCTImageStorage ||
           kind == gdcm::MediaStorage::LegacyConvertedEnhancedCTImageStorage;
  }
  // Series without a modality come from anonymisers, modality OT from converters.
  bool may_be_ct() const { return modality == "CT" || modality.empty() || modality == "OT"; }
  bool is_ct() const { return may_be_ct() && frames == 1 && placed; }
};

/// The content of a folder: stacks, the largest first, and files that are not DICOM.
struct Contents {
  std::vector<Stack> stacks;
  std::vector<fs::path> others;
};

std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c > 126; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

/// Parses DICOM's decimal strings, separated by backslashes. Returns nothing if there are not `count` finite ones.
std::vector<double> decimals(const std::string& text, std::size_t count) {
  std::vector<double> values;
  const char* at = text.c_str();
  while (*at) {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at || !std::isfinite(value)) return {};
    values.push_back(value);
    at = end;
    while (*at == ' ') ++at;
    if (*at == '\\') ++at;
  }
  return values.size() == count ? values : std::vector<double>{};
}

/// Returns one text for the same numbers, however they are written, and any other text unchanged.
std::string same_text(const std::string& text, std::size_t count) {
  std::string all;
  for (const double value : decimals(text, count)) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.4f", all.empty() ? "" : "\\", std::round(value * 1e4) / 1e4 + 0.0);
    all += number;
  }
  return all.empty() ? text : all;
}

struct Axes {
  glm::dvec3 row, column;
  glm::dvec3 normal() const { return glm::cross(row, column); }
};

/// Returns the two directions of an image; nothing if they are not perpendicular or not of length 1.
std::optional<Axes> axes_of(const std::string& orientation) {
  const auto o = decimals(orientation, 6);
  if (o.empty()) return std::nullopt;
  const Axes axes{{o[0], o[1], o[2]}, {o[3], o[4], o[5]}};
  const double worst = std::max({std::abs(glm::length(axes.row) - 1), std::abs(glm::length(axes.column) - 1),
                                 std::abs(glm::dot(axes.row, axes.column))});
  return worst <= kUnitTolerance ? std::optional(axes) : std::nullopt;
}

/// Returns a silent GDCM scanner for the tags that this file uses.
gdcm::SmartPointer<gdcm::Scanner> make_scanner() {
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  const auto scanner = gdcm::Scanner::New();
  for (const gdcm::Tag& tag : {kMediaStorage, kSopClass, kSopInstance, kModality, kDescription, kSeries, kSeriesNumber,
                               kPosition, kOrientation, kFrames, kRows, kColumns, kPixelSpacing})
    scanner->AddTag(tag);
  return scanner;
}

const char* const kCopyAgain = "copy the series again, or take the file out of the folder";

/// Sorts the images of a folder into stacks. Skips reports and directories, which are DICOM without an image. Refuses
/// damaged files.
Contents contents_of(const fs::path& folder) {
  const std::vector<std::string> files = files_below(folder);
  const auto scanner = make_scanner();
  scanner->Scan(files);

  Contents contents;
  std::map<std::string, Stack> stacks;
  for (const std::string& file : files) {
    const auto value = [&](const gdcm::Tag& tag) {
      const char* text = scanner->GetValue(file.c_str(), tag);
      return text ? printable(text) : std::string();
    };
    const auto refuse_as_cut = [&] {
      throw InputError(file, "header", "the DICOM file is damaged or cut off before its image", kCopyAgain);
    };
    const bool has_mark = is_dicom_file(file);
    if (!scanner->IsKey(file.c_str())) {
      if (has_mark) refuse_as_cut();
      contents.others.push_back(file);
      continue;
    }
    const std::string sop_class = value(kSopClass).empty() ? value(kMediaStorage) : value(kSopClass);
    const int columns = std::atoi(value(kColumns).c_str()), rows = std::atoi(value(kRows).c_str());
    if (columns <= 0 || rows <= 0) {
      const auto kind = gdcm::MediaStorage::GetMSType(sop_class.c_str());
      if (has_mark && (sop_class.empty() || gdcm::MediaStorage::IsImage(kind))) refuse_as_cut();
      continue;
    }
    const int frames = std::max(1, std::atoi(value(kFrames).c_str()));
    const auto p = decimals(value(kPosition), 3);
    std::string key;
    for (const std::string& part : {value(kSeries), std::to_string(columns), std::to_string(rows),
                                    same_text(value(kOrientation), 6), same_text(value(kPixelSpacing), 2),
                                    std::string(frames > 1 ? "frames" : ""), std::string(p.empty() ? "" : "placed")})
      key += part + "|";
    Stack& stack = stacks[key];
    stack.series = value(kSeries);
    stack.sop_class = sop_class;
    stack.number = value(kSeriesNumber);
    stack.description = value(kDescription);
    stack.modality = value(kModality);
    stack.orientation = value(kOrientation);
    stack.pixel_spacing = value(kPixelSpacing);
    stack.columns = columns;
    stack.rows = rows;
    stack.frames = std::max(stack.frames, frames);
    stack.placed = !p.empty();
    stack.slices.push_back({file, value(kSopInstance), p.empty() ? glm::dvec3(0.0) : glm::dvec3(p[0], p[1], p[2])});
  }
  for (auto& [key, stack] : stacks) contents.stacks.push_back(std::move(stack));
  // The most slices first; ties by identifier, so that the choice is always the same.
  std::stable_sort(contents.stacks.begin(), contents.stacks.end(),
                   [](const Stack& a, const Stack& b) { return a.slices.size() > b.slices.size(); });
  return contents;
}

/// Returns a file's name without decimal or hexadecimal digits, which number the files of a series.
std::string unnumbered(const fs::path& file) {
  std::string name = file.filename().string();
  std::erase_if(name, [](unsigned char c) { return std::isxdigit(c); });
  return name;
}

/// Refuses a file that is not DICOM but is named like the stack's files and lies among them: it is a lost image.
void check_for_lost_files(const Stack& stack, const std::vector<fs::path>& others) {
  std::set<std::pair<fs::path, std::string>> names;
  for (const Slice& slice : stack.slices) {
    names.emplace(slice.file.parent_path(), unnumbered(slice.file));
    if (slice.file.has_extension()) names.emplace(slice.file.parent_path(), slice.file.extension().string());
  }
  for (const fs::path& file : others) {
    const fs::path folder = file.parent_path();
    // Names with a leading dot are metadata of an operating system, such as macOS writes on foreign disks.
    if (file.filename().string().front() == '.') continue;
    if (!names.count({folder, unnumbered(file)}) && !names.count({folder, file.extension().string()})) continue;
    std::error_code error;
    const bool empty = fs::file_size(file, error) == 0;
    throw InputError(file.string(), "",
                     std::string(empty ? "the file is empty" : "this is not a DICOM file") +
                         ", but it is named like the images of " + stack.name(),
                     kCopyAgain);
  }
}

std::string millimetres(double value) {
  return formatted("%.4g mm", value);
}

std::string or_none(const std::string& text) {
  return text.empty() ? "missing" : text;
}

double middle_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Refuses an image of the stack's series that is not in the stack but fills a gap in it.
void check_for_strays(const Stack& stack, const Axes& axes, double gap, const std::vector<Stack>& all) {
  const auto height = [&](const Slice& slice) { return glm::dot(slice.position, axes.normal()); };
  const auto fills_a_gap = [&](const Slice& stray) {
    const double h = height(stray);
    if (h < height(stack.slices.front()) - 1.5 * gap || h > height(stack.slices.back()) + 1.5 * gap) return false;
    return std::none_of(stack.slices.begin(), stack.slices.end(),
                        [&](const Slice& slice) { return std::abs(height(slice) - h) < 0.5 * gap; });
  };
  for (const Stack& other : all) {
    if (other.series != stack.series || other.sop_class != stack.sop_class || other.frames > 1) continue;
    if (&other == &stack) continue;
    const auto refuse = [&](const Slice& stray, const std::string& problem) {
      throw InputError(stray.file.string(), "header", problem, kCopyAgain);
    };
    const std::string rest = " in the rest of " + stack.name();
    const auto others_axes = axes_of(other.orientation);
    if (!others_axes)
      refuse(other.slices.front(),
             "its orientation is " + or_none(other.orientation) + ", and " + stack.orientation + rest);
    if (std::abs(glm::dot(others_axes->normal(), axes.normal())) < kSameWay) continue;
    if (!other.placed)
      refuse(other.slices.front(), "it does not give its position, as the rest of " + stack.name() + " does");
    const auto stray = std::find_if(other.slices.begin(), other.slices.end(), fills_a_gap);
    if (stray == other.slices.end()) continue;
    if (other.size() != stack.size()) refuse(*stray, "its size is " + other.size() + ", and " + stack.size() + rest);
    if (same_text(other.orientation, 6) != same_text(stack.orientation, 6))
      refuse(*stray, "its orientation is " + other.orientation + ", and " + stack.orientation + rest);
    refuse(*stray, "its pixel spacing is " + or_none(other.pixel_spacing) + ", and " + stack.pixel_spacing + rest);
  }
}

/// Sorts the stack's slices along its normal and returns the grid they fill.
Grid ordered(const std::string& folder, Stack& stack, const std::vector<Stack>& all) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw InputError(folder, stack.name(), problem, remedy);
  };
  Grid grid;
  const auto axes = axes_of(stack.orientation);
  const auto spacing = decimals(stack.pixel_spacing, 2);
  if (!axes)
    refuse("the orientation of the slices is " + or_none(stack.orientation) +
               ", which is not two perpendicular directions of length 1",
           "export the series again");
  if (spacing.empty()) refuse("the slices do not give their pixel spacing", "export the series again");
  const glm::dvec3 normal = axes->normal();
  grid.direction = glm::dmat3(axes->row, axes->column, normal);
  grid.spacing = {spacing[1], spacing[0], 1};  // DICOM gives the distance between rows first, then between columns

  auto& slices = stack.slices;
  std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
    return glm::dot(a.position, normal) < glm::dot(b.position, normal);
  });
  // Keep one of identical images, as in a folder that was copied into itself.
  slices.erase(
      std::unique(slices.begin(), slices.end(),
                  [](const Slice& a, const Slice& b) { return !a.instance.empty() && a.instance == b.instance; }),
      slices.end());
  check_size(folder, std::uint64_t(stack.columns), std::uint64_t(stack.rows), slices.size());
  grid.size = {stack.columns, stack.rows, int(slices.size())};
  grid.origin = slices.front().position;

  std::vector<double> gaps, along_rows, along_columns;
  for (std::size_t s = 1; s < slices.size(); ++s) {
    const glm::dvec3 step = slices[s].position - slices[s - 1].position;
    gaps.push_back(glm::dot(step, normal));
    along_rows.push_back(glm::dot(step, axes->row));
    along_columns.push_back(glm::dot(step, axes->column));
  }
  const double usual = middle_of(gaps);
  check_for_strays(stack, *axes, usual, all);
  const double aside_i = middle_of(along_rows), aside_j = middle_of(along_columns);
  for (std::size_t s = 0; s < gaps.size(); ++s) {
    const std::string where =
        "between " + slices[s].file.filename().string() + " and " + slices[s + 1].file.filename().string();
    if (gaps[s] < 1e-3) refuse("two slices lie at the same place, " + where, "keep one acquisition of the series");
    if (std::abs(gaps[s] - usual) > kUnevenShare * usual)
      refuse((gaps[s] > 1.5 * usual ? "slices are missing " : "the slices are unevenly spaced ") + where + ": " +
                 millimetres(gaps[s]) + " instead of " + millimetres(usual),
             "export the whole series again");
    if (const double off = std::hypot(along_rows[s] - aside_i, along_columns[s] - aside_j); off > kMaxLean_mm)
      refuse("the slices are shifted sideways by " + millimetres(off) + " " + where, "export the whole series again");
  }
  const double height = glm::dot(slices.back().position - slices.front().position, normal);
  if (const double lean = std::hypot(aside_i, aside_j) * double(gaps.size()); lean > kMaxLean_mm) {
    char angle[32];
    std::snprintf(angle, sizeof angle, "%.1f", glm::degrees(std::atan2(lean, height)));
    refuse(std::string("the gantry was tilted: the stack leans by ") + angle + " degrees",
           "resample it to upright slices");
  }
  grid.spacing.z = height / double(slices.size() - 1);
  return checked_grid(folder, grid);
}

/// Returns an element's text within the first items of nested sequences; empty if it does not exist.
std::string text_in(const gdcm::DataSet& data, const std::vector<gdcm::Tag>& sequences, const gdcm::Tag& tag) {
  std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>> opened;
  const gdcm::DataSet* within = &data;
  for (const gdcm::Tag& sequence : sequences) {
    if (!within->FindDataElement(sequence)) return "";
    opened.push_back(within->GetDataElement(sequence).GetValueAsSQ());
    if (!opened.back() || opened.back()->GetNumberOfItems() == 0) return "";
    within = &opened.back()->GetItem(1).GetNestedDataSet();
  }
  const gdcm::ByteValue* bytes = within->FindDataElement(tag) ? within->GetDataElement(tag).GetByteValue() : nullptr;
  return bytes ? printable(std::string(bytes->GetPointer(), bytes->GetLength())) : "";
}

/// Returns a rescale element's text: from the top level or, in an enhanced image, from its functional groups.
std::string rescale_text(const gdcm::DataSet& header, const gdcm::Tag& tag) {
  std::string text = text_in(header, {}, tag);
  for (const gdcm::Tag& groups : {kSharedGroups, kFrameGroups})
    if (text.empty()) text = text_in(header, {groups, kPixelTransformation}, tag);
  return text;
}

void check_values_are_hounsfield(const fs::path& file, const gdcm::File& dicom) {
  const gdcm::DataSet& header = dicom.GetDataSet();
  if (const std::string shown = text_in(header, {}, kPhotometric); shown != "MONOCHROME2")
    throw InputError(file.string(), "header",
                     "its photometric interpretation is " + or_none(shown) + ", where a CT has MONOCHROME2",
                     "export the original CT series");
  const std::string slope_text = rescale_text(header, kSlope), intercept_text = rescale_text(header, kIntercept);
  const auto slope = decimals(slope_text, 1), intercept = decimals(intercept_text, 1);
  if (slope.empty() || intercept.empty())
    throw InputError(file.string(), "header",
                     "its rescale slope is " + or_none(slope_text) + " and its rescale intercept " +
                         or_none(intercept_text) + ", so its values are not known in Hounsfield units",
                     "export the original CT series");
  check_rescale(file.string(), "rescale slope", slope[0], "rescale intercept", intercept[0]);
  // read_dicom_image() applies the numbers that GDCM finds where the kind of image should have them.
  const std::vector<double> applied = gdcm::ImageHelper::GetRescaleInterceptSlopeValue(dicom);
  if (applied != std::vector<double>{intercept[0], slope[0]})
    throw InputError(file.string(), "header",
                     "its rescale slope and intercept are not where its kind of image has them",
                     "export the original CT series");
}

}  // namespace

std::vector<std::string> files_below(const fs::path& folder, std::size_t most) {
  std::vector<std::string> files;
  std::error_code error;
  constexpr auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, options, error), end; at != end && !error; at.increment(error)) {
    std::error_code ignored;
    if (at->is_regular_file(ignored)) files.push_back(at->path().string());
    if (files.size() > most)
      throw InputError(folder.string(), "", "there are more than " + std::to_string(most) + " files below it",
                       "name the folder of one study");
  }
  if (error)
    throw InputError(folder.string(), "", "the folder cannot be read (" + error.message() + ")",
                     "check its permissions");
  std::sort(files.begin(), files.end());
  return files;
}

bool is_dicom_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char start[132] = {};
  return stream.read(start, sizeof start) && std::string_view(start + 128, 4) == "DICM";
}

void check_dicom_slice(const fs::path& file) {
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read())
    throw InputError(file.string(), "header", "the DICOM file is damaged or cut off", "export the series again");
  check_values_are_hounsfield(file, reader.GetFile());
  // Compressed voxels that end early do not decode. GDCM invents the rest of raw ones.
  const gdcm::TransferSyntax syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  if (syntax.IsEncapsulated()) return;
  const bool big_endian = syntax == gdcm::TransferSyntax::ExplicitVRBigEndian;
  gdcm::Attribute<0x0028, 0x0010> rows{};
  gdcm::Attribute<0x0028, 0x0011> columns{};
  gdcm::Attribute<0x0028, 0x0100> bits{};
  const gdcm::DataSet& header = reader.GetFile().GetDataSet();
  rows.SetFromDataSet(header);
  columns.SetFromDataSet(header);
  bits.SetFromDataSet(header);
  const std::uint64_t needed = std::uint64_t(rows.GetValue()) * columns.GetValue() * bits.GetValue() / 8;
  check_raw_pixels(file, needed, big_endian);
}

void scan_dicom_file(const fs::path& file) {
  make_scanner()->Scan({file.string()});
}

DicomSeries find_dicom_series(const fs::path& folder) {
  const std::string name = folder.string();
  Contents contents = contents_of(folder);
  std::vector<Stack>& stacks = contents.stacks;
  if (stacks.empty()) throw InputError(name, "", "there are no DICOM images in this folder", "name the folder of a CT");
  const auto chosen = std::find_if(stacks.begin(), stacks.end(), [](const Stack& stack) { return stack.is_ct(); });
  if (chosen == stacks.end()) {
    const Stack& largest = stacks.front();
    if (!largest.may_be_ct()) throw InputError(name, largest.name(), "this is not a CT", "name the folder of a CT");
    if (largest.frames > 1 || largest.is_enhanced())
      throw InputError(name, largest.name(), "these are enhanced images, which may hold several slices per file",
                       "convert them to plain CT images, one slice per file");
    throw InputError(name, largest.name(), "the images do not give their positions", "export the original CT series");
  }
  check_for_lost_files(*chosen, contents.others);
  DicomSeries series;
  series.grid = ordered(name, *chosen, stacks);
  for (const Slice& slice : chosen->slices) series.slices.push_back(slice.file);
  for (auto stack = stacks.begin(); stack != stacks.end(); ++stack)
    if (stack != chosen) series.other_series.push_back(stack->name());
  return series;
}

}  // namespace insonate
