#include "sim/registration/echo_seen.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

namespace insonate {
namespace {

constexpr int kMaxDark = 48;            // grey levels: the dark around a fan is not brighter
constexpr int kAboveDark = 4;           // grey levels: compression leaves less around a fan
constexpr int kMinChange = 4;           // grey levels
constexpr double kFilterShare = 0.006;  // half of the filter's window, of the image's longer side
constexpr double kMinRegion = 0.1;      // of the largest region's area
constexpr double kMinChanging = 0.25;   // of a region's pixels, where the images change at all
constexpr std::size_t kMinImages = 3;   // from which changes are telling

// Sums of a mask over rectangles.
class Sums {
public:
  explicit Sums(const Image<std::uint8_t>& mask) : sums_(mask.width + 1, mask.height + 1) {
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x)
        sums_.at(x + 1, y + 1) = sums_.at(x, y + 1) + sums_.at(x + 1, y) - sums_.at(x, y) + (mask.at(x, y) > 0);
  }
  /// Returns how many pixels of the square around one are set, and how many it has within the image.
  std::pair<int, int> around(int x, int y, int reach) const {
    const int left = std::max(x - reach, 0), right = std::min(x + reach + 1, sums_.width - 1),
              top = std::max(y - reach, 0), bottom = std::min(y + reach + 1, sums_.height - 1);
    return {sums_.at(right, bottom) - sums_.at(left, bottom) - sums_.at(right, top) + sums_.at(left, top),
            (right - left) * (bottom - top)};
  }

private:
  Image<int> sums_;
};

// Returns the level of the dark around a fan: the most frequent one, if it is dark.
int dark_level(const Image<std::uint8_t>& image) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t each : image.pixels) ++counts[each];
  return int(std::max_element(counts.begin(), counts.begin() + kMaxDark) - counts.begin());
}

struct Regions {
  Image<int> number;  // of each pixel's region; -1: of none
  std::vector<std::size_t> area;
};

Regions regions_of(const Image<std::uint8_t>& mask) {
  Regions found{Image<int>(mask.width, mask.height, -1), std::vector<std::size_t>()};
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (mask.at(x, y) == 0 || found.number.at(x, y) >= 0) continue;
      const int number = int(found.area.size());
      found.area.push_back(0);
      found.number.at(x, y) = number;
      open.assign(1, {x, y});
      while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        ++found.area.back();
        for (const auto& [u, v] : {std::pair(i - 1, j), std::pair(i + 1, j), std::pair(i, j - 1), std::pair(i, j + 1)})
          if (u >= 0 && v >= 0 && u < mask.width && v < mask.height && mask.at(u, v) > 0 && found.number.at(u, v) < 0) {
            found.number.at(u, v) = number;
            open.emplace_back(u, v);
          }
      }
    }
  return found;
}

}  // namespace

void EchoSeen::add(const Image<std::uint8_t>& image) {
  if (images_++ == 0) {
    lowest_ = highest_ = image;
    return;
  }
  if (image.width != highest_.width || image.height != highest_.height)
    throw std::invalid_argument("the images are not of one size");
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    lowest_.pixels[i] = std::min(lowest_.pixels[i], image.pixels[i]);
    highest_.pixels[i] = std::max(highest_.pixels[i], image.pixels[i]);
  }
}

Image<std::uint8_t> EchoSeen::mask() const {
  const int width = highest_.width, height = highest_.height, dark = dark_level(highest_);
  Image<std::uint8_t> bright(width, height), changing(width, height);
  std::size_t changed = 0, lit = 0;
  for (std::size_t i = 0; i < bright.pixels.size(); ++i) {
    bright.pixels[i] = highest_.pixels[i] > dark + kAboveDark;
    changing.pixels[i] = bright.pixels[i] && highest_.pixels[i] - lowest_.pixels[i] >= kMinChange;
    lit += bright.pixels[i];
    changed += changing.pixels[i];
  }
  // A window of which most is echo lies in a region. Strokes of letters and lines are too thin for that.
  const int reach = std::max(2, int(kFilterShare * std::max(width, height)));
  const Sums sums(bright);
  Image<std::uint8_t> dense(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto [set, all] = sums.around(x, y, reach);
      dense.at(x, y) = 2 * set > all;
    }
  const Regions regions = regions_of(dense);
  std::vector<std::size_t> changes(regions.area.size());
  for (std::size_t i = 0; i < dense.pixels.size(); ++i)
    if (regions.number.pixels[i] >= 0) changes[std::size_t(regions.number.pixels[i])] += changing.pixels[i];
  const bool telling = images_ >= kMinImages && double(changed) > kMinChanging * double(lit);
  const auto moves = [&](std::size_t region) {
    return !telling || double(changes[region]) > kMinChanging * double(regions.area[region]);
  };
  std::size_t largest = 0;
  for (std::size_t region = 0; region < regions.area.size(); ++region)
    if (moves(region)) largest = std::max(largest, regions.area[region]);
  Image<std::uint8_t> kept(width, height);
  for (std::size_t i = 0; i < kept.pixels.size(); ++i) {
    const int number = regions.number.pixels[i];
    if (number < 0) continue;
    const auto region = std::size_t(number);
    kept.pixels[i] = moves(region) && double(regions.area[region]) >= kMinRegion * double(largest);
  }
  // Echo counts as it is, also where it is sparse at a region's edge.
  const Sums near(kept);
  Image<std::uint8_t> mask(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) mask.at(x, y) = bright.at(x, y) && near.around(x, y, reach).first > 0;
  return mask;
}

}  // namespace insonate
