#include "sim/gl/pixel_table.h"

#include <algorithm>

namespace insonate::gl {

PixelTable::PixelTable(const std::vector<std::vector<PixelPlace>>& of_columns, const PixelPlace& filler,
                       std::size_t group) {
  std::size_t steps = 0;
  for (const auto& column : of_columns) {
    steps = std::max(steps, column.size());
    pixels += column.size();
  }
  columns = (of_columns.size() + group - 1) / group * group;
  std::vector<PixelPlace> table(columns * steps, filler);
  for (std::size_t i = 0; i < of_columns.size(); ++i)
    for (std::size_t step = 0; step < of_columns[i].size(); ++step) table[step * columns + i] = of_columns[i][step];
  places = TexelBuffer(GL_RGBA32I, table.size(), table.data());
}

PixelTable shared_out(const std::vector<PixelPlace>& pixels, std::size_t together, const PixelPlace& filler,
                      std::size_t group) {
  if (pixels.empty()) return {};
  const std::size_t units = pixels.size() / together,
                    groups = std::clamp<std::size_t>(pixels.size() / (64 * group), 1, 512);
  const std::size_t steps = (units + groups * group - 1) / (groups * group);
  std::vector<std::vector<PixelPlace>> columns(groups * group);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t unit = i / together;
    columns[unit / group / steps * group + unit % group].push_back(pixels[i]);
  }
  return PixelTable(columns, filler, group);
}

}  // namespace insonate::gl
