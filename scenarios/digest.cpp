#include "scenarios/digest.h"

#include <xxhash.h>

#include <cinttypes>
#include <cstdio>
#include <memory>

namespace insonate {
namespace {

class Digest {
public:
  Digest() : state_(XXH3_createState(), XXH3_freeState) { XXH3_64bits_reset(state_.get()); }
  void add(std::string_view bytes) { XXH3_64bits_update(state_.get(), bytes.data(), bytes.size()); }
  void add(double number) { XXH3_64bits_update(state_.get(), &number, sizeof number); }

  std::string hex() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, std::uint64_t(XXH3_64bits_digest(state_.get())));
    return text;
  }

private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

void add_vector(Digest& digest, const glm::dvec3& v) {
  for (int c = 0; c < 3; ++c) digest.add(v[c]);
}

void add_columns(Digest& digest, const glm::dmat3& m) {
  for (int c = 0; c < 3; ++c) add_vector(digest, m[c]);
}

/// A text with its length, so that "ab" + "c" differs from "a" + "bc".
void add_text(Digest& digest, const std::string& text) {
  digest.add(double(text.size()));
  digest.add(text);
}

template <typename T>
void add_voxels(Digest& digest, const std::vector<T>& voxels) {
  digest.add(std::string_view(reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(T)));
}

}  // namespace

std::string digest_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.hex();
}

std::string digest_of(const Case& subject) {
  Digest digest;
  const Grid& grid = subject.ct.grid;
  add_vector(digest, glm::dvec3(grid.size));
  add_vector(digest, grid.spacing);
  add_vector(digest, grid.origin);
  add_columns(digest, grid.direction);
  add_voxels(digest, subject.ct.voxels);
  add_voxels(digest, subject.labels.voxels);
  for (const Label& label : subject.label_table) {
    digest.add(double(label.value));
    add_text(digest, label.name);
  }
  for (const Landmark& landmark : subject.landmarks) {
    add_text(digest, landmark.name);
    add_vector(digest, landmark.position);
  }
  for (const ReferenceView& view : subject.views) {
    add_text(digest, view.name);
    add_text(digest, view.probe);
    digest.add(view.depth_mm);
    for (const std::string& name : view.landmarks) add_text(digest, name);
    for (const std::string& name : view.targets) add_text(digest, name);
    add_columns(digest, view.patient_from_probe.rotation);
    add_vector(digest, view.patient_from_probe.translation);
  }
  return digest.hex();
}

}  // namespace insonate
