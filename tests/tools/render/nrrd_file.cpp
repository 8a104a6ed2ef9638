#include "tests/tools/render/nrrd_file.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <sstream>

#include "sim/files/files.h"

namespace insonate::test {
namespace {

glm::dvec3 vector(std::istream& from) {
  char mark;
  glm::dvec3 v(0);
  from >> mark >> v.x >> mark >> v.y >> mark >> v.z >> mark;
  return v;
}

}  // namespace

NrrdFile::NrrdFile(const std::filesystem::path& file) {
  const std::string all = read_file(file);
  const std::size_t end = std::min(all.find("\n\n"), all.size());
  std::istringstream header(all.substr(0, end));
  std::string line;
  std::getline(header, line);
  if (!line.starts_with("NRRD000")) throw std::runtime_error(file.string() + " is not an NRRD");
  while (std::getline(header, line))
    if (const std::size_t colon = line.find(": "); colon != line.npos)
      fields[line.substr(0, colon)] = line.substr(colon + 2);
  if (end == all.size() || fields["encoding"] != "raw" ||
      (fields.count("endian") ? fields["endian"] != "little" : fields["type"] != kTypeName<std::uint8_t>))
    throw std::runtime_error(file.string() + " is not raw and little-endian");
  bytes = all.substr(end + 2);
}

std::vector<int> NrrdFile::sizes() const {
  std::istringstream text(fields.at("sizes"));
  std::vector<int> all;
  for (int size; text >> size;) all.push_back(size);
  return all;
}

Image<float> NrrdFile::image() const {
  const std::vector<int> size = sizes();
  if (fields.at("dimension") != "2" || size.size() != 2) throw std::runtime_error("the file does not have two axes");
  Image<float> image(size[0], size[1]);
  image.pixels = values<float>();
  return image;
}

Grid NrrdFile::grid() const {
  const std::vector<int> size = sizes();
  if (fields.at("space") != "left-posterior-superior" || fields.at("dimension") != "3" || size.size() != 3)
    throw std::runtime_error("the file is not a volume in the patient's frame");
  Grid grid;
  std::istringstream directions(fields.at("space directions")), origin(fields.at("space origin"));
  for (int axis = 0; axis < 3; ++axis) {
    grid.size[axis] = size[std::size_t(axis)];
    const glm::dvec3 step = vector(directions);
    grid.spacing[axis] = glm::length(step);
    grid.direction[axis] = step / grid.spacing[axis];
  }
  grid.origin = vector(origin);
  return grid;
}

}  // namespace insonate::test
