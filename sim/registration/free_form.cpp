#include "sim/registration/free_form.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sim/wein/wein_simulator.h"

namespace insonate {
namespace {

// A single control point moves the tissue at its place by (2/3)^3 of its own way, here by 1 mm: long enough to bridge
// the steps of pixels and voxels.
constexpr double kVaried_mm = 27.0 / 8;
constexpr double kMinCurvature = 0.5;  // of the mean over the control points that patches depend on
// Steps that are tried: of these lengths, and smoothed by so many times the weight at which the bending of one control
// point counts as much as its similarity.
constexpr std::array<double, 4> kLengths{0.3, 0.6, 1, 1.5}, kSmoothings{0, 1, 10, 100};
constexpr double kMinGain = 1e-3;  // of a round

using Controls = std::vector<glm::dvec3>;
using Sparse = Eigen::SparseMatrix<double>;

// The LC2 of some images under fields of one grid.
class DeformedSweep {
public:
  DeformedSweep(gl::WeinSimulator& simulator, const TrackedSweep& sweep, const glm::dmat4& ct_from_sweep,
                const FreeFormField& grid, const FreeFormSettings& settings)
      : simulator_(simulator), sweep_(sweep), turned_(ct_from_sweep), settings_(settings) {
    std::vector<Image<float>> grey;
    for (const SweepImage& image : sweep.images) {
      grey.push_back(image.grey);
      places_.push_back(ct_from_sweep * image.sweep_from_probe.matrix());
    }
    simulator.set_ultrasound(grey);
    const std::vector<double>& variation = simulator.ultrasound_variation();
    double all = 0;
    for (const double each : variation) all += each;
    for (const double each : variation) share_of_image_.push_back(all > 0 ? each / all : 0);
    const std::vector<glm::dvec3>& nodes = simulator.bend_nodes();
    nodes_.resize(nodes.size() * sweep.images.size());
    tbb::parallel_for(std::size_t(0), nodes_.size(), [&](std::size_t i) {
      nodes_[i] = weights_at(grid, sweep.images[i / nodes.size()].sweep_from_probe.point(nodes[i % nodes.size()]));
    });
    place_patches(grid);
  }

  /// A patch with pixels that count.
  struct Patch {
    std::size_t value;  // index into values of one evaluation
    SplineWeights weights;
  };
  const std::vector<Patch>& patches() const { return patches_; }
  double share_of_image(std::size_t i) const { return share_of_image_[i]; }
  std::size_t patches_of_image() const {
    return std::size_t(simulator_.patches_across()) * std::size_t(simulator_.patches_down());
  }

  std::vector<glm::vec3> displacements(const Controls& controls) const {
    std::vector<glm::vec3> result(nodes_.size());
    tbb::parallel_for(std::size_t(0), nodes_.size(), [&](std::size_t i) {
      glm::dvec3 sum(0.0);
      for (std::size_t n = 0; n < 64; ++n)
        if (nodes_[i].control[n] >= 0) sum += double(nodes_[i].weight[n]) * controls[std::size_t(nodes_[i].control[n])];
      result[i] = glm::vec3(sum);
    });
    return result;
  }
  /// Adds the displacement that the control points of one entry of SplineWeights make together.
  void vary(std::vector<glm::vec3>& displacements, std::size_t entry, const glm::vec3& by) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) displacements[i] += nodes_[i].weight[entry] * by;
  }

  /// Evaluates displacements in as few calls as memory allows. `displacements_of(i)` returns those of the nodes, and
  /// `use(i, values)` gets what the patches add to the similarity, image by image.
  template <typename DisplacementsOf, typename Use>
  void evaluate(std::size_t count, DisplacementsOf&& displacements_of, Use&& use) {
    const std::size_t images = sweep_.images.size(),
                      together = std::max<std::size_t>(std::size_t(settings_.batch) / images, 1);
    for (std::size_t first = 0; first < count; first += together) {
      if (settings_.between_calls) settings_.between_calls();
      const std::size_t n = std::min(together, count - first);
      std::vector<glm::dmat4> places;
      for (std::size_t i = 0; i < n; ++i) places.insert(places.end(), places_.begin(), places_.end());
      std::vector<glm::vec3> bends(n * nodes_.size());
      const glm::mat3 turned(turned_);
      tbb::parallel_for(std::size_t(0), n, [&](std::size_t i) {
        const std::vector<glm::vec3> moved = displacements_of(first + i);
        std::ranges::transform(moved, bends.begin() + std::ptrdiff_t(i * moved.size()),
                               [&](const glm::vec3& each) { return turned * each; });
      });
      const std::vector<float> shares = simulator_.patch_similarity(places, bends);
      const std::size_t of_image = patches_of_image(), of_one = images * of_image;
      std::vector<double> values(of_one);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t v = 0; v < of_one; ++v) values[v] = share_of_image_[v / of_image] * shares[i * of_one + v];
        use(first + i, values);
      }
    }
  }

private:
  void place_patches(const FreeFormField& grid) {
    const Image<float>& first = sweep_.images.front().grey;
    const ImageGeometry geometry = image_geometry(sweep_.probe, sweep_.depth_mm, first.width, first.height);
    const int side = settings_.wein.similarity_patch;
    for (std::size_t image = 0; image < sweep_.images.size(); ++image)
      for (int row = 0; row < simulator_.patches_down(); ++row)
        for (int column = 0; column < simulator_.patches_across(); ++column) {
          glm::dvec2 sum(0.0);
          double count = 0;
          for (int y = side * row; y < std::min(side * (row + 1), first.height); ++y)
            for (int x = side * column; x < std::min(side * (column + 1), first.width); ++x) {
              if (!simulator_.inside().at(x, y) || std::isnan(sweep_.images[image].grey.at(x, y))) continue;
              sum += geometry.plane_mm(x, y);
              ++count;
            }
          if (count == 0) continue;
          const glm::dvec3 middle = sweep_.images[image].sweep_from_probe.point(glm::dvec3(sum / count, 0));
          patches_.push_back({image * patches_of_image() + std::size_t(row * simulator_.patches_across() + column),
                              weights_at(grid, middle)});
        }
  }

  gl::WeinSimulator& simulator_;
  const TrackedSweep& sweep_;
  glm::mat3 turned_;  // directions of the sweep in the CT
  const FreeFormSettings& settings_;
  std::vector<glm::dmat4> places_;
  std::vector<double> share_of_image_;
  std::vector<SplineWeights> nodes_;
  std::vector<Patch> patches_;
};

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double each : values) sum += each;
  return sum;
}

// First and second derivatives of the similarity by each coordinate of each control point.
struct Derivatives {
  Controls first, second;
};

class Fit {
public:
  Fit(DeformedSweep& sweep, FreeFormRegistration& result, const FreeFormSettings& settings)
      : sweep_(sweep), result_(result), settings_(settings) {
    const FreeFormField& field = result.field;
    const int count = int(field.control_mm.size());
    std::vector<Eigen::Triplet<double>> bending, products;
    const auto index = [&](const glm::ivec3& i) { return (i.z * field.size.y + i.y) * field.size.x + i.x; };
    const double scale = 1 / (field.spacing_mm * field.covered_mm3()), own = SplineProducts::value(glm::ivec3(0));
    for_each_pair(field.size, [&](const glm::ivec3& i, const glm::ivec3& j) {
      bending.emplace_back(index(i), index(j), scale * SplineProducts::bending(j - i));
      products.emplace_back(index(i), index(j), SplineProducts::value(j - i) / own);
    });
    bending_.resize(count, count);
    bending_.setFromTriplets(bending.begin(), bending.end());
    products_.resize(count, count);
    products_.setFromTriplets(products.begin(), products.end());
  }

  void run() {
    Controls at = result_.field.control_mm;
    double goal = 0;
    for (result_.rounds = 0; result_.rounds < settings_.rounds; ++result_.rounds) {
      const Derivatives derivatives = derivatives_at(at);
      if (result_.rounds == 0) goal = result_.fitted_before = result_.fitted_after = similarity_;
      std::vector<Controls> steps;
      for (const double smoothing : kSmoothings) steps.push_back(newton_step(at, derivatives, smoothing));
      const double before = goal;
      if (!take_best_step(at, steps, goal) || goal - before < kMinGain) break;
    }
    result_.field.control_mm = at;
  }

private:
  template <typename Work>
  static void for_each_pair(const glm::ivec3& size, Work&& work) {
    for (int k = 0; k < size.z; ++k)
      for (int j = 0; j < size.y; ++j)
        for (int i = 0; i < size.x; ++i)
          for (int c = std::max(k - 3, 0); c <= std::min(k + 3, size.z - 1); ++c)
            for (int b = std::max(j - 3, 0); b <= std::min(j + 3, size.y - 1); ++b)
              for (int a = std::max(i - 3, 0); a <= std::min(i + 3, size.x - 1); ++a)
                work(glm::ivec3(i, j, k), glm::ivec3(a, b, c));
  }

  double bending_energy(const Controls& controls) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd along = coordinates(controls, axis);
      sum += along.dot(bending_ * along);
    }
    return sum;
  }

  static Eigen::VectorXd coordinates(const Controls& controls, int axis) {
    Eigen::VectorXd result(Eigen::Index(controls.size()));
    for (std::size_t i = 0; i < controls.size(); ++i) result[Eigen::Index(i)] = controls[i][axis];
    return result;
  }

  Derivatives derivatives_at(const Controls& controls) {
    const std::vector<glm::vec3> base = sweep_.displacements(controls);
    const double bending = bending_energy(controls);
    Derivatives result{Controls(controls.size(), glm::dvec3(0.0)), Controls(controls.size(), glm::dvec3(0.0))};
    std::array<bool, 64> used{};
    for (const DeformedSweep::Patch& patch : sweep_.patches())
      for (std::size_t n = 0; n < 64; ++n) used[n] = used[n] || patch.weights.control[n] >= 0;
    struct Variation {
      std::size_t entry;
      int axis;
      double by;
    };
    std::vector<Variation> variations;
    for (std::size_t entry = 0; entry < 64; ++entry)
      for (int axis = 0; axis < 3 && used[entry]; ++axis)
        for (const double by : {kVaried_mm, -kVaried_mm}) variations.push_back({entry, axis, by});
    std::vector<double> here;
    sweep_.evaluate(
        1 + variations.size(),
        [&](std::size_t i) {
          std::vector<glm::vec3> moved = base;
          if (i == 0) return moved;
          glm::vec3 by(0.0f);
          by[variations[i - 1].axis] = float(variations[i - 1].by);
          sweep_.vary(moved, variations[i - 1].entry, by);
          return moved;
        },
        [&](std::size_t i, const std::vector<double>& values) {
          result_.evaluations.push_back({sum_of(values), bending, i > 0});
          if (i == 0) {
            here = values;
            similarity_ = sum_of(values);
            return;
          }
          const auto& [entry, axis, by] = variations[i - 1];
          for (const DeformedSweep::Patch& patch : sweep_.patches()) {
            const int control = patch.weights.control[entry];
            if (control < 0) continue;
            const double change = values[patch.value] - here[patch.value];
            result.first[std::size_t(control)][axis] += change / (2 * by);
            result.second[std::size_t(control)][axis] += change / (by * by);
          }
        });
    return result;
  }

  // Maximises the quadratic model of the goal. The similarity's second derivatives by two control points are those by
  // each, times what their splines have in common.
  Controls newton_step(const Controls& at, const Derivatives& derivatives, double smoothing) const {
    Controls step(at.size());
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::VectorXd curvature = -coordinates(derivatives.second, axis);
      double sum = 0, count = 0;
      for (const double each : curvature) {
        sum += std::abs(each);
        count += each != 0;
      }
      const double least = count > 0 ? kMinCurvature * sum / count : 0;
      const double smoother = count > 0 ? smoothing * sum / count / bending_.coeff(0, 0) : 0;
      for (double& each : curvature) each = each != 0 ? std::sqrt(std::max(each, least)) : 0;
      const double tiny = 1e-6 * std::max(curvature.squaredNorm(), 1e-12);
      Sparse system = curvature.asDiagonal() * products_ * curvature.asDiagonal();
      system += (2 * settings_.smoothness_mm2 + smoother) * bending_;
      for (Eigen::Index i = 0; i < curvature.size(); ++i) system.coeffRef(i, i) += tiny;
      const Eigen::VectorXd uphill =
          coordinates(derivatives.first, axis) - 2 * settings_.smoothness_mm2 * (bending_ * coordinates(at, axis));
      const Eigen::SimplicialLDLT<Sparse> solver(system);
      if (solver.info() != Eigen::Success) throw std::runtime_error("a step of the deformation cannot be computed");
      const Eigen::VectorXd along = solver.solve(uphill);
      for (std::size_t i = 0; i < step.size(); ++i) step[i][axis] = along[Eigen::Index(i)];
    }
    return step;
  }

  // Returns false if none of the steps leads higher, at any length.
  bool take_best_step(Controls& at, const std::vector<Controls>& steps, double& goal) {
    std::vector<Controls> tried;
    for (const Controls& step : steps)
      for (const double length : kLengths) {
        FreeFormField field = result_.field;
        for (std::size_t i = 0; i < at.size(); ++i) field.control_mm[i] = at[i] + length * step[i];
        if (field.least_jacobian() < settings_.least_jacobian) break;  // longer steps fold more
        tried.push_back(std::move(field.control_mm));
      }
    std::vector<double> similar(tried.size());
    sweep_.evaluate(
        tried.size(), [&](std::size_t i) { return sweep_.displacements(tried[i]); },
        [&](std::size_t i, const std::vector<double>& values) {
          similar[i] = sum_of(values);
          result_.evaluations.push_back({similar[i], bending_energy(tried[i]), false});
        });
    bool is_higher = false;
    for (std::size_t i = 0; i < tried.size(); ++i) {
      const double value = similar[i] - settings_.smoothness_mm2 * bending_energy(tried[i]);
      if (value <= goal) continue;
      goal = value;
      at = tried[i];
      result_.fitted_after = similar[i];
      is_higher = true;
    }
    return is_higher;
  }

  DeformedSweep& sweep_;
  FreeFormRegistration& result_;
  const FreeFormSettings& settings_;
  Sparse bending_, products_;  // the energy is c . bending c per axis; products have 1 on the diagonal
  double similarity_ = 0;      // at the middle of the last derivatives
};

// Compares the images that were not fitted before and after.
void judge(DeformedSweep& held_out, FreeFormRegistration& result, std::size_t images) {
  std::vector<double> before(images), after(images);
  const std::vector<glm::vec3> moved = held_out.displacements(result.field.control_mm),
                               none(moved.size(), glm::vec3(0.0f));
  held_out.evaluate(
      2, [&](std::size_t i) { return i == 0 ? none : moved; },
      [&](std::size_t i, const std::vector<double>& values) {
        for (std::size_t v = 0; v < values.size(); ++v)
          (i == 0 ? before : after)[v / held_out.patches_of_image()] += values[v];
      });
  result.held_out_before = sum_of(before);
  result.held_out_after = sum_of(after);
  // Each image adds its share of the weight times its own change. The standard error is that of such a weighted mean.
  const double mean = result.held_out_after - result.held_out_before;
  double squares = 0;
  for (std::size_t i = 0; i < images; ++i) {
    const double off = after[i] - before[i] - held_out.share_of_image(i) * mean;
    squares += off * off;
  }
  result.held_out_error = std::sqrt(squares * double(images) / double(images - 1));
}

}  // namespace

FreeFormRegistration fit_free_form(const AcousticVolume& volume, const TrackedSweep& sweep,
                                   const glm::dmat4& ct_from_sweep, const FreeFormSettings& settings) {
  const auto begin = std::chrono::steady_clock::now();
  if (settings.wein.similarity_patch == 0) throw std::invalid_argument("a deformation needs LC2 over patches");
  if (sweep.images.size() < kMinFreeFormImages) throw std::invalid_argument("a deformation needs 4 images or more");
  TrackedSweep fitted{Probe(sweep.probe), sweep.depth_mm, {}}, held_out = fitted;
  for (std::size_t i = 0; i < sweep.images.size(); ++i)
    (i % 2 == 0 ? fitted : held_out).images.push_back(sweep.images[i]);
  FreeFormRegistration result;
  const std::vector<glm::dvec3> targets = target_points(sweep);
  result.field = field_over(targets, settings.spacing_mm);
  if (result.field.control_mm.size() > kMaxControlPoints)
    throw std::invalid_argument("a deformation has too many control points");
  WeinSettings wein = settings.wein;
  wein.image_width = sweep.images.front().grey.width;
  wein.image_height = sweep.images.front().grey.height;
  gl::WeinSimulator simulator(volume, sweep.probe, sweep.depth_mm, wein);
  {
    DeformedSweep deformed(simulator, fitted, ct_from_sweep, result.field, settings);
    Fit(deformed, result, settings).run();
  }
  DeformedSweep judged(simulator, held_out, ct_from_sweep, result.field, settings);
  judge(judged, result, held_out.images.size());
  result.least_jacobian = result.field.least_jacobian();
  for (const glm::dvec3& target : targets)
    result.most_mm = std::max(result.most_mm, glm::length(result.field.displacement(target)));
  if (!result.is_improved()) result.field = field_over(targets, settings.spacing_mm);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace insonate
