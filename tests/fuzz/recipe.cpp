// Recipes of phantoms; small ones are made too.
#include <algorithm>

#include "sim/phantom/phantom.h"
#include "sim/phantom/plan.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

constexpr std::size_t kMaxMade = 1000;  ///< voxels: larger ones take the fuzzer's time and show nothing new

const Target recipe_target("recipe", [](std::string_view bytes) -> std::string {
  const std::string text(bytes);
  const PhantomPlan plan = plan_phantom(Recipe("fuzzed.toml", text, {}));
  if (plan.labels.empty() || plan.labels.size() > 255) return "it has no labels, or too many";
  for (const PaintedShape& shape : plan.shapes)
    if (!shape.shape || shape.label >= plan.labels.size()) return "a shape has no label";
  for (int axis = 0; axis < 3; ++axis)
    if (plan.grid.size[axis] < 1 || !(plan.grid.spacing[axis] > 0)) return "the grid is empty";
  if (plan.grid.count() > kMaxMade) return "";
  const Case subject = make_phantom("fuzzed.toml", text);
  if (subject.ct.voxels.size() != plan.grid.count() || subject.labels.voxels.size() != plan.grid.count())
    return "the volumes are not as large as the grid";
  if (std::any_of(subject.ct.voxels.begin(), subject.ct.voxels.end(), [](int hu) { return hu < -1024; }))
    return "a voxel is thinner than a vacuum";
  for (const ReferenceView& view : subject.views)
    if (why_not_rigid(view.patient_from_probe.matrix())) return "a view is not rigid";
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
