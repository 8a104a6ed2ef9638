#include "sim/view/body/tissue_classes.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

#include "sim/view/body/distance_map.h"
#include "sim/view/body/voxel_box.h"

namespace insonate::view {
namespace {

// Compact bone is above 300 HU, spongy bone from 100 to 300 HU. Enhanced vessels and kidneys stay below 200 HU in the
// portal phase, in which abdomens are scanned.
constexpr float kBoneFrom_hu = 180, kBoneFull_hu = 320;
// From air to fat. The skin is drawn at the middle, where a voxel is half full.
constexpr float kBodyFrom_hu = -900, kBodyFull_hu = -150;

constexpr OrganColour kBone{{0.90f, 0.85f, 0.73f}, 0.9f};

float ramp(float value, float from, float to) {
  return std::clamp((value - from) / (to - from), 0.0f, 1.0f);
}

/// Sets each voxel to the mean of the CT voxels in it.
void gather(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels, const OrganColours& colours,
            TissueClasses& classes) {
  const Box box{classes.size};
  box.for_each([&](int x, int y, int z, std::size_t at) {
    glm::vec3 colour(0);
    float coverage = 0, opacity = 0, body = 0, density = 0;
    int count = 0;
    const glm::ivec3 first = glm::ivec3(x, y, z) * classes.step;
    const glm::ivec3 end = glm::min(first + classes.step, ct.grid.size);
    for (int k = first.z; k < end.z; ++k)
      for (int j = first.y; j < end.y; ++j)
        for (int i = first.x; i < end.x; ++i, ++count) {
          const std::size_t v = ct.grid.offset({i, j, k});
          const float hu = ct.voxels[v];
          density += hu;
          body += ramp(hu, kBodyFrom_hu, kBodyFull_hu);
          const OrganColour* look = labels.empty() ? nullptr : &colours[labels.voxels[v]];
          const bool labelled = look && look->opacity > 0;
          const float share = labelled ? 1.0f : ramp(hu, kBoneFrom_hu, kBoneFull_hu);
          if (!labelled) look = &kBone;
          colour += share * look->colour;
          coverage += share;
          opacity += share * look->opacity;
        }
    const float n = float(count);
    classes.tissue[at] = {byte(colour.r / n), byte(colour.g / n), byte(colour.b / n), byte(coverage / n)};
    classes.body[at] = {byte(opacity / n), byte(body / n)};
    classes.hu[at] = {std::int16_t(std::lround(density / n))};
  });
}

constexpr std::uint8_t kHalf = 128;

/// Writes `mark` to all voxels reached from `seeds` through neighbours for which `passes` holds, and returns their
/// number.
template <typename Passes>
std::size_t flood(const Box& box, const std::vector<std::size_t>& seeds, std::vector<std::uint8_t>& marks,
                  std::uint8_t mark, const Passes& passes) {
  std::size_t reached = 0;
  const auto take = [&](std::size_t at) {
    if (marks[at] || !passes(at)) return false;
    marks[at] = mark;
    ++reached;
    return true;
  };
  std::vector<std::size_t> front;
  for (std::size_t at : seeds)
    if (take(at)) front.push_back(at);
  while (!front.empty()) {
    const std::size_t at = front.back();
    front.pop_back();
    const std::size_t plane = box.stride(2), row = box.stride(1);
    const int p[3] = {int(at % row), int(at % plane / row), int(at / plane)};
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] > 0 && take(at - box.stride(axis))) front.push_back(at - box.stride(axis));
      if (p[axis] + 1 < box.size[axis] && take(at + box.stride(axis))) front.push_back(at + box.stride(axis));
    }
  }
  return reached;
}

/// Returns whether `passes` holds for one of the six neighbours of a voxel.
template <typename Passes>
bool touches(const Box& box, const glm::ivec3& voxel, const Passes& passes) {
  const std::size_t at = box.offset(voxel.x, voxel.y, voxel.z);
  for (int axis = 0; axis < 3; ++axis) {
    if (voxel[axis] > 0 && passes(at - box.stride(axis))) return true;
    if (voxel[axis] + 1 < box.size[axis] && passes(at + box.stride(axis))) return true;
  }
  return false;
}

/// Makes the body solid: gas within it counts as body, and objects that are not joined to it are removed.
void keep_body(const glm::dmat3& direction, TissueClasses& classes) {
  const Box box{classes.size};
  auto& body = classes.body;
  const auto is_air = [&](std::size_t at) { return body[at][1] < kHalf; };
  const auto is_body = [&](std::size_t at) { return body[at][1] >= kHalf; };

  // Flood from the sides only: a lung or bowel that the scan's top or bottom cuts open stays part of the body.
  std::vector<std::size_t> rim;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis].z) > 0.7) continue;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int side : {0, box.size[axis] - 1})
      for (int a = 0; a < box.size[u]; ++a)
        for (int b = 0; b < box.size[v]; ++b) {
          glm::ivec3 p;
          p[axis] = side;
          p[u] = a;
          p[v] = b;
          rim.push_back(box.offset(p.x, p.y, p.z));
        }
  }
  enum : std::uint8_t { kUnknown, kAround, kEdge, kPart };
  std::vector<std::uint8_t> marks(box.count(), kUnknown);
  flood(box, rim, marks, kAround, is_air);

  // A sheet on which the patient lies touches the body and is thinner than any part of it: with the outermost voxels
  // taken away, nothing joins the two.
  const std::vector<std::uint8_t> around = marks;
  box.for_each([&](int x, int y, int z, std::size_t at) {
    if (!around[at] && touches(box, {x, y, z}, [&](std::size_t beside) { return around[beside] == kAround; }))
      marks[at] = kEdge;
  });
  std::size_t largest = 0, seed = 0;
  for (std::size_t at = 0; at < marks.size(); ++at)
    if (!marks[at] && is_body(at))
      if (const std::size_t n = flood(box, {at}, marks, kPart, [](std::size_t) { return true; }); n > largest) {
        largest = n;
        seed = at;
      }
  if (!largest) return;
  std::vector<std::uint8_t> kept(box.count(), 0);
  flood(box, {seed}, kept, 1, [&](std::size_t at) { return marks[at] == kPart; });
  // The outermost voxels again. At a corner they are two deep.
  for (int times = 0; times < 2; ++times) {
    const std::vector<std::uint8_t> before = kept;
    box.for_each([&](int x, int y, int z, std::size_t at) {
      if (marks[at] == kEdge && touches(box, {x, y, z}, [&](std::size_t beside) { return before[beside] == 1; }))
        kept[at] = 1;
    });
  }

  // Partial volume stays on both sides of the surface. The surface thus keeps its true position, not that of a voxel's
  // face.
  std::vector<std::uint8_t> solid(box.count());
  box.for_each([&](int x, int y, int z, std::size_t at) {
    bool same = true;
    for (int axis = 0; axis < 3; ++axis) {
      const int p = axis == 0 ? x : axis == 1 ? y : z;
      if (p > 0) same = same && kept[at - box.stride(axis)] == kept[at];
      if (p + 1 < box.size[axis]) same = same && kept[at + box.stride(axis)] == kept[at];
    }
    solid[at] = !same ? body[at][1] : kept[at] ? 255 : 0;
    if (!same && kept[at]) solid[at] = std::max(solid[at], kHalf);  // gas against the skin
  });
  for (std::size_t at = 0; at < solid.size(); ++at) {
    body[at][1] = solid[at];
    if (solid[at] > 0) continue;
    body[at][0] = 0;
    classes.tissue[at] = {};
  }
}

/// Returns 1 for each block that holds, or has within one voxel, tissue or the body's surface; else 0.
std::vector<std::uint8_t> busy_blocks(const TissueClasses& classes) {
  const Box box{classes.size}, blocks{classes.blocks};
  std::vector<std::uint8_t> busy(blocks.count(), 0);
  blocks.for_each([&](int bx, int by, int bz, std::size_t block) {
    const glm::ivec3 first = glm::ivec3(bx, by, bz) * TissueClasses::kBlock;
    const glm::ivec3 low = glm::max(first - 1, glm::ivec3(0));
    const glm::ivec3 high = glm::min(first + TissueClasses::kBlock + 1, classes.size);
    const std::uint8_t inside = classes.body[box.offset(low.x, low.y, low.z)][1];
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x) {
          const auto& [opacity, body] = classes.body[box.offset(x, y, z)];
          if (opacity > 0 || body != inside) busy[block] = 1;
        }
  });
  return busy;
}

}  // namespace

TissueClasses classify_tissue(const Volume<std::int16_t>& ct, const Volume<std::uint8_t>& labels,
                              const OrganColours& colours) {
  TissueClasses classes;
  classes.step = view_step(ct.grid);
  classes.size = (ct.grid.size + classes.step - 1) / classes.step;
  classes.blocks = (classes.size + TissueClasses::kBlock - 1) / TissueClasses::kBlock;
  const Box box{classes.size};
  classes.tissue.resize(box.count());
  classes.body.resize(box.count());
  classes.hu.resize(box.count());
  gather(ct, labels, colours, classes);
  keep_body(ct.grid.direction, classes);
  smooth(box, classes.tissue);
  smooth(box, classes.body);
  // With fewer passes the layers of a CT of 3 mm show in the light; with more, muscles look flat.
  for (int times = 0; times < 4; ++times) smooth(box, classes.hu);
  classes.distance = distance_map(classes.blocks, busy_blocks(classes));
  return classes;
}

std::vector<std::uint8_t> cells_outside_body(const TissueClasses& classes, const glm::ivec3& cells, int side) {
  const Box box{classes.size}, grid{cells};
  std::vector<std::uint8_t> outside(grid.count(), 1);
  grid.for_each([&](int cx, int cy, int cz, std::size_t cell) {
    // A linear sample within the cell uses voxels up to one beyond those that contain its faces.
    const glm::ivec3 first = glm::ivec3(cx, cy, cz) * side;
    const glm::ivec3 low = glm::max(first / classes.step - 1, glm::ivec3(0));
    const glm::ivec3 high = glm::min((first + side) / classes.step + 2, classes.size);
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x)
          if (classes.body[box.offset(x, y, z)][1] > 0) outside[cell] = 0;
  });
  return outside;
}

}  // namespace insonate::view
