#include "sim/phantom/phantom.h"

#include <glm/geometric.hpp>
#include <tbb/blocked_range3d.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "sim/phantom/plan.h"
#include "sim/phantom/recipe.h"
#include "sim/phantom/texture.h"

namespace insonate {
namespace {

// The side of a block of points. It is small enough that most shapes are out of its range, and large enough to share
// the search for those that are not.
constexpr double kBlock_mm = 8;

// Reports progress when it has grown by a hundredth, from one thread at a time.
class ProgressCounter {
public:
  ProgressCounter(const Progress& report, std::size_t total) : report_(report), total_(total) {}

  void one_done() {
    const std::size_t done = ++done_;
    if (!report_ || done * 100 / total_ == (done - 1) * 100 / total_) return;
    const std::lock_guard lock(mutex_);
    if (done <= reported_) return;
    reported_ = done;
    report_(double(done) / double(total_));
  }

private:
  const Progress& report_;
  std::size_t total_;
  std::atomic<std::size_t> done_ = 0;
  std::mutex mutex_;
  std::size_t reported_ = 0;
};

class Painter {
public:
  explicit Painter(const PhantomPlan& plan) : plan_(plan) {
    for (const PaintedLabel& label : plan.labels)
      textures_.emplace_back(hash(plan.seed, label.label.value), label.grain_mm);
  }

  void paint(const glm::ivec3& first, const glm::ivec3& last, Case& subject) const {
    const Grid& grid = plan_.grid;
    std::vector<std::size_t> offsets;
    std::vector<float> x, y, z;
    for (int k = first.z; k < last.z; ++k)
      for (int j = first.y; j < last.y; ++j)
        for (int i = first.x; i < last.x; ++i) {
          const glm::dvec3 p = grid.patient_from_index(glm::dvec3(i, j, k));
          offsets.push_back(grid.offset({i, j, k}));
          x.push_back(float(p.x));
          y.push_back(float(p.y));
          z.push_back(float(p.z));
        }
    Points points(std::move(x), std::move(y), std::move(z));

    // Traverse from the last shape, which displaces all others, back to the first. The share that is still free shows
    // the next shape below.
    std::vector<float> hu(points.count(), 0.0f), free(points.count(), 1.0f);
    std::vector<int> owner(points.count(), -1);  // the shape whose label the point gets
    const auto pitch = float(grid.spacing.x);
    for (int index = int(plan_.shapes.size()) - 1; index >= 0; --index) {
      const PaintedShape& painted = plan_.shapes[std::size_t(index)];
      const DistanceRange range = points.range_of(*painted.shape);
      if (range.least > 0.5f * pitch) continue;
      const float own_hu = plan_.labels[painted.label].hu;
      if (range.most < -0.5f * pitch) {
        for (std::size_t n = 0; n < points.count(); ++n) {
          hu[n] += free[n] * own_hu;
          free[n] = 0;
          if (owner[n] < 0) owner[n] = index;
        }
        break;
      }
      const std::vector<float>& distance = points.distances_to(*painted.shape);
      float most_free = 0;
      for (std::size_t n = 0; n < points.count(); ++n) {
        const float share = free[n] * std::clamp(0.5f - distance[n] / pitch, 0.0f, 1.0f);
        hu[n] += share * own_hu;
        free[n] -= share;
        if (owner[n] < 0 && distance[n] < 0) owner[n] = index;
        most_free = std::max(most_free, free[n]);
      }
      if (most_free < 1e-4f) break;
    }

    for (std::size_t n = 0; n < points.count(); ++n) hu[n] += free[n] * float(kAir_hu);
    add_textures(points, owner, hu);
    for (std::size_t n = 0; n < points.count(); ++n) {
      if (owner[n] >= 0) subject.labels.voxels[offsets[n]] = label_of(owner[n]).label.value;
      subject.ct.voxels[offsets[n]] = std::int16_t(std::clamp(std::round(hu[n]), -1024.0f, 32767.0f));
    }
  }

private:
  const PaintedLabel& label_of(int owner) const { return plan_.labels[plan_.shapes[std::size_t(owner)].label]; }

  // Adds the texture of each label, or the septa of a shape that has them: either is evaluated fastest for many points
  // at once.
  void add_textures(Points& points, const std::vector<int>& owner, std::vector<float>& hu) const {
    std::vector<bool> done(owner.size(), false);
    std::vector<std::size_t> alike;
    for (std::size_t first = 0; first < owner.size(); ++first) {
      if (owner[first] < 0 || done[first]) continue;
      const PaintedShape& shape = plan_.shapes[std::size_t(owner[first])];
      alike.clear();
      for (std::size_t n = first; n < owner.size(); ++n) {
        if (owner[n] < 0 || done[n]) continue;
        const PaintedShape& other = plan_.shapes[std::size_t(owner[n])];
        if (other.label != shape.label || other.septa != shape.septa) continue;
        alike.push_back(n);
        done[n] = true;
      }
      const float deviation = plan_.labels[shape.label].texture_hu;
      if (shape.septa) {
        const std::vector<float> septa = shape.septa->at(points, alike);
        for (std::size_t n = 0; n < alike.size(); ++n) hu[alike[n]] += septa[n];
      } else if (deviation > 0) {
        const std::vector<float> texture = textures_[shape.label].at(points, alike);
        for (std::size_t n = 0; n < alike.size(); ++n) hu[alike[n]] += deviation * texture[n];
      }
    }
  }

  const PhantomPlan& plan_;
  std::vector<Texture> textures_;
};

// Returns the pose of a probe pressed into the skin. The skin is the last boundary of the body along the beam, from the
// aim backwards.
Pose pose_on_skin(const PlannedView& planned, const Volume<std::int16_t>& ct, const std::string& recipe_name) {
  constexpr double kSkin_hu =
      -500;  // half way between air and soft tissue: within a fraction of a voxel of the surface
  const double step = ct.grid.spacing.x / 4;
  const double longest = glm::length(ct.grid.spacing * glm::dvec3(ct.grid.size));
  double skin = -1;
  for (int n = 0; step * n < longest; ++n) {
    const double way = step * n;
    const glm::dvec3 p = planned.aim - planned.beam * way;
    if (sample_trilinear(ct, ct.grid.index_from_patient(p)) > kSkin_hu) skin = way;
  }
  const double face = skin - planned.press_mm;
  if (face <= 0)
    throw InputError(recipe_name, "view '" + planned.view.name + "'", "what it aims at does not lie under the skin",
                     "move the aim into the body or press less");
  Pose pose;
  pose.translation = planned.aim - planned.beam * face;
  pose.rotation = glm::dmat3(planned.marker, planned.beam, glm::cross(planned.marker, planned.beam));
  return pose;
}

}  // namespace

Case make_phantom(const std::string& recipe_name, const std::string& recipe_text,
                  const std::vector<std::pair<std::string, std::string>>& options, const Progress& progress) {
  const Recipe recipe(recipe_name, recipe_text, options);
  const PhantomPlan plan = plan_phantom(recipe);

  Case subject;
  subject.name = plan.name;
  subject.ct.grid = subject.labels.grid = plan.grid;
  subject.ct.voxels.resize(plan.grid.count());
  subject.labels.voxels.resize(plan.grid.count());
  subject.landmarks = plan.landmarks;
  for (const PaintedLabel& label : plan.labels) subject.label_table.push_back(label.label);

  const int block = std::max(2, int(std::lround(kBlock_mm / plan.grid.spacing.x)));  // voxels per side
  const glm::ivec3 blocks = (plan.grid.size + block - 1) / block;
  ProgressCounter counter(progress, std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z));
  const Painter painter(plan);
  tbb::parallel_for(tbb::blocked_range3d<int>(0, blocks.z, 0, blocks.y, 0, blocks.x),
                    [&](const tbb::blocked_range3d<int>& range) {
                      for (int k = range.pages().begin(); k < range.pages().end(); ++k)
                        for (int j = range.rows().begin(); j < range.rows().end(); ++j)
                          for (int i = range.cols().begin(); i < range.cols().end(); ++i) {
                            const glm::ivec3 first = glm::ivec3(i, j, k) * block;
                            painter.paint(first, glm::min(first + block, plan.grid.size), subject);
                            counter.one_done();
                          }
                    });

  for (const PlannedView& planned : plan.views) {
    subject.views.push_back(planned.view);
    subject.views.back().patient_from_probe = pose_on_skin(planned, subject.ct, recipe_name);
  }
  return subject;
}

}  // namespace insonate
