#include "scenarios/case_digest.h"

#include <string_view>
#include <vector>

#include "sim/files/digest.h"

namespace insonate {
namespace {

/// Concatenates parts. A part of variable length is preceded by its length, so that "ab" + "c" differs from "a" + "bc".
class Parts {
public:
  void add(double number) { all_.append(reinterpret_cast<const char*>(&number), sizeof number); }
  void add(const glm::dvec3& v) {
    for (int c = 0; c < 3; ++c) add(v[c]);
  }
  void add(const glm::dmat3& m) {
    for (int c = 0; c < 3; ++c) add(m[c]);
  }
  void add(const std::string& text) {
    add(double(text.size()));
    all_ += text;
  }
  void add(const std::vector<std::string>& list) {
    add(double(list.size()));
    for (const std::string& text : list) add(text);
  }
  /// Adds the digest of the voxels, because a copy of all voxels would be large.
  template <typename T>
  void add_voxels(const std::vector<T>& voxels) {
    add(insonate::digest_of(std::string_view(reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(T))));
  }

  std::string digest() const { return insonate::digest_of(std::string_view(all_)); }

private:
  std::string all_;
};

}  // namespace

std::string digest_of(const Case& subject) {
  Parts parts;
  const Grid& grid = subject.ct.grid;
  parts.add(glm::dvec3(grid.size));
  parts.add(grid.spacing);
  parts.add(grid.origin);
  parts.add(grid.direction);
  parts.add_voxels(subject.ct.voxels);
  parts.add_voxels(subject.labels.voxels);
  for (const Label& label : subject.label_table) {
    parts.add(double(label.value));
    parts.add(label.name);
  }
  for (const Landmark& landmark : subject.landmarks) {
    parts.add(landmark.name);
    parts.add(landmark.position);
  }
  for (const ReferenceView& view : subject.views) {
    parts.add(view.name);
    parts.add(view.probe);
    parts.add(view.depth_mm);
    parts.add(view.landmarks);
    parts.add(view.targets);
    parts.add(view.patient_from_probe.rotation);
    parts.add(view.patient_from_probe.translation);
  }
  return parts.digest();
}

}  // namespace insonate
