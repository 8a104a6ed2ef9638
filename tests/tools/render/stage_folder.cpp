#include "tests/tools/render/stage_folder.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <variant>

#include "sim/probe/probe.h"
#include "sim/tissue/acoustic_volume.h"

namespace insonate::test {
namespace {

namespace fs = std::filesystem;

constexpr float kOutsideFan = -2;

glm::dvec3 vec3(const nlohmann::json& json) {
  return {json.at(0), json.at(1), json.at(2)};
}

/// Returns a pose as the text of --pose: 16 numbers, row by row.
std::string text_of(const Pose& pose) {
  const glm::dmat4 matrix = pose.matrix();
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i < 16; ++i) text << matrix[i % 4][i / 4] << (i % 4 == 3 ? '\n' : ' ');
  return text.str();
}

}  // namespace

StageFolder::StageFolder(const fs::path& folder) {
  std::ifstream stream(folder / "scanlines.json");
  description = nlohmann::json::parse(stream);
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".nrrd")
      files.emplace(fs::relative(entry.path(), folder).replace_extension().string(), NrrdFile(entry.path()));
}

Image<std::uint8_t> StageFolder::grey() const {
  const Image<float> levels = image("image");
  Image<std::uint8_t> grey(levels.width, levels.height);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
    const float level = levels.pixels[i];
    if (!(level >= 0 && level <= 255 && level == std::floor(level)))
      throw std::runtime_error("image holds a value that is not a grey level");
    grey.pixels[i] = std::uint8_t(level);
  }
  return grey;
}

StageFolder export_stages(const TemporaryFolder& folder, const std::string& patient, const View& view,
                          const std::string& more) {
  folder.put("pose.txt", text_of(view.patient_from_probe));
  folder.put("settings.toml", view.settings);
  const std::string in = folder.path.string();
  fs::remove_all(folder.path / "stages");
  const ProgramOutcome outcome =
      run_program(INSONATE_RENDER_PROGRAM " " + patient + " --pose " + in + "/pose.txt --settings " + in +
                  "/settings.toml --probe " + view.probe + " --depth " + std::to_string(view.depth_mm) + " --stages " +
                  in + "/stages " + more + " " + in + "/image.png");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  return StageFolder(folder.path / "stages");
}

void check_forms(const StageFolder& stages, const std::vector<FileForm>& among_lines,
                 const std::vector<FileForm>& as_picture, const std::vector<std::string>& volumes) {
  std::set<std::string> expected(volumes.begin(), volumes.end()), found;
  const auto check = [&](const FileForm& form, const char* axes, const nlohmann::json& width,
                         const nlohmann::json& height) {
    INFO(form.name);
    expected.insert(form.name);
    REQUIRE(stages.files.count(form.name));
    const NrrdFile& file = stages.files.at(form.name);
    CHECK(file.fields.at("labels") == axes);
    CHECK(file.fields.at("content").find(form.content) != std::string::npos);
    const Image<float> image = file.image();
    CHECK(image.width == width);
    CHECK(image.height == height);
    CHECK(std::all_of(image.pixels.begin(), image.pixels.end(), [](float value) { return std::isfinite(value); }));
  };
  const nlohmann::json &text = stages.description, &picture = text.at("image");
  for (const FileForm& form : among_lines) check(form, "\"line\" \"sample\"", text.at("lines"), text.at("samples"));
  for (const FileForm& form : as_picture) check(form, "\"x\" \"y\"", picture.at("width"), picture.at("height"));
  for (const auto& [name, file] : stages.files) found.insert(name);
  CHECK(found == expected);
}

void check_geometry(const StageFolder& stages, const View& view, int samples, int width, int height, const Grid& grid) {
  const Probe& probe = *find_probe(view.probe);
  const ScanLines lines = scan_lines(probe, view.depth_mm, samples);
  const nlohmann::json& text = stages.description;
  CHECK(text.at("format") == 3);
  CHECK(text.at("probe") == view.probe);
  CHECK(text.at("depth_mm") == view.depth_mm);
  CHECK(text.at("lines") == probe.lines);
  CHECK(text.at("samples") == samples);
  CHECK(text.at("r_min_mm") == lines.r_min_mm);
  CHECK(text.at("r_max_mm") == lines.r_max_mm);
  CHECK(text.at("dr_mm") == lines.dr_mm());
  const glm::dmat4 pose = view.patient_from_probe.matrix();
  REQUIRE(text.at("patient_from_probe").size() == 16);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      CHECK(text.at("patient_from_probe").at(std::size_t(4 * row + column)) == pose[column][row]);

  REQUIRE(text.at("scan_lines").size() == lines.lines.size());
  double off = 0;
  for (std::size_t i = 0; i < lines.lines.size(); ++i) {
    const nlohmann::json& line = text.at("scan_lines").at(i);
    off = std::max(
        {off, glm::distance(vec3(line.at("start_mm")), view.patient_from_probe.point(lines.lines[i].start)),
         glm::distance(vec3(line.at("direction")), view.patient_from_probe.direction(lines.lines[i].direction))});
  }
  CHECK(off < 1e-9);

  const nlohmann::json& volume = text.at("volume");
  const Grid of_file = stages.files.at("volume").grid();
  CHECK(of_file.size == grid.size);
  for (int axis = 0; axis < 3; ++axis) {
    CHECK(volume.at("size").at(std::size_t(axis)) == grid.size[axis]);
    CHECK(volume.at("spacing_mm").at(std::size_t(axis)).get<double>() == Approx(grid.spacing[axis]).epsilon(1e-12));
    CHECK(glm::distance(vec3(volume.at("axes").at(std::size_t(axis))), grid.direction[axis]) < 1e-12);
    CHECK(glm::distance(of_file.spacing[axis] * of_file.direction[axis], grid.spacing[axis] * grid.direction[axis]) <
          1e-9);
  }
  CHECK(glm::distance(vec3(volume.at("origin_mm")), grid.origin) < 1e-9);
  CHECK(glm::distance(of_file.origin, grid.origin) < 1e-9);
  CHECK(volume.at("outside_hu") == kAir_hu);
  CHECK(volume.at("outside_echogenicity_db") == kMinEchogenicity_db);

  const nlohmann::json& picture = text.at("image");
  CHECK(picture.at("width") == width);
  CHECK(picture.at("height") == height);
  const double side = picture.at("mm_per_pixel");
  const glm::dvec2 corner(picture.at("top_left_mm").at(0), picture.at("top_left_mm").at(1));
  CHECK(side == image_geometry(probe, view.depth_mm, width, height).mm_per_pixel);
  const Image<float> line = stages.image("pixel_line"), sample = stages.image("pixel_sample");
  int wrong = 0, inside = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto position = line_position(probe, view.depth_mm, corner + side * glm::dvec2(x, y));
      const float at_line = position ? float(position->line) : kOutsideFan;
      const float at_sample = position ? float((position->r_mm - lines.r_min_mm) / lines.dr_mm() - 0.5) : kOutsideFan;
      inside += position.has_value();
      wrong += line.at(x, y) != at_line || sample.at(x, y) != at_sample;
    }
  CHECK(inside > width * height / 4);
  CHECK(wrong == 0);
}

void check_settings(const StageFolder& stages, const std::vector<std::pair<std::string, SettingValue>>& settings) {
  const nlohmann::json& written = stages.description.at("settings");
  CHECK(written.size() == settings.size());
  for (const auto& [name, value] : settings) {
    INFO(name);
    CHECK(written.at(name) == std::visit([](const auto& held) { return nlohmann::json(held); }, value));
  }
}

void check_rounded(const StageFolder& stages, const std::string& name, const Image<double>& expected) {
  // Half of float's last place. The CT's grid passes through text and a division: 1e-9 of the largest value is more
  // than this changes.
  constexpr double kRounding = 0x1p-24, kOfGrid = 1e-9;
  double largest = 0;
  for (const double value : expected.pixels) largest = std::max(largest, std::abs(value));
  const Image<float> got = stages.image(name);
  REQUIRE(got.width == expected.width);
  REQUIRE(got.height == expected.height);
  double worst = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const double value = expected.pixels[i];
    worst =
        std::max(worst, std::abs(got.pixels[i] - value) / (kRounding * std::abs(value) + kOfGrid * largest + 1e-300));
  }
  INFO(name << ": the worst error is " << worst << " of the tolerance, the largest value " << largest);
  CHECK(worst < 1);
}

}  // namespace insonate::test
