#include "sim/registration/pixel_table.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "sim/registration/wein_settings.h"

namespace insonate::gl {
namespace {

const PixelPlace kNowhere(-1, 0, 0, 0);

PixelTable table_of(const std::vector<std::vector<PixelPlace>>& columns, const PixelPlace& filler, std::size_t group) {
  std::size_t steps = 0;
  PixelTable result;
  for (const auto& column : columns) {
    steps = std::max(steps, column.size());
    result.pixels += std::size_t(std::ranges::count_if(column, [](const PixelPlace& place) { return place.x >= 0; }));
  }
  result.columns = (columns.size() + group - 1) / group * group;
  std::vector<PixelPlace> table(result.columns * steps, filler);
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t step = 0; step < columns[i].size(); ++step) table[step * result.columns + i] = columns[i][step];
  result.places = TexelBuffer(GL_RGBA32I, table.size(), table.data());
  return result;
}

// Divides pixels into columns of about 64, with `together` pixels in sequence, so that a group takes neighbours per
// step.
PixelTable divided(const std::vector<PixelPlace>& pixels, std::size_t together, const PixelPlace& filler,
                   std::size_t group, std::size_t most_columns) {
  if (pixels.empty()) return {};
  const std::size_t units = pixels.size() / together,
                    groups = std::clamp<std::size_t>(pixels.size() / (64 * group), 1, most_columns / group);
  const std::size_t steps = (units + groups * group - 1) / (groups * group);
  std::vector<std::vector<PixelPlace>> columns(groups * group);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t unit = i / together;
    columns[unit / group / steps * group + unit % group].push_back(pixels[i]);
  }
  return table_of(columns, filler, group);
}

// Returns an image's pixels in strips of width `strip`, each from top to bottom. A work group that goes down a strip
// meets the few scan lines that pass through it, sample after sample. So the previous step has cached what it fetches.
std::vector<std::size_t> strip_by_strip(int width, int height, int strip) {
  std::vector<std::size_t> result;
  for (int first = 0; first < width; first += strip)
    for (int y = 0; y < height; ++y)
      for (int x = first; x < std::min(first + strip, width); ++x)
        result.push_back(std::size_t(y) * std::size_t(width) + std::size_t(x));
  return result;
}

}  // namespace

std::vector<PixelPlace> places_in_scan(const FanLayout& fan, const ScanLines& lines, int row_samples) {
  const glm::ivec2 last(lines.samples - 1, int(lines.lines.size()) - 1);
  std::vector<PixelPlace> result(fan.line_and_sample.size(), kNowhere);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (!fan.inside.pixels[i]) continue;
    const glm::vec2 at =
        glm::clamp(glm::vec2(fan.line_and_sample[i].y, fan.line_and_sample[i].x), glm::vec2(0), glm::vec2(last));
    const glm::ivec2 low = glm::max(glm::min(glm::ivec2(at), last - 1), 0);
    const glm::vec2 further = at - glm::vec2(low);
    result[i] =
        PixelPlace(low.y * row_samples + low.x, std::bit_cast<int>(further.x), std::bit_cast<int>(further.y), 0);
  }
  return result;
}

PixelTable picture_pixels(const std::vector<PixelPlace>& places, int width, int height, std::size_t group) {
  const int words = (width + kWordPixels - 1) / kWordPixels;
  std::vector<PixelPlace> pixels;
  for (int y = 0; y < height; ++y)
    for (int word = 0; word < words; ++word) {
      std::array<PixelPlace, kWordPixels> four;
      bool touched = false;
      for (int i = 0; i < kWordPixels; ++i) {
        const int x = kWordPixels * word + i;
        four[std::size_t(i)] = x < width ? places[std::size_t(y * width + x)] : kNowhere;
        touched = touched || four[std::size_t(i)].x >= 0;
      }
      four[0].w = y << 16 | word;
      if (touched) pixels.insert(pixels.end(), four.begin(), four.end());
    }
  return divided(pixels, kWordPixels, PixelPlace(-1, 0, 0, -1), group, 512 * group);
}

PixelTable compared_pixels(const std::vector<PixelPlace>& places, const Image<float>& image, int patch,
                           std::size_t group) {
  const auto counts = [&](std::size_t i) { return places[i].x >= 0 && !std::isnan(image.pixels[i]); };
  double count = 0, sum = 0, squares = 0;
  float least = std::numeric_limits<float>::infinity(), most = -least;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (counts(i)) {
      ++count;
      sum += image.pixels[i];
      least = std::min(least, image.pixels[i]);
      most = std::max(most, image.pixels[i]);
    }
  const double mean = sum / std::max(count, 1.0);
  for (std::size_t i = 0; i < places.size(); ++i)
    if (counts(i)) squares += (image.pixels[i] - mean) * (image.pixels[i] - mean);
  const double scale = most > least ? 1 / std::sqrt(squares / count) : 0;

  const int across = patch ? (image.width + patch - 1) / patch : 0;
  std::vector<PixelPlace> pixels;
  std::vector<std::vector<PixelPlace>> patches;
  for (const std::size_t i : strip_by_strip(image.width, image.height, int(group)))
    if (counts(i)) {
      pixels.push_back(places[i]);
      pixels.back().w = std::bit_cast<int>(float((image.pixels[i] - mean) * scale));
      if (!patch) continue;
      const std::size_t in = std::size_t(int(i) / image.width / patch * across + int(i) % image.width / patch);
      patches.resize(std::max(patches.size(), in + 1));
      patches[in].push_back(pixels.back());
    }
  return patches.empty() ? divided(pixels, 1, kNowhere, group, kMostPatches) : table_of(patches, kNowhere, group);
}

}  // namespace insonate::gl
