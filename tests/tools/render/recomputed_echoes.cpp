// Recomputes what follows from R, I and the scatterers' echo: beam width, reverberation and the envelope.

#include "tests/tools/render/recomputation.h"

namespace outsider {
namespace {

const double kPi = std::acos(-1.0);

class Echoes : public Recomputation {
public:
  Echoes(const StageFolder& stages, const Tolerances& tolerances)
      : Recomputation(stages), tolerances_(tolerances), l_(setting("reflection_length_mm")) {}

  void all() {
    beam();
    if (planes_.count("repeated")) reverberation();
    speckle();
  }

private:
  /// Returns the window over the lines of the aperture. Nothing beyond the outer lines is part of it.
  std::vector<double> weights() const {
    const int half = (set_.at("beam_lines").get<int>() - 1) / 2;
    const std::string shape = set_.at("beam_window");
    std::vector<double> all;
    for (int j = -half; j <= half; ++j) {
      const double t = j / (half + 1.0);
      all.push_back(shape == "hann" ? std::pow(std::cos(kPi * t / 2), 2) : shape == "triangle" ? 1 - std::abs(t) : 1);
    }
    double sum = 0;
    for (double weight : all) sum += weight;
    for (double& weight : all) weight /= sum;
    return all;
  }
  double across_lines(const Plane& from, int line, int k) const {
    const int half = int(weights_.size()) / 2;
    double sum = 0, total = 0;
    for (int j = std::max(-half, -line); j <= std::min(half, n_ - 1 - line); ++j) {
      sum += weights_[std::size_t(j + half)] * from.at(line + j, k);
      total += weights_[std::size_t(j + half)];
    }
    return sum / total;
  }

  /// Recomputes (4) from R.
  void beam() {
    weights_ = weights();
    for (std::size_t i = 0; i < weights_.size(); ++i)
      compare("beam_weights", weights_[i], about_.at("beam_weights").at(i), 1e-12);
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k) {
        // Sums of positive numbers: in single precision each term costs one or two roundings.
        const double expected = across_lines(plane("reflection"), line, k);
        compare("reflection_beam", expected, plane("reflection_beam").at(line, k),
                4 * kFloat * double(weights_.size()) * expected + 1e-30);
      }
  }

  static double b_spline(double x) {
    const double a = std::abs(x);
    return a >= 2 ? 0 : a >= 1 ? (2 - a) * (2 - a) * (2 - a) / 6 : 2.0 / 3 - a * a + a * a * a / 2;
  }

  /// Recomputes reverberation from I and R of each line in the slice's middle plane, after the same window as R.
  void reverberation() {
    const auto& about = about_.at("reverberation");
    const auto& planes = about_.at("slice_planes");
    const std::string middle = planes.at(planes.size() / 2).at("folder");
    const std::string prefix = middle.empty() ? "" : middle + "/";
    const Plane &passing = plane(prefix + "transmission"), &reflected = plane(prefix + "reflection");
    const double least_round = about.at("least_round"), least_from_face = about.at("least_from_face");
    const double least_reverberant = about.at("least_reverberant");
    const int most_repeats = about.at("most_repeats"), most_reflectors = about.at("most_reflectors");
    const double share = std::min(dr_ / l_, 1.0);
    const int near = std::max(int(std::ceil(l_ / dr_ - 1e-3)), 1);  // nearer samples belong to the same interface
    const auto counted = [&](double round, double least) {
      return round > least ? round * std::pow(1 - std::pow(least / round, 2), 8) : 0;
    };
    Plane repeats = plane("repeated");
    for (double& v : repeats.values) v = 0;
    for (int line = 0; line < n_; ++line) {
      const auto i_at = [&](int k) { return passing.at(line, std::clamp(k, 0, d_ - 1)); };
      const auto reflects = [&](int k) {
        return i_at(k) > least_reverberant ? reflected.at(line, k) / (i_at(k) * i_at(k)) : 0;
      };
      // Adds the repeats of sample k from sound that makes round trips of length `way`.
      const auto ring = [&](int k, double way, double echo, double gain) {
        for (int n = 1; n <= most_repeats && gain > 0; ++n) {
          echo *= gain;
          const double at = k + n * way / dr_;
          if (at >= d_ + 1) break;
          for (int j = std::max(int(at) - 1, 0); j <= std::min(int(at) + 2, d_ - 1); ++j)
            repeats.at(line, j) += b_spline(j - at) * echo;
        }
      };
      std::vector<int> found;
      std::vector<double> place;
      for (int k = 0; k < d_ && int(found.size()) < most_reflectors; ++k) {
        if (reflects(k) <= least_round) continue;
        double sum = 0, moment = 0;
        for (int j = std::max(0, k - near + 1); j <= std::min(d_ - 1, k + near - 1); ++j) {
          sum += reflects(j);
          moment += reflects(j) * (r_min_ + (j + 0.5) * dr_);
        }
        const double here = moment / sum, echo = reflected.at(line, k), before = i_at(k - near + 1);
        ring(k, here, echo, setting("face_reflection") * counted(reflects(k) * before * before, least_from_face));
        for (std::size_t i = 0; i < found.size() && on("reverberation"); ++i) {
          const double way = here - place[i], between = std::min(1.0, before / i_at(found[i] + near));
          const double apart = std::clamp((way - l_ / 2) / (l_ / 2), 0.0, 1.0);
          ring(k, way, share * echo,
               counted(apart * reflects(found[i]) * reflects(k) * between * between, least_round));
        }
        found.push_back(k);
        place.push_back(here);
      }
    }
    const double loudest = *std::max_element(plane("repeated").values.begin(), plane("repeated").values.end());
    compare("loudest repeat", 1, loudest > 1e-6, 0.5);  // silence would agree with anything
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k)
        compare("repeated", across_lines(repeats, line, k), plane("repeated").at(line, k),
                tolerances_.reflection * loudest);
  }

  /// Recomputes the envelope of the scatterers' echo after the same window.
  void speckle() {
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k) {
        const double re = across_lines(plane("echo_re"), line, k), im = across_lines(plane("echo_im"), line, k);
        const double scale = on("speckle") ? about_.at("envelope_scale").at(std::size_t(k)).get<double>() : 1.0;
        compare("speckle", std::hypot(re, im) * scale, plane("speckle").at(line, k), tolerances_.speckle);
      }
  }

  const Tolerances tolerances_;
  double l_;
  std::vector<double> weights_;
};

}  // namespace

std::map<std::string, double> echo_misfits(const StageFolder& stages, const Tolerances& tolerances) {
  Echoes echoes(stages, tolerances);
  echoes.all();
  return echoes.worst();
}

}  // namespace outsider
