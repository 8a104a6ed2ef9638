#include "sim/acoustics/speckle_file.h"

#include <glm/geometric.hpp>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <string_view>
#include <utility>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/image_headers/nrrd_header.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestSpeckleFile = std::size_t(16) << 30;
constexpr const char* kMakeIt = "compute one with insonate-case speckle";

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string numbers(const glm::dvec3& v) {
  return "(" + number(v.x) + "," + number(v.y) + "," + number(v.z) + ")";
}

/// Reads the numbers of "(1,2,3) (4,5,6)".
std::vector<double> numbers_in(std::string text) {
  for (char& c : text)
    if (c == '(' || c == ')' || c == ',') c = ' ';
  std::vector<double> found;
  for (const std::string_view word : words(text)) {
    const auto value = to_number<double>(word);
    if (!value) return {};
    found.push_back(*value);
  }
  return found;
}

/// The fields and keys of a header.
struct Header {
  std::map<std::string, std::string> fields, keys;
  std::size_t end = 0;
};

Header header_of(std::string_view bytes, const std::string& file) {
  Header header;
  const auto into = [](std::map<std::string, std::string>& to) {
    return [&to](std::string_view name, std::string_view value, std::size_t) { to[std::string(name)] = value; };
  };
  header.end = read_nrrd_header(bytes, file, kMakeIt, into(header.fields), into(header.keys));
  return header;
}

Grid grid_of(const Header& header, const std::string& file) {
  const auto wrong = [&](const char* field) {
    return InputError(file, std::string("field '") + field + "'", "it is not that of a scattering volume", kMakeIt);
  };
  const auto field = [&](const char* name) {
    const auto found = header.fields.find(name);
    return found == header.fields.end() ? std::string() : found->second;
  };
  for (const auto& [name, value] :
       {std::pair{"type", "float"}, {"encoding", "raw"}, {"endian", "little"}, {"dimension", "3"}})
    if (field(name) != value) throw wrong(name);
  const std::vector<double> sizes = numbers_in(field("sizes")), axes = numbers_in(field("space directions")),
                            origin = numbers_in(field("space origin"));
  if (sizes.size() != 3) throw wrong("sizes");
  if (axes.size() != 9) throw wrong("space directions");
  if (origin.size() != 3) throw wrong("space origin");
  Grid grid;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = sizes[std::size_t(axis)];
    if (!(size >= 1 && size <= 1 << 15) || size != std::floor(size)) throw wrong("sizes");
    grid.size[axis] = int(size);
    grid.origin[axis] = origin[std::size_t(axis)];
    const glm::dvec3 step(axes[std::size_t(3 * axis)], axes[std::size_t(3 * axis + 1)],
                          axes[std::size_t(3 * axis + 2)]);
    grid.spacing[axis] = glm::length(step);
    if (!(grid.spacing[axis] > 1e-3 && grid.spacing[axis] < 100)) throw wrong("space directions");
    grid.direction[axis] = step / grid.spacing[axis];
  }
  return grid;
}

}  // namespace

std::string identity_of(const Transducer& t) {
  std::string all;
  for (const double value : {double(int(t.kind)), double(t.elements), t.pitch_mm, t.kerf_mm, t.radius_mm, t.height_mm,
                             t.elevation_focus_mm, t.frequency_mhz, t.bandwidth_percent, t.excitation_cycles})
    all += number(value) + " ";
  return t.title + ", " + digest_of(all);
}

std::string speckle_header(const SpeckleKey& key, const SpecklePlan& plan, const Grid& grid) {
  static_assert(std::endian::native == std::endian::little);
  std::string text =
      "NRRD0004\ncontent: envelope of the scatterers' echo, 1 is the mean in liver\ntype: float\ndimension: 3\nspace: "
      "left-posterior-superior\nsizes: " +
      std::to_string(grid.size.x) + " " + std::to_string(grid.size.y) + " " + std::to_string(grid.size.z);
  text += "\nspace directions:";
  for (int axis = 0; axis < 3; ++axis) text += " " + numbers(grid.spacing[axis] * grid.direction[axis]);
  text += "\nspace origin: " + numbers(grid.origin) + "\nendian: little\nencoding: raw\n";
  text += "insonate speckle:=1\npatient:=" + key.patient + "\ntransducer:=" + key.transducer +
          "\nseed:=" + std::to_string(key.seed) + "\nprobe:=" + plan.probe.name +
          "\ndepth_mm:=" + number(plan.depth_mm) + "\ncell_mm:=" + number(plan.cell_mm) +
          "\nfocus_mm:=" + number(plan.beamforming.transmit_focus_mm) +
          "\nf_number:=" + number(plan.beamforming.transmit_f_number) + "\n\n";
  return text;
}

bool is_speckle_file(const std::filesystem::path& file, const std::string& header, const Grid& grid) {
  std::error_code error;
  if (std::filesystem::file_size(file, error) != header.size() + grid.count() * sizeof(float) || error) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string begin(header.size(), '\0');
  stream.read(begin.data(), std::streamsize(begin.size()));
  return stream && begin == header;
}

Volume<float> read_speckle_file(const std::filesystem::path& file, const SpeckleKey& expected) {
  const std::string bytes = read_file(file, kLargestSpeckleFile), name = file.string();
  const Header header = header_of(bytes, name);
  const auto key = [&](const char* of) {
    const auto found = header.keys.find(of);
    return found == header.keys.end() ? std::string() : found->second;
  };
  if (key("insonate speckle") != "1")
    throw InputError(name, "key 'insonate speckle'", "this is not a scattering volume of this version", kMakeIt);
  if (key("patient") != expected.patient)
    throw InputError(name, "key 'patient'", "this volume was computed for another patient, or the patient has changed",
                     "compute it again with insonate-case speckle");
  if (key("transducer") != expected.transducer)
    throw InputError(name, "key 'transducer'",
                     "this volume is of the transducer " + insonate::quoted(std::string_view(key("transducer"))) +
                         ", not " + expected.transducer,
                     "take that one's probe, or compute it again with insonate-case speckle");
  if (key("seed") != std::to_string(expected.seed))
    throw InputError(name, "key 'seed'",
                     "this volume has the seed " + insonate::quoted(std::string_view(key("seed"))) + ", not " +
                         std::to_string(expected.seed),
                     "set speckle_seed, or compute it again with insonate-case speckle");
  Volume<float> volume{grid_of(header, name), {}};
  const std::size_t wanted = volume.grid.count() * sizeof(float);
  if (bytes.size() - header.end != wanted)
    throw InputError(name, "",
                     "it holds " + std::to_string(bytes.size() - header.end) + " bytes of voxels instead of " +
                         std::to_string(wanted),
                     "copy it again");
  volume.voxels.resize(volume.grid.count());
  std::memcpy(volume.voxels.data(), bytes.data() + header.end, wanted);
  return volume;
}

}  // namespace insonate
