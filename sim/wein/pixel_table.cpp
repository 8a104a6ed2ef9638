#include "sim/wein/pixel_table.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "sim/wein/wein_settings.h"

namespace insonate::gl {
namespace {

const PixelPlace kNowhere(-1, 0, 0, 0);

struct Entries {
  std::size_t columns = 0, pixels = 0;
  std::vector<PixelPlace> places;  // row by row

  PixelTable uploaded() const {
    PixelTable table;
    table.columns = columns;
    table.pixels = pixels;
    if (columns > 0) table.places = TexelBuffer(GL_RGBA32I, places.size(), places.data());
    return table;
  }
};

Entries entries_of(const std::vector<std::vector<PixelPlace>>& columns, const PixelPlace& filler, std::size_t group) {
  std::size_t steps = 0;
  Entries result;
  for (const auto& column : columns) {
    steps = std::max(steps, column.size());
    result.pixels += std::size_t(std::ranges::count_if(column, [](const PixelPlace& place) { return place.x >= 0; }));
  }
  result.columns = (columns.size() + group - 1) / group * group;
  result.places.assign(result.columns * steps, filler);
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t step = 0; step < columns[i].size(); ++step)
      result.places[step * result.columns + i] = columns[i][step];
  return result;
}

// Divides pixels into columns of about 64, with `together` pixels in sequence, so that a group takes neighbours per
// step.
Entries divided(const std::vector<PixelPlace>& pixels, std::size_t together, const PixelPlace& filler,
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
  return entries_of(columns, filler, group);
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
  return divided(pixels, kWordPixels, PixelPlace(-1, 0, 0, -1), group, 512 * group).uploaded();
}

ComparedPixels compared_pixels(const std::vector<PixelPlace>& places, std::span<const Image<float>> images, int patch,
                               std::size_t group) {
  const auto counts = [&](const Image<float>& image, std::size_t i) {
    return places[i].x >= 0 && !std::isnan(image.pixels[i]);
  };
  const int width = images.front().width, height = images.front().height,
            across = patch ? (width + patch - 1) / patch : 0;
  std::vector<PixelPlace> pixels;
  std::vector<std::vector<PixelPlace>> patches;
  for (const std::size_t i : strip_by_strip(width, height, int(group))) {
    if (std::ranges::none_of(images, [&](const Image<float>& image) { return counts(image, i); })) continue;
    pixels.push_back(places[i]);
    pixels.back().w = int(i);
    if (!patch) continue;
    const std::size_t in = std::size_t(int(i) / width / patch * across + int(i) % width / patch);
    patches.resize(std::max(patches.size(), in + 1));
    patches[in].push_back(pixels.back());
  }
  const Entries entries =
      patches.empty() ? divided(pixels, 1, kNowhere, group, kMaxPatches) : entries_of(patches, kNowhere, group);

  ComparedPixels result{entries.uploaded(), TexelBuffer{}, std::vector<double>{}};
  std::vector<float> values;
  values.reserve(entries.places.size() * images.size());
  for (const Image<float>& image : images) {
    double count = 0, sum = 0, squares = 0;
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (counts(image, i)) {
        ++count;
        sum += image.pixels[i];
        least = std::min(least, image.pixels[i]);
        most = std::max(most, image.pixels[i]);
      }
    const double mean = sum / std::max(count, 1.0);
    for (std::size_t i = 0; i < places.size(); ++i)
      if (counts(image, i)) squares += (image.pixels[i] - mean) * (image.pixels[i] - mean);
    const double scale = most > least ? 1 / std::sqrt(squares / count) : 0;
    result.variation.push_back(most > least ? squares : 0);
    for (const PixelPlace& place : entries.places)
      values.push_back(place.x >= 0 && counts(image, std::size_t(place.w))
                           ? float((image.pixels[std::size_t(place.w)] - mean) * scale)
                           : kNotCompared);
  }
  if (!values.empty()) result.values = TexelBuffer(GL_R32F, values.size(), values.data());
  return result;
}

}  // namespace insonate::gl
