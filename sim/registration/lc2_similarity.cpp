#include <array>
#include <stdexcept>
#include <utility>

#include "sim/registration/similarity.h"
#include "sim/wein/wein_simulator.h"

namespace insonate {
namespace {

constexpr std::array<std::string_view, 3> kNames{"lc2", "mi", "cr"};

WeinSettings of_size(WeinSettings settings, const Image<float>& image) {
  settings.image_width = image.width;
  settings.image_height = image.height;
  return settings;
}

class Lc2Similarity final : public Similarity {
public:
  Lc2Similarity(const AcousticVolume& volume, const TrackedSweep& sweep, const WeinSettings& settings)
      : simulator_(volume, sweep.probe, sweep.depth_mm, of_size(settings, sweep.images.front().grey)) {
    set_images(sweep.images);
  }

  void set_images(std::span<const SweepImage> images) override {
    std::vector<Image<float>> grey;
    sweep_from_probe_.clear();
    for (const SweepImage& image : images) {
      grey.push_back(image.grey);
      sweep_from_probe_.push_back(image.sweep_from_probe.matrix());
    }
    simulator_.set_ultrasound(grey);
  }

  std::vector<double> at(std::span<const glm::dmat4> ct_from_sweep, ImageRange used) override {
    const auto poses = used.of(std::span<const glm::dmat4>(sweep_from_probe_));
    places_.clear();
    for (const glm::dmat4& place : ct_from_sweep)
      for (const glm::dmat4& of_image : poses) places_.push_back(place * of_image);
    const std::vector<float> similar = simulator_.similarity(places_, used);
    const auto weights = used.of(std::span<const double>(simulator_.ultrasound_variation()));
    double all = 0;
    for (const double weight : weights) all += weight;
    std::vector<double> result(ct_from_sweep.size());
    if (all == 0) return result;
    for (std::size_t i = 0; i < similar.size(); ++i)
      result[i / weights.size()] += similar[i] * weights[i % weights.size()] / all;
    return result;
  }

private:
  gl::WeinSimulator simulator_;
  std::vector<glm::dmat4> sweep_from_probe_, places_;
};

}  // namespace

std::string_view to_string(Measure measure) {
  return kNames[std::size_t(measure)];
}

Measure measure_named(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return Measure(i);
  throw std::out_of_range("there is no measure of that name");
}

std::unique_ptr<Similarity> lc2_similarity(const AcousticVolume& volume, const TrackedSweep& sweep,
                                           const WeinSettings& settings) {
  return std::make_unique<Lc2Similarity>(volume, sweep, settings);
}

}  // namespace insonate
