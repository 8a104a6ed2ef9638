#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/registration/similarity.h"

namespace insonate {
namespace {

constexpr int kBins = 32;  // per side of the joint histogram

// A pixel that counts: where it lies in the sweep and its value.
struct Counted {
  glm::vec3 in_sweep;
  float u;
  int bin;  // of u
};

// Of one place of the sweep: per bin of the CT, counts by the ultrasound's bin, and sums of u and u^2.
struct Histogram {
  std::array<std::array<double, kBins>, kBins> joint{};
  std::array<double, kBins> count{}, sum{}, squares{};
};

double entropy(double share) {
  return share > 0 ? -share * std::log(share) : 0;
}

double mutual_information(const Histogram& h) {
  double all = 0, of_both = 0, of_ct = 0, of_u = 0;
  std::array<double, kBins> u{};
  for (const double n : h.count) all += n;
  if (all == 0) return 1;
  for (std::size_t i = 0; i < kBins; ++i) {
    of_ct += entropy(h.count[i] / all);
    for (std::size_t j = 0; j < kBins; ++j) {
      of_both += entropy(h.joint[i][j] / all);
      u[j] += h.joint[i][j];
    }
  }
  for (const double n : u) of_u += entropy(n / all);
  return of_both > 0 ? (of_u + of_ct) / of_both : 1;
}

double correlation_ratio(const Histogram& h) {
  double count = 0, sum = 0, squares = 0, within = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    count += h.count[i];
    sum += h.sum[i];
    squares += h.squares[i];
    if (h.count[i] > 0) within += h.squares[i] - h.sum[i] * h.sum[i] / h.count[i];
  }
  const double all = count > 0 ? squares - sum * sum / count : 0;
  return all > 0 ? 1 - within / all : 0;
}

class SliceSimilarity final : public Similarity {
public:
  SliceSimilarity(Measure measure, const AcousticVolume& volume, const TrackedSweep& sweep,
                  const WeinSettings& settings)
      : measure_(measure), volume_(volume), index_from_patient_(glm::inverse(volume.grid.matrix())) {
    const double half = (settings.bright_hu - settings.dark_hu) / 2;
    least_hu_ = float(settings.dark_hu - half);
    bins_per_hu_ = float(kBins / (4 * half));
    probe_ = sweep.probe;
    depth_mm_ = sweep.depth_mm;
    width_ = sweep.images.front().grey.width;
    height_ = sweep.images.front().grey.height;
    set_images(sweep.images);
  }

  void set_images(std::span<const SweepImage> images) override {
    const ImageGeometry geometry = image_geometry(probe_, depth_mm_, width_, height_);
    counted_.clear();
    image_begins_.assign(1, 0);
    float least = 1e30f, most = -1e30f;
    for (const SweepImage& image : images) {
      if (image.grey.width != width_ || image.grey.height != height_)
        throw std::invalid_argument("the images have another size");
      for (int y = 0; y < image.grey.height; ++y)
        for (int x = 0; x < image.grey.width; ++x) {
          const float u = image.grey.at(x, y);
          const glm::dvec2 plane = geometry.plane_mm(x, y);
          if (std::isnan(u) || !line_position(probe_, depth_mm_, plane)) continue;
          counted_.push_back({glm::vec3(image.sweep_from_probe.point(glm::dvec3(plane, 0))), u, 0});
          least = std::min(least, u);
          most = std::max(most, u);
        }
      image_begins_.push_back(counted_.size());
    }
    for (Counted& pixel : counted_)
      pixel.bin = std::clamp(int(float(kBins) * (pixel.u - least) / std::max(most - least, 1e-20f)), 0, kBins - 1);
  }

  std::vector<double> at(std::span<const glm::dmat4> ct_from_sweep, ImageRange used) override {
    const ImageRange images = used.within(image_begins_.size() - 1);
    const std::size_t begin = image_begins_[images.first], end = image_begins_[images.first + images.count];
    const std::span<const Counted> pixels = std::span(counted_).subspan(begin, end - begin);
    std::vector<double> result(ct_from_sweep.size());
    tbb::parallel_for(std::size_t(0), result.size(), [&](std::size_t i) {
      const Histogram h = histogram(pixels, glm::mat4(index_from_patient_ * ct_from_sweep[i]));
      result[i] = measure_ == Measure::mutual_information ? mutual_information(h) : correlation_ratio(h);
    });
    return result;
  }

private:
  // Returns HU at a continuous index: trilinear, air outside.
  float hu(const glm::vec3& index) const {
    const glm::ivec3& size = volume_.grid.size;
    const glm::vec3 low = glm::floor(index), f = index - low;
    if (low.x < 0 || low.y < 0 || low.z < 0 || low.x + 1 >= float(size.x) || low.y + 1 >= float(size.y) ||
        low.z + 1 >= float(size.z))
      return AcousticVoxel{}.hu;
    const AcousticVoxel* v = volume_.voxels.data() + volume_.grid.offset(glm::ivec3(low));
    const std::ptrdiff_t row = size.x, slice = row * size.y;
    const auto along = [&](const AcousticVoxel* at) {
      return float(at[0].hu) + f.x * (float(at[1].hu) - float(at[0].hu));
    };
    const float a = along(v), b = along(v + row), c = along(v + slice), d = along(v + slice + row);
    const float near = a + f.y * (b - a), far = c + f.y * (d - c);
    return near + f.z * (far - near);
  }

  Histogram histogram(std::span<const Counted> pixels, const glm::mat4& index_from_sweep) const {
    Histogram h;
    for (const Counted& pixel : pixels) {
      const float value = hu(glm::vec3(index_from_sweep * glm::vec4(pixel.in_sweep, 1)));
      const std::size_t bin = std::size_t(std::clamp((value - least_hu_) * bins_per_hu_, 0.0f, kBins - 1.0f));
      h.count[bin] += 1;
      h.joint[bin][std::size_t(pixel.bin)] += 1;
      h.sum[bin] += pixel.u;
      h.squares[bin] += double(pixel.u) * pixel.u;
    }
    return h;
  }

  Measure measure_;
  Probe probe_;
  double depth_mm_ = 0;
  int width_ = 0, height_ = 0;
  const AcousticVolume& volume_;
  glm::dmat4 index_from_patient_;
  float least_hu_ = 0, bins_per_hu_ = 1;
  std::vector<Counted> counted_;           // image after image
  std::vector<std::size_t> image_begins_;  // in them, and behind the last
};

}  // namespace

std::unique_ptr<Similarity> slice_similarity(Measure measure, const AcousticVolume& volume, const TrackedSweep& sweep,
                                             const WeinSettings& settings) {
  return std::make_unique<SliceSimilarity>(measure, volume, sweep, settings);
}

}  // namespace insonate
