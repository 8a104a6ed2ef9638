#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sim/files/files.h"
#include "sim/phantom/phantom.h"

namespace insonate {

// The built-in patient at a coarse pitch, with checks of its labels.

inline const std::filesystem::path kRecipe = std::filesystem::path(INSONATE_ASSETS_FOLDER) / "phantoms/abdomen.toml";

// Fine enough for organs, but not for walls: the thinnest wall is thinner than a voxel.
inline Case abdomen(const std::vector<std::pair<std::string, std::string>>& more = {},
                    const std::string& voxel_mm = "4") {
  std::vector<std::pair<std::string, std::string>> options{{"voxel_mm", voxel_mm}};
  options.insert(options.end(), more.begin(), more.end());
  return make_phantom(kRecipe.string(), read_file(kRecipe), options);
}

inline std::map<std::string, double> volumes_ml(const Case& subject) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t value : subject.labels.voxels) ++counts[value];
  const glm::dvec3& s = subject.labels.grid.spacing;
  std::map<std::string, double> volumes;
  for (const Label& label : subject.label_table)
    volumes[label.name] = double(counts[label.value]) * s.x * s.y * s.z / 1000;
  return volumes;
}

inline std::string label_at(const Case& subject, const glm::dvec3& p) {
  const std::uint8_t value = sample_nearest(subject.labels, subject.labels.grid.index_from_patient(p));
  for (const Label& label : subject.label_table)
    if (label.value == value) return label.name;
  return "";
}

}  // namespace insonate
