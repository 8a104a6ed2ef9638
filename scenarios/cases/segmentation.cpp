#include "scenarios/cases/segmentation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <map>
#include <utility>

#include "scenarios/cases/nifti_label_table.h"
#include "scenarios/cases/structures.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/volume/ct_reader.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kVolumeEndings = {".nii.gz", ".nii", ".nrrd", ".nhdr", ".mha", ".mhd"};
constexpr int kMaxStructures = 255;

using Counts = std::array<std::size_t, 256>;

Counts count_values(const Volume<std::uint8_t>& labels) {
  Counts counts{};
  for (const std::uint8_t value : labels.voxels) ++counts[value];
  return counts;
}

std::size_t labelled(const Counts& counts) {
  std::size_t sum = 0;
  for (std::size_t value = 1; value < counts.size(); ++value) sum += counts[value];
  return sum;
}

std::string box_of(const Grid& grid) {
  const glm::dvec3 a = grid.patient_from_index(glm::dvec3(-0.5));
  const glm::dvec3 b = grid.patient_from_index(glm::dvec3(grid.size) - 0.5);
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    char range[64];
    std::snprintf(range, sizeof range, "%s%.0f to %.0f", axis ? ", " : "", std::min(a[axis], b[axis]),
                  std::max(a[axis], b[axis]));
    text += range;
  }
  return text + " mm";
}

/// Returns the share of a file's labelled voxels that lie within the CT.
double share_within(const Volume<std::uint8_t>& labels, const Grid& ct) {
  const glm::dvec3 zero = ct.index_from_patient(labels.grid.patient_from_index(glm::dvec3(0.0)));
  glm::dmat3 step;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0.0);
    unit[axis] = 1;
    step[axis] = ct.index_from_patient(labels.grid.patient_from_index(unit)) - zero;
  }
  constexpr double kRounding = 1e-3;  // in voxels: rounding error of float headers
  std::size_t all = 0, within = 0, v = 0;
  for (int k = 0; k < labels.grid.size.z; ++k)
    for (int j = 0; j < labels.grid.size.y; ++j)
      for (int i = 0; i < labels.grid.size.x; ++i, ++v) {
        if (labels.voxels[v] == 0) continue;
        ++all;
        const glm::dvec3 at = zero + step * glm::dvec3(i, j, k);
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis)
          inside &= at[axis] > -0.5 - kRounding && at[axis] < ct.size[axis] - 0.5 + kRounding;
        within += inside;
      }
  return all ? double(within) / double(all) : 1;
}

std::string percent(double share) {
  return formatted("%.1f %%", 100 * share);
}

/// Returns a structure's name in the form that case files accept.
std::string identifier(const std::string& file, const std::string& name) {
  std::string plain;
  bool any = false;
  for (const unsigned char c : name) {
    any |= std::isalnum(c) != 0;
    plain += std::isalnum(c) ? char(std::tolower(c)) : '_';
  }
  if (!any)
    throw InputError(file, "", "the structure '" + name + "' has no letter or digit in its name",
                     "name it in plain letters");
  return plain;
}

Label label_of(const std::string& file, int value, const std::string& name, std::vector<std::string>& notes) {
  const std::string plain = identifier(file, name);
  const auto tissue = tissue_of_structure(plain);
  if (finding_tissue(plain)) notes.push_back("The structure '" + name + "' is taken for a finding: " + *tissue + ".");
  if (!tissue) notes.push_back("The structure '" + name + "' is not known and counts as soft tissue.");
  return {std::uint8_t(value), plain, tissue.value_or("soft_tissue")};
}

void check_names(const std::string& file, const std::vector<Label>& table) {
  std::map<std::string, int> seen;
  for (const Label& label : table)
    if (!seen.emplace(label.name, label.value).second)
      throw InputError(file, "", "two structures are called '" + label.name + "'", "rename one of them");
}

void note_outside(const std::string& what, double within, std::vector<std::string>& notes) {
  constexpr double kWorthSaying = 0.001;
  if (1 - within > kWorthSaying)
    notes.push_back(percent(1 - within) + " of " + what + " lies outside the CT and is left out.");
}

[[noreturn]] void refuse_outside(const fs::path& path, const Grid& labels, const Grid& ct) {
  throw InputError(path.string(), "",
                   "nothing of it lies within the CT: it spans " + box_of(labels) + ", the CT " + box_of(ct),
                   "give the labels of this CT, with the orientation in their header");
}

Segmentation read_multilabel(const fs::path& file, const Grid& ct, const std::string& label_table) {
  const Volume<std::uint8_t> found = read_labels(file);
  LabelNames names;
  if (label_table.empty()) {
    names = read_nifti_label_table(file);
  } else if (const auto standard = standard_label_table(label_table)) {
    names = *standard;
  } else {
    throw InputError("--label-table", "", "there is no label table '" + label_table + "'",
                     suggest(label_table, standard_label_tables()));
  }
  const Counts counts = count_values(found);
  if (labelled(counts) == 0) throw InputError(file.string(), "", "no voxel is labelled", "segment the CT again");
  if (names.empty())
    throw InputError(file.string(), "", "its header does not name its labels",
                     "say which table they follow: --label-table total, or total_v1 for version 1 of TotalSegmentator");
  for (int value = 1; value < 256; ++value)
    if (counts[std::size_t(value)] && !names.contains(value))
      throw InputError(file.string(), "",
                       "it holds the value " + std::to_string(value) + ", which its label table does not name",
                       "name the table that it follows with --label-table");
  Segmentation made;
  const double within = share_within(found, ct);
  made.labels = resample_labels(found, ct);
  const Counts kept = count_values(made.labels);
  if (labelled(kept) == 0) refuse_outside(file, found.grid, ct);
  note_outside("what is labelled", within, made.notes);
  for (const auto& [value, name] : names) {
    if (kept[std::size_t(value)])
      made.table.push_back(label_of(file.string(), value, name, made.notes));
    else if (counts[std::size_t(value)])
      made.notes.push_back("'" + name + "' has no voxel left on the CT's grid and is left out.");
  }
  check_names(file.string(), made.table);
  return made;
}

struct Mask {
  std::string structure;
  fs::path file;
};

std::vector<Mask> masks_in(const fs::path& folder) {
  std::vector<Mask> masks;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    for (const std::string_view ending : kVolumeEndings)
      if (name.size() > ending.size() && name.ends_with(ending)) {
        masks.push_back({name.substr(0, name.size() - ending.size()), at->path()});
        break;
      }
  }
  if (error) throw InputError(folder.string(), "", "the folder cannot be read (" + error.message() + ")", "check it");
  // The order of a directory listing is undefined.
  std::sort(masks.begin(), masks.end(), [](const Mask& a, const Mask& b) { return a.file < b.file; });
  return masks;
}

/// Merges masks one by one into one label volume.
class MaskMerger {
public:
  explicit MaskMerger(const Grid& ct) : ct_(ct) {
    made_.labels.grid = ct;
    made_.labels.voxels.resize(ct.count());
  }

  void add(const Mask& mask) {
    Volume<std::uint8_t> found = read_labels(mask.file);
    const Counts counts = count_values(found);
    if (std::count_if(counts.begin() + 1, counts.end(), [](std::size_t n) { return n > 0; }) > 1)
      throw InputError(mask.file.string(), "", "it holds several values, where a folder has a mask for each structure",
                       "give this file alone as the labels, or take it out of the folder");
    if (labelled(counts) == 0) {
      ++empty_;
      return;
    }
    const double within = share_within(found, ct_);
    if (within == 0) last_outside_ = found.grid;
    const Volume<std::uint8_t> here = resample_labels(found, ct_);
    const std::size_t size = labelled(count_values(here));
    note_outside("'" + mask.structure + "'", within, made_.notes);
    if (size == 0) return;
    if (made_.table.size() == kMaxStructures)
      throw InputError(mask.file.string(), "", "there are more than 255 structures", "take some out of the folder");
    const auto value = std::uint8_t(made_.table.size() + 1);
    made_.table.push_back(label_of(mask.file.string(), value, mask.structure, made_.notes));
    sizes_.push_back(size);
    merge(here, value);
  }

  Segmentation finish(const fs::path& folder) {
    if (made_.table.empty() && last_outside_) refuse_outside(folder, *last_outside_, ct_);
    if (made_.table.empty()) throw InputError(folder.string(), "", "every mask in it is empty", "segment the CT again");
    check_names(folder.string(), made_.table);
    if (empty_ > 0) made_.notes.push_back(std::to_string(empty_) + " masks are empty: this patient's CT lacks them.");
    for (const auto& [pair, voxels] : overlaps_)
      made_.notes.push_back(std::to_string(voxels) + " voxels are claimed by '" + name_of(pair.first) + "' and '" +
                            name_of(pair.second) + "'; the smaller, '" + name_of(pair.first) + "', has them.");
    // A structure that lies completely within smaller ones has no voxels left.
    const Counts kept = count_values(made_.labels);
    std::erase_if(made_.table, [&](const Label& label) {
      if (kept[label.value] == 0) made_.notes.push_back("'" + label.name + "' lies within others and is left out.");
      return kept[label.value] == 0;
    });
    return std::move(made_);
  }

private:
  const std::string& name_of(int value) const { return made_.table[std::size_t(value) - 1].name; }

  /// Gives each voxel that two structures claim to the smaller one, or to the first if they are equal.
  void merge(const Volume<std::uint8_t>& mask, std::uint8_t value) {
    const std::size_t size = sizes_[value - 1u];
    for (std::size_t v = 0; v < mask.voxels.size(); ++v) {
      if (mask.voxels[v] == 0) continue;
      std::uint8_t& holder = made_.labels.voxels[v];
      if (holder == 0) {
        holder = value;
        continue;
      }
      const bool smaller = size < sizes_[holder - 1u];
      ++overlaps_[smaller ? std::pair<int, int>(value, holder) : std::pair<int, int>(holder, value)];
      if (smaller) holder = value;
    }
  }

  const Grid& ct_;
  Segmentation made_;
  std::vector<std::size_t> sizes_;                       ///< by value - 1, voxels before any overlap
  std::map<std::pair<int, int>, std::size_t> overlaps_;  ///< voxels by (winner, loser)
  std::optional<Grid> last_outside_;
  int empty_ = 0;
};

}  // namespace

Segmentation read_segmentation(const fs::path& file_or_folder, const Grid& ct, const std::string& label_table,
                               const Progress& progress) {
  std::error_code error;
  if (!fs::is_directory(file_or_folder, error)) return read_multilabel(file_or_folder, ct, label_table);
  if (!label_table.empty())
    throw InputError("--label-table", "", "masks are named by their files", "leave it out for a folder of masks");
  const std::vector<Mask> masks = masks_in(file_or_folder);
  if (masks.empty())
    throw InputError(file_or_folder.string(), "", "there is no mask in it",
                     "give a folder with a file for each structure, such as liver.nii.gz");
  MaskMerger merger(ct);
  for (std::size_t m = 0; m < masks.size(); ++m) {
    merger.add(masks[m]);
    if (progress) progress(double(m + 1) / double(masks.size()));
  }
  return merger.finish(file_or_folder);
}

}  // namespace insonate
