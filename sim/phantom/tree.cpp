#include "sim/phantom/tree.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/core/hash.h"

namespace insonate {
namespace {

constexpr float kStep_mm = 3.0f;  // between the nodes of a branch, as on a tube's spline
constexpr int kMaxSteps = 64;     // of a branch; longer ones have longer steps

// Unlike normalize() it has a value for a vector without length.
glm::vec3 unit(const glm::vec3& v) {
  return v / std::max(glm::length(v), 1e-6f);
}

struct Node {
  glm::vec3 position{0.0f};
  glm::vec3 flow{0.0f};  // unit direction away from the root
  float given_mm = 0;    // a stem's own radius; 0 for a branch
  int parent = -1;       // comes before its children
  int tips = 0;          // fed through this node
  int branches = 0;      // that leave here
  bool may_branch = false;
};

class Tree {
public:
  explicit Tree(const TreeRule& rule) : rule_(rule) {
    for (const Strand& stem : rule.stems) add_stem(stem);
  }

  void grow() {
    const std::vector<glm::vec3> pool = free_points();
    if (pool.empty()) return;
    // Candidates that no vessel reaches are drawn again, which ends when the organ has no room left.
    constexpr int kTriesPerTip = 8;
    int grown = 0;
    for (int attempt = 0; attempt < kTriesPerTip * rule_.tips && grown < rule_.tips; ++attempt)
      grown += reach(emptiest(pool, std::uint32_t(attempt)), std::uint32_t(attempt)) ? 1 : 0;
  }

  std::vector<Strand> strands() const {
    std::vector<float> radii(nodes_.size());
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Node& node = nodes_[n];
      const float fed = rule_.tip_radius_mm * std::cbrt(float(std::max(node.tips, 1)));
      radii[n] = node.given_mm > 0 && node.tips == 0 ? node.given_mm : std::max(node.given_mm, fed);
    }
    std::vector<Strand> strands;
    for (std::size_t s = 0; s < first_.size(); ++s) {
      const std::size_t begin = first_[s], end = s + 1 < first_.size() ? first_[s + 1] : nodes_.size();
      Strand strand;
      const int parent = nodes_[begin].parent;
      if (parent >= 0) strand.push_back({nodes_[std::size_t(parent)].position, radii[begin]});
      for (std::size_t n = begin; n < end; ++n) strand.push_back({nodes_[n].position, radii[n]});
      if (strand.size() > 1) strands.push_back(std::move(strand));
    }
    return strands;
  }

private:
  // Writes the largest distance to `within` and the negative distances to what is kept clear: negative where a vessel
  // of that radius may run.
  std::vector<float> excess(const std::vector<glm::vec3>& positions, float radius) const {
    std::vector<float> x, y, z;
    for (const glm::vec3& p : positions) {
      x.push_back(p.x);
      y.push_back(p.y);
      z.push_back(p.z);
    }
    Points points(std::move(x), std::move(y), std::move(z));
    std::vector<float> out = points.distances_to(*rule_.within);
    for (const ShapePtr& shape : rule_.clear_of) {
      const std::vector<float>& d = points.distances_to(*shape);
      for (std::size_t n = 0; n < out.size(); ++n) out[n] = std::max(out[n], -d[n]);
    }
    for (float& value : out) value += rule_.gap_mm + radius;
    return out;
  }

  void add_stem(const Strand& stem) {
    std::vector<glm::vec3> positions;
    for (const TubePoint& point : stem) positions.push_back(point.position);
    const std::vector<float> outside = excess(positions, 0);
    int parent = nodes_.empty() ? -1 : nearest(positions.front());
    first_.push_back(nodes_.size());
    for (std::size_t n = 0; n < stem.size(); ++n) {
      const glm::vec3 way = positions[std::min(n + 1, stem.size() - 1)] - positions[n == 0 ? 0 : n - 1];
      nodes_.push_back({positions[n], unit(way), stem[n].radius, parent, 0, 0, outside[n] < 0});
      parent = int(nodes_.size()) - 1;
    }
  }

  int nearest(const glm::vec3& p) const {
    int best = 0;
    float least = std::numeric_limits<float>::max();
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const glm::vec3 off = nodes_[n].position - p;
      const float squared = glm::dot(off, off);
      if (squared < least) {
        least = squared;
        best = int(n);
      }
    }
    return best;
  }

  // Random points at which a tip may lie.
  std::vector<glm::vec3> free_points() const {
    constexpr std::uint32_t kDrawn = 6000;
    const Bounds& box = rule_.within->bounds();
    std::vector<glm::vec3> drawn, kept;
    for (std::uint32_t n = 0; n < kDrawn; ++n) {
      const std::uint32_t at = hash(rule_.seed, n);
      const glm::vec3 share(unit_float(hash(at, 0)), unit_float(hash(at, 1)), unit_float(hash(at, 2)));
      drawn.push_back(glm::mix(box.low, box.high, share));
    }
    const std::vector<float> outside = excess(drawn, rule_.tip_radius_mm);
    for (std::size_t n = 0; n < drawn.size(); ++n)
      if (outside[n] < 0) kept.push_back(drawn[n]);
    return kept;
  }

  // Of some candidates, the one farthest from all vessels (Mitchell, "Spectrally optimal sampling for distribution ray
  // tracing", 1991).
  glm::vec3 emptiest(const std::vector<glm::vec3>& pool, std::uint32_t attempt) const {
    constexpr std::uint32_t kCandidates = 10;
    glm::vec3 best{0.0f};
    float most = -1;
    for (std::uint32_t c = 0; c < kCandidates; ++c) {
      const glm::vec3& p = pool[hash(rule_.seed, attempt, c, 1) % pool.size()];
      const glm::vec3 off = nodes_[std::size_t(nearest(p))].position - p;
      if (glm::dot(off, off) > most) {
        most = glm::dot(off, off);
        best = p;
      }
    }
    return best;
  }

  // Adds a branch to a tip. Returns false if there is none that stays where vessels may run.
  bool reach(const glm::vec3& tip, std::uint32_t attempt) {
    int from = -1;
    float least = std::numeric_limits<float>::max();
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Node& node = nodes_[n];
      if (!node.may_branch || node.branches > 1) continue;
      const glm::vec3 way = tip - node.position;
      const float length = glm::length(way);
      const float along = glm::dot(way, node.flow) / std::max(length, 1e-3f);
      if (along < -0.2f) continue;  // no vessel turns back
      const float cost = length * (1.7f - 0.7f * along);
      if (cost < least) {
        least = cost;
        from = int(n);
      }
    }
    if (from < 0) return false;
    const std::vector<glm::vec3> path = path_between(nodes_[std::size_t(from)], tip, attempt);
    if (path.empty()) return false;
    const std::vector<float> outside = excess(path, rule_.tip_radius_mm);
    if (*std::max_element(outside.begin(), outside.end()) >= 0) return false;
    ++nodes_[std::size_t(from)].branches;
    for (int n = from; n >= 0; n = nodes_[std::size_t(n)].parent) ++nodes_[std::size_t(n)].tips;
    first_.push_back(nodes_.size());
    int parent = from;
    for (const glm::vec3& p : path) {
      const glm::vec3 way = p - nodes_[std::size_t(parent)].position;
      // Not at the fork itself, where a second one would make a star.
      nodes_.push_back({p, unit(way), 0, parent, 1, 0, parent != from});
      parent = int(nodes_.size()) - 1;
    }
    return true;
  }

  // A cubic Hermite curve that leaves in a direction between the parent's and the tip's, and arrives with a bend.
  std::vector<glm::vec3> path_between(const Node& from, const glm::vec3& tip, std::uint32_t attempt) const {
    const glm::vec3 way = tip - from.position;
    const float length = glm::length(way);
    if (length < 2 * kStep_mm) return {};
    const auto random = [&](std::uint32_t axis) { return unit_float(hash(rule_.seed, attempt, axis, 2)) - 0.5f; };
    const glm::vec3 leaving = unit(way / length + 0.7f * from.flow) * length;
    const glm::vec3 arriving = unit(way / length + 1.2f * glm::vec3(random(0), random(1), random(2))) * length;
    const int steps = std::min(int(std::ceil(length / kStep_mm)), kMaxSteps);
    std::vector<glm::vec3> path;
    for (int step = 1; step <= steps; ++step) {
      const float t = float(step) / float(steps), u = 1 - t;
      path.push_back(u * u * (1 + 2 * t) * from.position + t * u * u * leaving + t * t * (3 - 2 * t) * tip -
                     t * t * u * arriving);
    }
    return path;
  }

  const TreeRule& rule_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> first_;  // node of each strand
};

}  // namespace

std::vector<Strand> grow_tree(const TreeRule& rule) {
  Tree tree(rule);
  tree.grow();
  return tree.strands();
}

std::vector<Strand> companions(const std::vector<Strand>& strands, const CompanionRule& rule) {
  std::vector<Strand> made;
  for (const Strand& strand : strands) {
    Strand companion;
    for (std::size_t n = 0; n < strand.size(); ++n) {
      const TubePoint& point = strand[n];
      const float radius = std::min(point.radius * rule.share, rule.most_radius_mm);
      if (radius < rule.least_radius_mm) break;  // vessels taper from their first point on
      const glm::vec3 ahead = strand[std::min(n + 1, strand.size() - 1)].position - strand[n == 0 ? 0 : n - 1].position;
      const glm::vec3 tangent = unit(ahead);
      const glm::vec3 across = rule.towards - tangent * glm::dot(rule.towards, tangent);
      const glm::vec3 side = across / std::max(glm::length(across), 1e-3f);
      companion.push_back({point.position + side * (point.radius + rule.gap_mm + radius), radius});
    }
    if (companion.size() > 1) made.push_back(std::move(companion));
  }
  return made;
}

std::vector<Strand> spokes(const SpokesForm& form) {
  // Points of equal share on the sphere: the golden spiral (Gonzalez, Math Geosci 42, 2010), shifted at random by up to
  // a quarter of their distance.
  const float opening_length = glm::length(form.opening);
  const float least_cosine = std::cos(glm::radians(form.opening_deg));
  const auto directions = [&](int on_sphere) {
    std::vector<glm::vec3> kept;
    for (int n = 0; n < on_sphere; ++n) {
      constexpr float kGoldenAngle = 2.39996323f;
      const float z = 1 - (2 * float(n) + 1) / float(on_sphere), around = kGoldenAngle * float(n);
      const float r = std::sqrt(1 - z * z), shift = 0.9f / std::sqrt(float(on_sphere));
      const auto random = [&](std::uint32_t axis) {
        return shift * (2 * unit_float(hash(form.seed, std::uint32_t(n), axis, 3)) - 1);
      };
      const glm::vec3 u =
          unit(glm::vec3(r * std::cos(around) + random(0), r * std::sin(around) + random(1), z + random(2)));
      if (opening_length > 0 && glm::dot(u, form.opening) > least_cosine * opening_length) continue;
      kept.push_back(u);
    }
    return kept;
  };
  int on_sphere = form.count;
  while (int(directions(on_sphere).size()) < form.count) ++on_sphere;
  std::vector<glm::vec3> kept = directions(on_sphere);
  while (int(kept.size()) > form.count)  // those beside the opening are missed least
    kept.erase(std::max_element(kept.begin(), kept.end(), [&](const glm::vec3& a, const glm::vec3& b) {
      return glm::dot(a, form.opening) < glm::dot(b, form.opening);
    }));

  std::vector<Strand> made;
  for (std::size_t n = 0; n < kept.size(); ++n) {
    const float share = 1 - form.vary * unit_float(hash(form.seed, std::uint32_t(n), 0, 4));
    made.push_back({{form.centre + form.inner * kept[n], form.inner_mm},
                    {form.centre + form.outer * kept[n], form.outer_mm * share}});
  }
  return made;
}

}  // namespace insonate
