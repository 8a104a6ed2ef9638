#include "sim/volume/dicom_series.h"

#include <gdcmAttribute.h>
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

#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 100000;

// Positions are decimal text, rounded by some scanners to 0.1 mm; a missing slice doubles a gap.
constexpr double kUnevenShare = 0.1;
// How far the stack may lean: within it, no voxel is off by more than a thin slice's thickness.
constexpr double kMostLeanMm = 1;

const gdcm::Tag kSopInstance(0x0008, 0x0018), kModality(0x0008, 0x0060), kDescription(0x0008, 0x103e),
    kSeries(0x0020, 0x000e), kSeriesNumber(0x0020, 0x0011), kPosition(0x0020, 0x0032), kOrientation(0x0020, 0x0037),
    kFrames(0x0028, 0x0008), kRows(0x0028, 0x0010), kColumns(0x0028, 0x0011), kPixelSpacing(0x0028, 0x0030);

struct Slice {
  fs::path file;
  std::string instance;
  glm::dvec3 position{0.0};
};

/// What belongs together: one series, one size, one orientation.
struct Stack {
  std::string number, description, modality, orientation, pixel_spacing;
  int columns = 0, rows = 0, frames = 1;
  bool placed = true;  ///< every slice says where it lies
  std::vector<Slice> slices;

  std::string name() const {
    std::string text = "series " + (number.empty() ? "?" : number);
    if (!description.empty()) text += " '" + description + "'";
    return text + " (" + (modality.empty() ? "no modality" : modality) + ", " + std::to_string(slices.size()) +
           " images of " + std::to_string(columns) + " x " + std::to_string(rows) + ")";
  }

  // Series without a modality come from anonymisers, OT from converters.
  bool may_be_ct() const { return modality == "CT" || modality.empty() || modality == "OT"; }
  bool is_ct() const { return may_be_ct() && frames == 1 && placed; }
};

std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c > 126; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

/// DICOM's decimal strings, separated by backslashes; empty when there are not `count` finite ones.
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

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  constexpr auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, options, error), end; at != end && !error; at.increment(error)) {
    std::error_code ignored;
    if (at->is_regular_file(ignored)) files.push_back(at->path().string());
    if (files.size() > kMostFiles)
      throw InputError(folder.string(), "", "there are more than " + std::to_string(kMostFiles) + " files below it",
                       "name the folder of one study");
  }
  if (error)
    throw InputError(folder.string(), "", "the folder cannot be read (" + error.message() + ")",
                     "check its permissions");
  std::sort(files.begin(), files.end());
  return files;
}

/// GDCM's scanner, silent, told which tags are wanted.
gdcm::SmartPointer<gdcm::Scanner> make_scanner() {
  gdcm::Trace::DebugOff();
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  const auto scanner = gdcm::Scanner::New();
  for (const gdcm::Tag& tag : {kSopInstance, kModality, kDescription, kSeries, kSeriesNumber, kPosition, kOrientation,
                               kFrames, kRows, kColumns, kPixelSpacing})
    scanner->AddTag(tag);
  return scanner;
}

/// Per series, size and orientation, its slices. Files that are no images are passed over, damaged ones are not.
std::vector<Stack> stacks_of(const fs::path& folder) {
  const std::vector<std::string> files = files_below(folder);
  const auto scanner = make_scanner();
  bool scanned = false;
  try {
    scanned = scanner->Scan(files);
  } catch (const std::exception&) {
  }
  if (!scanned && !files.empty())
    throw InputError(folder.string(), "", "its files cannot be read as DICOM", "export the series again");

  std::map<std::string, Stack> stacks;
  for (const std::string& file : files) {
    const auto value = [&](const gdcm::Tag& tag) {
      const char* text = scanner->GetValue(file.c_str(), tag);
      return text ? printable(text) : std::string();
    };
    if (!scanner->IsKey(file.c_str())) {
      if (is_dicom_file(file))
        throw InputError(file, "header", "the DICOM file is damaged", "export the series again, or remove the file");
      continue;
    }
    const int columns = std::atoi(value(kColumns).c_str()), rows = std::atoi(value(kRows).c_str());
    if (columns <= 0 || rows <= 0) continue;  // a report, a directory or the like
    const int frames = std::max(1, std::atoi(value(kFrames).c_str()));
    Stack& stack = stacks[value(kSeries) + "|" + std::to_string(columns) + "|" + std::to_string(rows) + "|" +
                          value(kOrientation) + "|" + (frames > 1 ? "frames" : "")];
    stack.number = value(kSeriesNumber);
    stack.description = value(kDescription);
    stack.modality = value(kModality);
    stack.orientation = value(kOrientation);
    if (!stack.slices.empty() && stack.pixel_spacing != value(kPixelSpacing))
      throw InputError(file, "header", "its pixel spacing differs from the rest of " + stack.name(),
                       "export the series again");
    stack.pixel_spacing = value(kPixelSpacing);
    stack.columns = columns;
    stack.rows = rows;
    stack.frames = std::max(stack.frames, frames);
    Slice slice{file, value(kSopInstance), {}};
    if (const auto p = decimals(value(kPosition), 3); !p.empty())
      slice.position = {p[0], p[1], p[2]};
    else
      stack.placed = false;
    stack.slices.push_back(slice);
  }
  std::vector<Stack> all;
  for (auto& [key, stack] : stacks) all.push_back(std::move(stack));
  // The most slices first; of equals the first by identifier, so that the choice is always the same.
  std::stable_sort(all.begin(), all.end(),
                   [](const Stack& a, const Stack& b) { return a.slices.size() > b.slices.size(); });
  return all;
}

std::string millimetres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g mm", value);
  return text;
}

/// Sorts the stack's slices along its normal and finds the grid they fill.
Grid ordered(const std::string& folder, Stack& stack) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw InputError(folder, stack.name(), problem, remedy);
  };
  Grid grid;
  const auto o = decimals(stack.orientation, 6);
  const auto spacing = decimals(stack.pixel_spacing, 2);
  if (o.empty()) refuse("the slices do not say how they are oriented", "export the series again");
  if (spacing.empty()) refuse("the slices do not say their pixel spacing", "export the series again");
  grid.direction[0] = {o[0], o[1], o[2]};
  grid.direction[1] = {o[3], o[4], o[5]};
  const glm::dvec3 normal = grid.direction[2] = glm::cross(grid.direction[0], grid.direction[1]);
  grid.spacing = {spacing[1], spacing[0], 1};  // DICOM: between rows first, then between columns

  auto& slices = stack.slices;
  std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) {
    return glm::dot(a.position, normal) < glm::dot(b.position, normal);
  });
  // The same image twice, as when a folder was copied into itself, is one image.
  slices.erase(
      std::unique(slices.begin(), slices.end(),
                  [](const Slice& a, const Slice& b) { return !a.instance.empty() && a.instance == b.instance; }),
      slices.end());
  check_size(folder, std::uint64_t(stack.columns), std::uint64_t(stack.rows), slices.size());
  grid.size = {stack.columns, stack.rows, int(slices.size())};
  grid.origin = slices.front().position;

  std::vector<double> gaps;
  for (std::size_t s = 1; s < slices.size(); ++s)
    gaps.push_back(glm::dot(slices[s].position - slices[s - 1].position, normal));
  std::vector<double> sorted = gaps;
  std::nth_element(sorted.begin(), sorted.begin() + std::ptrdiff_t(sorted.size() / 2), sorted.end());
  const double usual = sorted[sorted.size() / 2];
  for (std::size_t s = 0; s < gaps.size(); ++s) {
    const std::string where =
        "between " + slices[s].file.filename().string() + " and " + slices[s + 1].file.filename().string();
    if (gaps[s] < 1e-3) refuse("two slices lie at the same place, " + where, "keep one acquisition of the series");
    if (std::abs(gaps[s] - usual) > kUnevenShare * usual)
      refuse((gaps[s] > 1.5 * usual ? "slices are missing " : "the slices are unevenly spaced ") + where + ": " +
                 millimetres(gaps[s]) + " instead of " + millimetres(usual),
             "export the whole series again");
  }
  const glm::dvec3 run = slices.back().position - slices.front().position;
  const double height = glm::dot(run, normal);
  if (const double lean = glm::length(run - height * normal); lean > kMostLeanMm) {
    char angle[32];
    std::snprintf(angle, sizeof angle, "%.1f", glm::degrees(std::atan2(lean, height)));
    refuse(std::string("the gantry was tilted: the stack leans by ") + angle + " degrees",
           "resample it to upright slices");
  }
  grid.spacing.z = height / double(slices.size() - 1);
  return checked_grid(folder, grid);
}

}  // namespace

bool is_dicom_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  char start[132] = {};
  return stream.read(start, sizeof start) && std::string_view(start + 128, 4) == "DICM";
}

void check_dicom_voxels(const fs::path& file) {
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read()) throw InputError(file.string(), "header", "the DICOM file is damaged", "export the series again");
  // Compressed voxels that end early do not decode; of raw ones GDCM makes up the rest.
  const gdcm::TransferSyntax syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  if (syntax.IsEncapsulated() || syntax == gdcm::TransferSyntax::ExplicitVRBigEndian) return;
  gdcm::Attribute<0x0028, 0x0010> rows{};
  gdcm::Attribute<0x0028, 0x0011> columns{};
  gdcm::Attribute<0x0028, 0x0100> bits{};
  const gdcm::DataSet& header = reader.GetFile().GetDataSet();
  rows.SetFromDataSet(header);
  columns.SetFromDataSet(header);
  bits.SetFromDataSet(header);
  const std::uint64_t needed = std::uint64_t(rows.GetValue()) * columns.GetValue() * bits.GetValue() / 8;

  // The element (7fe0,0010) with the image's own length; an icon's, if there is one, has another.
  const std::string bytes = read_file(file);
  for (std::size_t at = 0; (at = bytes.find("\xe0\x7f\x10\x00", at, 4)) != std::string::npos; ++at) {
    const bool explicit_type = bytes.compare(at + 4, 2, "OW") == 0 || bytes.compare(at + 4, 2, "OB") == 0;
    const std::size_t length_at = at + (explicit_type ? 8 : 4);
    std::uint32_t length = 0;
    if (length_at + sizeof length > bytes.size()) break;
    std::memcpy(&length, bytes.data() + length_at, sizeof length);
    if (length != needed + needed % 2) continue;
    if (bytes.size() - length_at - sizeof length >= length) return;
    throw InputError(file.string(), "voxels", "the file ends before its image does", "export the series again");
  }
  throw InputError(file.string(), "voxels", "there are none of the size that the header tells",
                   "export the series again");
}

void scan_dicom_file(const fs::path& file) {
  make_scanner()->Scan({file.string()});
}

DicomSeries find_dicom_series(const fs::path& folder) {
  const std::string name = folder.string();
  std::vector<Stack> stacks = stacks_of(folder);
  if (stacks.empty()) throw InputError(name, "", "there are no DICOM images in this folder", "name the folder of a CT");
  const auto chosen = std::find_if(stacks.begin(), stacks.end(), [](const Stack& stack) { return stack.is_ct(); });
  if (chosen == stacks.end()) {
    const Stack& largest = stacks.front();
    if (!largest.may_be_ct()) throw InputError(name, largest.name(), "this is no CT", "name the folder of a CT");
    if (largest.frames > 1)
      throw InputError(name, largest.name(), "one file holds many frames", "convert it to one slice a file");
    throw InputError(name, largest.name(), "the images do not say where they lie", "export the original CT series");
  }
  DicomSeries series;
  series.grid = ordered(name, *chosen);
  for (const Slice& slice : chosen->slices) series.slices.push_back(slice.file);
  for (auto stack = stacks.begin(); stack != stacks.end(); ++stack)
    if (stack != chosen) series.other_series.push_back(stack->name());
  return series;
}

}  // namespace insonate
