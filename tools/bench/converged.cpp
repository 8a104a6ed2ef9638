#include "tools/bench/converged.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "sim/reference/reference.h"

namespace insonate::bench {

Converged converge(const Scene& scene, const ScanLines& lines, const Settings& settings, int most_lines) {
  const int n = int(lines.lines.size()), count = std::min(n, most_lines), d = lines.samples;
  Converged result{{}, Image<double>(count, d), Image<double>(count, d)};
  for (int i = 0; i < count; ++i) result.lines.push_back(count > 1 ? int(long(i) * (n - 1) / (count - 1)) : 0);

  const MediumField field = trilinear_field(scene.volume);
  constexpr int kChunk = 8;
  tbb::parallel_for(0, (count + kChunk - 1) / kChunk, [&](int chunk) {
    ScanLines finer = lines;
    finer.samples = kFiner * d;
    finer.lines.clear();
    for (int i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i)
      finer.lines.push_back(lines.lines[std::size_t(result.lines[std::size_t(i)])]);
    const ReferenceScan scan = traverse_reference(field, scene.table, finer, settings, scene.pose);
    for (int i = 0; i < int(finer.lines.size()); ++i)
      for (int k = 0; k < d; ++k) {
        // A sample lies halfway between two finer ones. I falls exponentially between them.
        const int before = kFiner * k + kFiner / 2 - 1, behind = before + 1;
        result.intensity.at(chunk * kChunk + i, k) =
            std::sqrt(scan.intensity.at(i, before) * scan.intensity.at(i, behind));
        result.reflection.at(chunk * kChunk + i, k) =
            (scan.reflection.at(i, before) + scan.reflection.at(i, behind)) / 2;
      }
  });
  return result;
}

}  // namespace insonate::bench
