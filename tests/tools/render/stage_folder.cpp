#include "tests/tools/render/stage_folder.h"

#include <cstdint>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/tools/render/recomputation.h"
#include "tests/tools/render/render_program.h"

namespace outsider {
namespace {

Plane read_nrrd(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  Plane plane;
  if (!std::getline(stream, line) || line != "NRRD0004") throw std::runtime_error(file.string() + " is no NRRD");
  bool raw = false, little = false, real = false;
  while (std::getline(stream, line) && !line.empty()) {
    raw |= line == "encoding: raw";
    little |= line == "endian: little";
    real |= line == "type: float";
    if (line.rfind("sizes: ", 0) == 0) std::istringstream(line.substr(7)) >> plane.width >> plane.height;
  }
  std::vector<float> values(std::size_t(plane.width) * std::size_t(plane.height));
  stream.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
  if (!raw || !little || !real || !stream || stream.peek() != EOF || values.empty())
    throw std::runtime_error(file.string() + " is not as documented");
  plane.values.assign(values.begin(), values.end());
  return plane;
}

}  // namespace

StageFolder read_stage_folder(const std::filesystem::path& folder) {
  StageFolder stages;
  std::ifstream stream(folder / "scanlines.json");
  stages.description = nlohmann::json::parse(stream);
  stages.hounsfield = ShortVolume(folder / "volume.nrrd");
  if (stages.description.at("model") == "S") stages.echogenicity = ShortVolume(folder / "volume_echogenicity.nrrd");
  if (std::filesystem::exists(folder / "volume_labels.nrrd")) {
    const std::string bytes = bytes_of(folder / "volume_labels.nrrd");
    if (bytes.size() < stages.hounsfield.voxels.size()) throw std::runtime_error("volume_labels.nrrd is too short");
    stages.labels.assign(bytes.end() - std::ptrdiff_t(stages.hounsfield.voxels.size()), bytes.end());
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path name = std::filesystem::relative(entry.path(), folder).replace_extension();
    if (entry.path().extension() == ".nrrd" && name.string().rfind("volume", 0) != 0)
      stages.planes[name.string()] = read_nrrd(entry.path());
  }
  return stages;
}

std::map<std::string, double> misfits(const StageFolder& stages, const Tolerances& tolerances) {
  std::map<std::string, double> all = line_misfits(stages, tolerances);
  all.merge(echo_misfits(stages, tolerances));
  all.merge(picture_misfits(stages, tolerances));
  return all;
}

Recomputation::Recomputation(const StageFolder& stages)
    : stages_(stages),
      about_(stages.description),
      set_(about_.at("settings")),
      planes_(stages.planes),
      d_(about_.at("samples")),
      dr_(about_.at("dr_mm")),
      r_min_(about_.at("r_min_mm")) {
  for (const auto& line : about_.at("scan_lines")) {
    starts_.push_back(vec3(line.at("start_mm")));
    directions_.push_back(vec3(line.at("direction")));
  }
  n_ = int(starts_.size());
  const int w = about_.at("image").at("width"), h = about_.at("image").at("height");
  for (const auto& [name, p] : planes_) {
    const bool as_picture = name.rfind("pixel_", 0) == 0 || name == "fused" || name == "image";
    if (p.width != (as_picture ? w : n_) || p.height != (as_picture ? h : d_))
      throw std::runtime_error(name + " is of another size");
  }
  if (about_.at("lines") != n_ || w != set_.at("image_width") || d_ != set_.at("samples"))
    throw std::runtime_error("scanlines.json contradicts itself");
  compare("samples", value("r_max_mm") - r_min_, dr_ * d_, 1e-9);
}

void Recomputation::compare(const std::string& stage, double expected, double got, double tolerated) {
  double misfit = std::abs(expected - got) / tolerated;
  if (!(misfit >= 0)) misfit = HUGE_VAL;  // NaN counts as a disagreement
  worst_[stage] = std::max(worst_[stage], misfit);
}

}  // namespace outsider
