#include "sim/truth/picture_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "sim/tissue/skin_contact.h"

namespace insonate {
namespace {

constexpr double kMaxPressed_mm = 100;  // no hand presses a probe further in

}  // namespace

TruthMaker::TruthMaker(const Case& subject, const TissueTable& tissues) : case_(&subject), tissues_(&tissues) {}

void TruthMaker::set_view(const Probe& probe, double depth_mm, const Settings& settings) {
  const int width = settings.image_width, height = settings.image_height;
  const double frequency_mhz = settings.frequency_mhz;
  Probe shape = probe;
  shape.frequency_mhz = 0;  // the settings' counts
  const View view{Probe(shape), depth_mm, frequency_mhz, coupling_depth_mm(settings), width, height};
  if (view == view_) return;
  const bool same_pixels =
      view.probe == view_.probe && depth_mm == view_.depth_mm && width == view_.width && height == view_.height;
  view_ = view;
  lines_ = scan_lines(probe, depth_mm, int(std::ceil(depth_mm / kSampleDistance_mm)));
  transmission_.emplace(case_->ct, *tissues_, lines_.dr_mm(), frequency_mhz, GelLayer{view.gel_mm, true});
  least_intensity_ = soft_tissue_intensity(lines_, *tissues_, frequency_mhz);
  for (double& intensity : least_intensity_) intensity *= kArrivingShare;
  if (same_pixels) return;
  geometry_ = image_geometry(probe, depth_mm, width, height);
  pixels_.clear();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (const auto at = line_position(probe, depth_mm, geometry_.plane_mm(x, y))) {
        const int line = std::clamp(int(std::lround(at->line)), 0, probe.lines - 1);
        const int sample = std::clamp(int(at->r_mm / lines_.dr_mm()), 0, lines_.samples - 1);
        pixels_.push_back({x, y, std::uint32_t(line * lines_.samples + sample)});
      }
}

PictureTruth TruthMaker::at(const Pose& patient_from_probe) const {
  const std::size_t samples = std::size_t(lines_.samples);
  std::vector<std::uint8_t> arrives(lines_.lines.size() * samples);
  std::vector<double> intensity(samples);
  for (std::size_t line = 0; line < lines_.lines.size(); ++line) {
    transmission_->along(voxel_line(case_->ct.grid, lines_, line, patient_from_probe), intensity);
    for (std::size_t k = 0; k < samples; ++k) arrives[line * samples + k] = intensity[k] >= least_intensity_[k];
  }

  PictureTruth truth;
  truth.label = truth.visible_label = truth.reach = Image<std::uint8_t>(view_.width, view_.height);
  const bool labelled = !case_->labels.empty();
  const auto index_of = [&](double x, double y) {
    return case_->ct.grid.index_from_patient(patient_from_probe.point(glm::dvec3(geometry_.plane_mm(x, y), 0)));
  };
  const glm::dvec3 origin = index_of(0, 0), per_column = index_of(1, 0) - origin, per_row = index_of(0, 1) - origin;
  for (const Pixel& pixel : pixels_) {
    const std::size_t i = std::size_t(pixel.y) * std::size_t(view_.width) + std::size_t(pixel.x);
    const bool reached = arrives[pixel.place] != 0;
    truth.reach.pixels[i] = std::uint8_t(reached ? Reach::arrives : Reach::shadowed);
    if (!labelled) continue;
    const std::uint8_t label =
        sample_nearest(case_->labels, origin + double(pixel.x) * per_column + double(pixel.y) * per_row);
    truth.label.pixels[i] = label;
    truth.visible_label.pixels[i] = reached ? label : std::uint8_t(0);
  }
  truth.skin_mm = skin_along_lines(patient_from_probe);
  return truth;
}

std::vector<float> TruthMaker::skin_along_lines(const Pose& patient_from_probe) const {
  std::vector<float> distances;
  distances.reserve(lines_.lines.size());
  for (const ScanLine& line : lines_.lines) {
    const glm::dvec3 start = patient_from_probe.point(line.start);
    const glm::dvec3 along = patient_from_probe.direction(line.direction);
    std::optional<double> distance = distance_to_skin(case_->ct, start, along, view_.depth_mm);
    if (distance == 0.0) {
      distance = distance_out_of_body(case_->ct, start, -along, kMaxPressed_mm);
      if (distance) distance = -*distance;
    }
    distances.push_back(distance ? float(*distance) : std::numeric_limits<float>::quiet_NaN());
  }
  return distances;
}

glm::dmat4 patient_from_pixel(const ImageGeometry& geometry, const Pose& patient_from_probe) {
  glm::dmat4 probe_from_pixel(1.0);
  probe_from_pixel[0][0] = probe_from_pixel[1][1] = geometry.mm_per_pixel;
  probe_from_pixel[3] = glm::dvec4(geometry.top_left_mm, 0, 1);
  return patient_from_probe.matrix() * probe_from_pixel;
}

}  // namespace insonate
