#include "tools/register/comparison_pictures.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "sim/core/image.h"
#include "sim/files/png.h"

namespace insonate {
namespace {

constexpr int kWidth = 384, kHeight = 288;           // pixels
constexpr double kDark_hu = -150, kBright_hu = 250;  // of the CT's slices
constexpr Rgba8 kNothing{20, 24, 30, 255};           // outside the fan
constexpr double kOrange[] = {1.0, 0.55, 0.1};       // of the ultrasound; blue is the rest to white

std::uint8_t level(double value) {
  return std::uint8_t(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

Image<double> ultrasound_of(const TrackedSweep& sweep, const SweepImage& image, const ImageGeometry& to) {
  const ImageGeometry from = image_geometry(sweep.probe, sweep.depth_mm, image.grey.width, image.grey.height);
  Image<double> source(image.grey.width, image.grey.height), result(to.width, to.height);
  float most = 1;
  for (std::size_t i = 0; i < source.pixels.size(); ++i) {
    source.pixels[i] = std::isnan(image.grey.pixels[i]) ? 0 : double(image.grey.pixels[i]);
    most = std::max(most, float(source.pixels[i]));
  }
  for (int y = 0; y < to.height; ++y)
    for (int x = 0; x < to.width; ++x) {
      const glm::dvec2 at = from.pixel(to.plane_mm(x, y));
      result.at(x, y) = bilinear(source, at.x, at.y) / double(most);
    }
  return result;
}

Image<double> ct_slice(const Volume<std::int16_t>& ct, const glm::dmat4& ct_from_sweep,
                       const FreeFormField& deformation, const Pose& sweep_from_probe, const ImageGeometry& geometry) {
  Image<double> result(geometry.width, geometry.height);
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x) {
      const glm::dvec3 in_sweep = deformation.at(sweep_from_probe.point(glm::dvec3(geometry.plane_mm(x, y), 0)));
      const glm::dvec3 at(ct_from_sweep * glm::dvec4(in_sweep, 1));
      const double hu = sample_trilinear(ct, ct.grid.index_from_patient(at));
      result.at(x, y) = std::clamp((hu - kDark_hu) / (kBright_hu - kDark_hu), 0.0, 1.0);
    }
  return result;
}

// Returns up to `count` images, in their order: evenly spread among the half that varies most.
std::vector<std::size_t> shown_images(const std::vector<SweepImage>& images, std::size_t count) {
  std::vector<double> variation;
  for (const SweepImage& image : images) variation.push_back(variation_in_depth(image.grey));
  std::vector<std::size_t> candidates(images.size()), chosen;
  std::iota(candidates.begin(), candidates.end(), std::size_t(0));
  std::ranges::stable_sort(candidates, std::ranges::greater{}, [&](std::size_t i) { return variation[i]; });
  candidates.resize(std::min(images.size(), std::max(images.size() / 2, count)));
  std::ranges::sort(candidates);
  const std::size_t kept = std::min(count, candidates.size());
  for (std::size_t i = 0; i < kept; ++i) chosen.push_back(candidates[(2 * i + 1) * candidates.size() / (2 * kept)]);
  return chosen;
}

// Returns the picture as it is shown: colours by `colour`, dark outside the fan, the marker on the left.
template <typename Colour>
Image<Rgba8> shown(const TrackedSweep& sweep, const ImageGeometry& geometry, Colour&& colour) {
  Image<Rgba8> picture(geometry.width, geometry.height, kNothing);
  for (int y = 0; y < geometry.height; ++y)
    for (int x = 0; x < geometry.width; ++x)
      if (line_position(sweep.probe, sweep.depth_mm, geometry.plane_mm(x, y))) picture.at(x, y) = colour(x, y);
  return mirrored(picture);
}

}  // namespace

std::vector<ComparisonPictures> write_comparison(const std::filesystem::path& folder, const TrackedSweep& sweep,
                                                 const Volume<std::int16_t>& ct, const glm::dmat4& before,
                                                 const glm::dmat4& after, const FreeFormField* deformation,
                                                 std::size_t count) {
  std::filesystem::create_directories(folder);
  const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, kWidth, kHeight);
  std::vector<ComparisonPictures> all;
  for (const std::size_t index : shown_images(sweep.images, count)) {
    ComparisonPictures one;
    one.image = index;
    const SweepImage& image = sweep.images[one.image];
    const auto write = [&](const char* what, const Image<Rgba8>& picture) {
      const std::string name = std::to_string(one.image + 1) + "-" + what + ".png";
      write_png(folder / name, picture);
      return (folder.filename() / name).generic_string();
    };
    const auto grey = [&](const Image<double>& values) {
      return shown(sweep, geometry, [&](int x, int y) {
        const std::uint8_t g = level(values.at(x, y));
        return Rgba8{g, g, g, 255};
      });
    };
    const Image<double> u = ultrasound_of(sweep, image, geometry);
    const auto blend = [&](const Image<double>& slice) {
      return shown(sweep, geometry, [&](int x, int y) {
        Rgba8 pixel{0, 0, 0, 255};
        for (std::size_t c = 0; c < 3; ++c)
          pixel[c] = level(kOrange[c] * u.at(x, y) + (1 - kOrange[c]) * slice.at(x, y));
        return pixel;
      });
    };
    const auto slice = [&](const glm::dmat4& map, const FreeFormField& field) {
      return ct_slice(ct, map, field, image.sweep_from_probe, geometry);
    };
    const Image<double> slice_before = slice(before, {}), slice_after = slice(after, {});
    one.ultrasound = write("ultrasound", grey(u));
    one.ct_before = write("ct-before", grey(slice_before));
    one.blend_before = write("blend-before", blend(slice_before));
    one.ct_after = write("ct-after", grey(slice_after));
    one.blend_after = write("blend-after", blend(slice_after));
    if (deformation) {
      const Image<double> slice_deformed = slice(after, *deformation);
      one.ct_deformed = write("ct-deformed", grey(slice_deformed));
      one.blend_deformed = write("blend-deformed", blend(slice_deformed));
    }
    all.push_back(one);
  }
  return all;
}

}  // namespace insonate
