// NRRD (https://teem.sourceforge.net/nrrd/format.html) and MetaImage (https://itk.org/Wiki/ITK/MetaIO/Documentation).
#include "sim/volume/text_volumes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <map>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/image_headers/metaimage_header.h"
#include "sim/image_headers/nrrd_header.h"
#include "sim/volume/byte_stream.h"
#include "sim/volume/volume_checks.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestHeader = 1u << 20;
const char* const kRightFile = "check that it is the right file";

// All fields that NRRD has, without the blanks in them.
constexpr std::string_view kNrrdFields =
    "axismaxs axismins blocksize byteskip centerings centers content datafile dimension encoding endian kinds labels "
    "lineskip max measurementframe min number oldmax oldmin sampleunits sizes space spacedimension spacedirections "
    "spaceorigin spaceunits spacings thicknesses type units";

[[noreturn]] void refuse(const fs::path& file, const std::string& problem, const std::string& remedy) {
  throw InputError(file.string(), "header", problem, remedy);
}

/// The fields of a header by name. The value of a field that is missing is empty.
struct Fields {
  std::map<std::string, std::string_view, std::less<>> values;

  bool has(std::string_view name) const { return !value(name).empty(); }
  std::string_view value(std::string_view name) const {
    const auto found = values.find(name);
    return found == values.end() ? std::string_view() : found->second;
  }
  /// Returns the value of the first of these synonymous fields that the header has.
  std::string_view any_value(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
      if (has(name)) return value(name);
    return {};
  }
};

/// Returns the first bytes of a file, which hold its header.
std::string front_of(const fs::path& file) {
  ByteStream stream(file, 0, false);
  std::error_code error;
  std::string bytes(std::min<std::uintmax_t>(kLongestHeader, fs::file_size(file, error)), '\0');
  bytes.resize(stream.read(bytes.data(), bytes.size()));
  if (bytes.size() == kLongestHeader) bytes.resize(bytes.rfind('\n') + 1);  // the last line may be cut
  return bytes;
}

/// Returns the numbers in a text; nothing if there are not `count` finite ones.
std::vector<double> finite_numbers(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  for (const std::string_view word : words(text)) {
    numbers.push_back(to_number<double>(word).value_or(NAN));
    if (!std::isfinite(numbers.back())) return {};
  }
  return numbers.size() == count ? numbers : std::vector<double>{};
}

glm::dvec3 to_vector(const std::vector<double>& three) {
  return {three[0], three[1], three[2]};
}

/// Returns the vectors in a text such as "(1,0,0) (0,1,0)"; nothing if there are not `count` of three finite numbers.
std::vector<glm::dvec3> vectors_in(std::string_view text, std::size_t count) {
  std::vector<glm::dvec3> vectors;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t end = text.find(')');
    if (text.front() != '(' || end == std::string_view::npos) return {};
    std::string inside(text.substr(1, end - 1));
    std::replace(inside.begin(), inside.end(), ',', ' ');
    const auto numbers = finite_numbers(inside, 3);
    if (numbers.empty()) return {};
    vectors.push_back(to_vector(numbers));
    text.remove_prefix(end + 1);
  }
  return vectors.size() == count ? vectors : std::vector<glm::dvec3>{};
}

glm::ivec3 three_sizes(const fs::path& file, std::string_view dimensions, std::string_view sizes) {
  if (dimensions != "3") refuse(file, "the image has " + quoted(dimensions) + " dimensions", "give a volume of 3");
  std::vector<std::uint64_t> numbers;
  for (const std::string_view word : words(sizes)) {
    const auto number = to_number<std::uint64_t>(word);
    if (!number) numbers.clear();
    if (!number) break;
    numbers.push_back(*number);
  }
  if (numbers.size() != 3) refuse(file, "the sizes are " + quoted(sizes), "give three whole numbers");
  check_size(file.string(), numbers[0], numbers[1], numbers[2]);
  return glm::ivec3(numbers[0], numbers[1], numbers[2]);
}

/// Sets the place of the voxels: behind the header, or in the one file that it names. Files can also name several.
void set_place(const fs::path& file, std::string_view data_file, std::size_t header_bytes, VoxelData& data) {
  data.file = file;
  data.offset = header_bytes;
  if (data_file.empty()) return;
  if (lower_case(data_file).starts_with("list") || data_file.find_first_of("% ") != std::string_view::npos)
    refuse(file, "the voxels lie in several files", "save them in one");
  data.file = file.parent_path() / data_file;
  data.offset = 0;
}

// ---------------------------------------------------------------------------------------------------------------------
// NRRD

/// Returns the fields by their names in lower case and without blanks, which are optional in most names.
Fields nrrd_fields(const fs::path& file, std::string_view bytes, std::size_t& header_bytes) {
  Fields fields;
  const std::string file_name = file.string();
  const auto known = words(kNrrdFields);
  const auto keep = [&](std::string_view name, std::string_view value, std::size_t line) {
    std::string plain = lower_case(name);
    std::erase(plain, ' ');
    const auto fail = [&](const std::string& problem, const std::string& remedy) {
      throw InputError(file_name, "line " + std::to_string(line), quoted(name) + problem, remedy);
    };
    if (std::find(known.begin(), known.end(), plain) == known.end())
      fail(" is not a field of NRRD", "correct it, or write ':=' behind it to make it a key of your own");
    if (!fields.values.emplace(plain, value).second) fail(" is given a second time", "remove one of the two lines");
  };
  header_bytes = read_nrrd_header(bytes, file_name, kRightFile, keep, [](auto...) {});
  return fields;
}

/// Refuses units of length other than mm. `units` holds texts in quotation marks, or nothing.
void check_nrrd_units(const fs::path& file, std::string_view units) {
  for (std::size_t begin; (begin = units.find('"')) != std::string_view::npos;) {
    units.remove_prefix(begin + 1);
    const std::string_view unit = units.substr(0, units.find('"'));
    units.remove_prefix(std::min(unit.size() + 1, units.size()));
    if (!unit.empty() && unit != "mm") refuse(file, "its unit of length is " + quoted(unit), "save it in mm");
  }
}

void check_nrrd_kinds(const fs::path& file, std::string_view kinds) {
  if (kinds.empty()) return;
  const auto each = words(kinds);
  const bool in_space = std::all_of(each.begin(), each.end(), [](std::string_view kind) {
    const std::string lower = lower_case(kind);
    return lower == "domain" || lower == "space" || lower == "time" || lower == "none" || lower == "???";
  });
  if (!in_space || each.size() != 3)
    refuse(file, "the kinds are " + quoted(kinds) + ", where each of the 3 axes of a volume is a domain",
           "give a 3D volume with one number a voxel");
}

/// Returns the signs that turn the space's axes into LPS.
glm::dvec3 lps_from_space(const fs::path& file, const Fields& fields) {
  const std::string_view space = fields.value("space");
  std::string plain = lower_case(space);
  std::erase_if(plain, [](char c) { return c == ' ' || c == '-'; });
  if (plain == "ras" || plain == "rightanteriorsuperior") return {-1, -1, 1};
  if (plain == "las" || plain == "leftanteriorsuperior") return {-1, 1, 1};
  for (const char* same : {"lps", "leftposteriorsuperior", "scannerxyz", "3drighthanded", "3dlefthanded"})
    if (plain == same) return glm::dvec3(1);
  if (space.empty() && fields.value("spacedimension") == "3") return glm::dvec3(1);
  refuse(file, space.empty() ? "it gives space directions and no space" : "the space is " + quoted(space),
         "write: space: left-posterior-superior");
}

void place_nrrd(const fs::path& file, const Fields& fields, Grid& grid) {
  check_nrrd_units(file, fields.value("spaceunits"));
  check_nrrd_units(file, fields.value("units"));
  check_nrrd_kinds(file, fields.value("kinds"));
  const std::string_view directions = fields.value("spacedirections"), spacings = fields.value("spacings");
  const auto spacing = finite_numbers(spacings, 3);
  if (!directions.empty()) {
    const glm::dvec3 signs = lps_from_space(file, fields);
    const auto axes = vectors_in(directions, 3);
    if (axes.empty())
      refuse(file, "the space directions are " + quoted(directions), "give three vectors of three numbers");
    // Writers may leave these fields with NaN in them.
    for (const auto& [name, shown] :
         {std::pair("spacings", "spacings"), std::pair("axismins", "axis mins"), std::pair("axismaxs", "axis maxs")})
      if (!finite_numbers(fields.value(name), 3).empty())
        refuse(file, std::string("it gives ") + shown + " beside the space directions",
               std::string("remove the line with the ") + shown);
    for (int a = 0; a < 3; ++a) {
      const glm::dvec3& axis = axes[std::size_t(a)];
      grid.spacing[a] = glm::length(axis);
      grid.direction[a] = signs * (1 / grid.spacing[a] * axis);
    }
    check_positive_spacing(file.string(), grid.spacing, "correct the space directions");
    if (const std::string_view origin = fields.value("spaceorigin"); !origin.empty()) {
      const auto vector = vectors_in(origin, 1);
      if (vector.empty()) refuse(file, "the space origin is " + quoted(origin), "give one vector of three numbers");
      grid.origin = signs * vector[0];
    }
    return;
  }
  if (spacing.empty())
    refuse(file, spacings.empty() ? "it gives no spacing" : "the spacings are " + quoted(spacings),
           "add the space directions");
  grid.spacing = to_vector(spacing);
  check_positive_spacing(file.string(), grid.spacing, "correct the spacings");
  if (fields.has("space") || fields.has("spacedimension") || fields.has("spaceorigin"))
    refuse(file, "it gives a space and no directions in it", "replace the spacings by space directions");
  const std::string_view least = fields.value("axismins");
  if (least.empty()) return;
  const auto from = finite_numbers(least, 3);
  if (from.empty()) refuse(file, "the axis mins are " + quoted(least), "give three numbers");
  // An axis begins at the centre of its first voxel if its samples are nodes, and at the voxel's border otherwise.
  const auto centers = words(fields.any_value({"centers", "centerings"}));
  for (std::size_t a = 0; a < 3; ++a) {
    const bool at_centre = a < centers.size() && same_ignoring_case(centers[a], "node");
    grid.origin[int(a)] = from[a] + (at_centre ? 0 : spacing[a] / 2);
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// MetaImage

void place_metaimage(const fs::path& file, const Fields& fields, Grid& grid) {
  if (const std::string_view units = fields.value("DistanceUnits"); !units.empty() && units != "?" && units != "mm")
    refuse(file, "its unit of length is " + quoted(units), "save it in mm");
  const std::string_view spacings = fields.any_value({"ElementSpacing", "ElementSize"});
  const auto spacing = finite_numbers(spacings, 3);
  if (spacing.empty())
    refuse(file, spacings.empty() ? "it gives no ElementSpacing" : "the ElementSpacing is " + quoted(spacings),
           "give three numbers in mm");
  grid.spacing = to_vector(spacing);
  check_positive_spacing(file.string(), grid.spacing, "correct the ElementSpacing");
  const std::string_view matrix = fields.any_value({"TransformMatrix", "Rotation", "Orientation"});
  if (!matrix.empty()) {
    const auto n = finite_numbers(matrix, 9);
    if (n.empty()) refuse(file, "the TransformMatrix is " + quoted(matrix), "give nine numbers");
    grid.direction = glm::dmat3(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]);
  }
  const std::string_view offset = fields.any_value({"Origin", "Offset", "Position"});
  if (!offset.empty()) {
    const auto n = finite_numbers(offset, 3);
    if (n.empty()) refuse(file, "the Offset is " + quoted(offset), "give three numbers in mm");
    grid.origin = to_vector(n);
  }
}

/// Refuses a header that states another packed size than the file has: one of the two is damaged.
void check_packed_size(const fs::path& file, const VoxelData& data, std::string_view given) {
  const std::string there = std::to_string(fs::file_size(data.file) - data.offset);
  if (given == there) return;
  refuse(file, given.empty() ? "it gives no CompressedDataSize" : "the CompressedDataSize is " + quoted(given),
         "write 'CompressedDataSize = " + there + "' into the header");
}

// ---------------------------------------------------------------------------------------------------------------------
// Writing

/// Returns the shortest decimal with 17 digits or fewer that `%.17g` gives, which reads back to the same double.
std::string exact(double number) {
  return formatted("%.17g", number);
}

std::string vector_text(const glm::dvec3& v) {
  return "(" + exact(v.x) + "," + exact(v.y) + "," + exact(v.z) + ")";
}

const char* nrrd_name(ElementType type) {
  static const char* const names[] = {"signed char", "unsigned char", "short",         "unsigned short",
                                      "int",         "unsigned int",  "long long int", "unsigned long long int",
                                      "float",       "double"};
  return names[std::size_t(type)];
}

std::string nrrd_header(const Grid& grid, ElementType type) {
  std::string text =
      "NRRD0004\n"
      "# Complete NRRD file format specification at:\n"
      "# http://teem.sourceforge.net/nrrd/format.html\n";
  const auto add = [&](const char* name, const std::string& value) { text += std::string(name) + ": " + value + "\n"; };
  const auto axis = [&](int a) { return vector_text(grid.spacing[a] * grid.direction[a]); };
  add("type", nrrd_name(type));
  add("dimension", "3");
  add("space", "left-posterior-superior");
  add("sizes", std::to_string(grid.size.x) + " " + std::to_string(grid.size.y) + " " + std::to_string(grid.size.z));
  add("space directions", axis(0) + " " + axis(1) + " " + axis(2));
  add("kinds", "domain domain domain");
  if (bytes_of(type) > 1) add("endian", std::endian::native == std::endian::little ? "little" : "big");
  add("encoding", "raw");
  add("space origin", vector_text(grid.origin));
  return text + "\n";
}

}  // namespace

VolumeHeader read_nrrd_volume_header(const fs::path& file) {
  const std::string bytes = front_of(file);
  std::size_t header_bytes = 0;
  const Fields fields = nrrd_fields(file, bytes, header_bytes);
  VolumeHeader header{"NRRD", {}, {}};
  VoxelData& data = header.data;
  header.grid.size = three_sizes(file, fields.value("dimension"), fields.value("sizes"));
  const auto type = nrrd_type(fields.value("type"));
  if (!type) refuse(file, "the type is " + quoted(fields.value("type")), "save it as short");
  data.type = *type;
  const std::string encoding = lower_case(fields.value("encoding"));
  if (encoding != "raw" && encoding != "gzip" && encoding != "gz")
    refuse(file, "the encoding is " + quoted(fields.value("encoding")), "save it as raw or gzip");
  data.packed = encoding != "raw";
  const std::string endian = lower_case(fields.value("endian"));
  if (bytes_of(data.type) > 1 && endian != "little" && endian != "big")
    refuse(file, "it does not give the order of its bytes", "add: endian: little");
  data.big_endian = endian == "big";
  place_nrrd(file, fields, header.grid);
  for (const auto& [name, shown] : {std::pair("oldmin", "old min"), std::pair("oldmax", "old max")})
    if (fields.has(name))
      refuse(file, std::string("the header asks for a rescale by '") + shown + "'", "save it in Hounsfield units");
  for (const auto& [name, shown] : {std::pair("lineskip", "line skip"), std::pair("byteskip", "byte skip")})
    if (fields.has(name) && fields.value(name) != "0")
      refuse(file, std::string("the header asks for a ") + shown, "save it without");
  set_place(file, fields.value("datafile"), header_bytes, data);
  check_voxel_data(file, data, header.grid.count());
  return header;
}

VolumeHeader read_metaimage_volume_header(const fs::path& file) {
  const std::string bytes = front_of(file), file_name = file.string();
  Fields fields;
  const std::size_t header_bytes = read_metaimage_header(
      bytes, file_name, kRightFile,
      // Of a field that is given twice the last one counts, as in the format's own library.
      [&](std::string_view name, std::string_view value, std::size_t) { fields.values[std::string(name)] = value; });
  VolumeHeader header{"MetaImage", {}, {}};
  VoxelData& data = header.data;
  header.grid.size = three_sizes(file, fields.value("NDims"), fields.value("DimSize"));
  const auto type = metaimage_type(fields.value("ElementType"));
  if (!type) refuse(file, "the ElementType is " + quoted(fields.value("ElementType")), "save it as MET_SHORT");
  data.type = *type;
  const std::string_view channels = fields.value("ElementNumberOfChannels");
  if (!channels.empty() && channels != "1")
    refuse(file, "each voxel has " + std::string(channels) + " components, as in colour images",
           "give a volume with one number a voxel");
  const auto flag = [&](std::initializer_list<std::string_view> names, bool otherwise) {
    const std::string_view value = fields.any_value(names);
    return value.empty() ? otherwise : metaimage_flag(file_name, *names.begin(), value);
  };
  if (!flag({"BinaryData"}, true)) refuse(file, "the voxels are written as text", "save them as binary");
  data.big_endian = flag({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, false);
  data.packed = flag({"CompressedData"}, false);
  if (const std::string_view skip = fields.value("HeaderSize"); !skip.empty() && skip != "0")
    refuse(file, "the header asks for a HeaderSize of " + std::string(skip), "save it without");
  place_metaimage(file, fields, header.grid);
  for (const auto& [name, none] :
       {std::pair("ElementToIntensityFunctionSlope", 1.0), std::pair("ElementToIntensityFunctionOffset", 0.0)})
    if (fields.has(name) && finite_numbers(fields.value(name), 1) != std::vector{none})
      refuse(file, "the header asks for a rescale by ElementToIntensityFunction", "save it in Hounsfield units");
  const std::string_view data_file = fields.value("ElementDataFile");
  if (data_file.empty()) refuse(file, "the ElementDataFile is ''", "write 'ElementDataFile = LOCAL'");
  set_place(file, lower_case(data_file) == "local" ? std::string_view() : data_file, header_bytes, data);
  check_voxel_data(file, data, header.grid.count());
  if (data.packed) check_packed_size(file, data, fields.value("CompressedDataSize"));
  return header;
}

void write_nrrd(const fs::path& file, const Grid& grid, ElementType type, const void* voxels) {
  write_atomically(file, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream << nrrd_header(grid, type);
    stream.write(static_cast<const char*>(voxels), std::streamsize(grid.count() * bytes_of(type)));
    stream.close();
    if (!stream)
      throw InputError(file.string(), "", "it cannot be written", "check the folder's permissions and free space");
  });
}

}  // namespace insonate
