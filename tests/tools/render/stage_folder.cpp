#include "tests/tools/render/stage_folder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace outsider {
namespace {

const double kPi = std::acos(-1.0);
constexpr double kFloat = 6e-8;  // what rounding to float32 changes at most, relative

Plane read_nrrd(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  Plane plane;
  if (!std::getline(stream, line) || line != "NRRD0004") throw std::runtime_error(file.string() + " is no NRRD");
  bool raw = false, little = false, real = false;
  while (std::getline(stream, line) && !line.empty()) {
    raw |= line == "encoding: raw";
    little |= line == "endian: little";
    real |= line == "type: float";
    if (line.rfind("sizes: ", 0) == 0) std::istringstream(line.substr(7)) >> plane.width >> plane.height;
  }
  std::vector<float> values(std::size_t(plane.width) * std::size_t(plane.height));
  stream.read(reinterpret_cast<char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
  if (!raw || !little || !real || !stream || stream.peek() != EOF || values.empty())
    throw std::runtime_error(file.string() + " is not as documented");
  plane.values.assign(values.begin(), values.end());
  return plane;
}

Vec3 vec3(const nlohmann::json& json) {
  return {json.at(0), json.at(1), json.at(2)};
}

/// The recomputation of one folder. Each check notes the worst disagreement of a stage.
class Recomputation {
public:
  Recomputation(const StageFolder& stages, const SyntheticCt& ct, const Tolerances& tolerances)
      : about_(stages.description),
        set_(about_.at("settings")),
        planes_(stages.planes),
        ct_(ct),
        tolerances_(tolerances) {
    for (const auto& line : about_.at("scan_lines")) {
      starts_.push_back(vec3(line.at("start_mm")));
      directions_.push_back(vec3(line.at("direction")));
    }
    for (const auto& knot : about_.at("tissues"))
      knots_.push_back({knot.at("hu"), knot.at("impedance_mrayl"), knot.at("absorption_db_cm_mhz")});
    n_ = int(starts_.size());
    d_ = about_.at("samples");
    dr_ = about_.at("dr_mm");
    r_min_ = about_.at("r_min_mm");
    l_ = set_.at("reflection_length_mm");
    gel_mm_ = set_.at("gel_mm");
    coupling_air_hu_ = about_.at("coupling_air_hu");
  }

  std::map<std::string, double> all() {
    sizes();
    tissue();
    intensity();
    reflection();
    beam();
    if (planes_.count("repeated")) reverberation();
    speckle();
    pixels();
    fusion();
    compression();
    return worst_;
  }

private:
  const Plane& plane(const std::string& name) const { return planes_.at(name); }
  double value(const char* key) const { return about_.at(key); }
  double setting(const char* key) const { return set_.at(key); }
  bool on(const char* key) const { return set_.at(key); }

  void compare(const std::string& stage, double expected, double got, double tolerated) {
    double misfit = std::abs(expected - got) / tolerated;
    if (!(misfit >= 0)) misfit = HUGE_VAL;  // not a number is no agreement
    worst_[stage] = std::max(worst_[stage], misfit);
  }

  void sizes() {
    const int w = about_.at("image").at("width"), h = about_.at("image").at("height");
    for (const auto& [name, p] : planes_) {
      const bool as_picture = name.rfind("pixel_", 0) == 0 || name == "fused" || name == "image";
      if (p.width != (as_picture ? w : n_) || p.height != (as_picture ? h : d_))
        throw std::runtime_error(name + " is of another size");
    }
    if (about_.at("lines") != n_ || w != set_.at("image_width") || d_ != set_.at("samples"))
      throw std::runtime_error("scanlines.json contradicts itself");
    compare("samples", value("r_max_mm") - r_min_, dr_ * d_, 1e-9);
  }

  struct Knot {
    double hu, impedance, absorption;
  };
  /// The tissue table: linear between knots, constant beyond.
  Knot tabled(double hu) const {
    if (hu <= knots_.front().hu) return knots_.front();
    for (std::size_t i = 1; i < knots_.size(); ++i) {
      const Knot &a = knots_[i - 1], &b = knots_[i];
      const double t = (hu - a.hu) / (b.hu - a.hu);
      if (t <= 1)
        return {hu, a.impedance + t * (b.impedance - a.impedance), a.absorption + t * (b.absorption - a.absorption)};
    }
    return knots_.back();
  }
  double with_gel(double hu, double r) const { return r < gel_mm_ && hu < coupling_air_hu_ ? 0 : hu; }
  double hu_at(const Vec3& p, double r) const { return with_gel(ct_.hounsfield(p), r); }

  /// From the CT: Hounsfield units, impedance, absorption, alpha and the angle of incidence.
  void tissue() {
    for (int line = 0; line < n_; ++line) {
      const Vec3 along = directions_[std::size_t(line)];
      const Vec3 lateral = beside(along), elevation = cross(along, lateral);
      for (int k = 0; k < d_; ++k) {
        const double r = r_min_ + (k + 0.5) * dr_;
        const Vec3 p = starts_[std::size_t(line)] + r * along;
        compare("hounsfield", hu_at(p, r), plane("hounsfield").at(line, k), 1000 * kFloat + 1e-9);
        // The float's own rounding, and that of the Hounsfield units on the table's steepest ramps.
        const double hu_error = 1000 * kFloat, seen = plane("hounsfield").at(line, k);
        const double z = plane("impedance").at(line, k);
        compare("impedance", tabled(seen).impedance, z, 0.007 * hu_error + kFloat * z + 1e-12);
        const double a = plane("absorption").at(line, k);
        compare("absorption", tabled(seen).absorption, a, 0.2 * hu_error + kFloat * a + 1e-12);

        // (1) where half a reflection length is a whole number of samples: from the impedances alone.
        const double alpha = plane("alpha").at(line, k);
        const double rounding = 4 * kFloat;  // two impedances in both sum and difference
        const double tolerated = 2 * std::sqrt(alpha) * rounding + rounding * rounding + kFloat * alpha;
        const int m = int(std::lround(l_ / 2 / dr_));
        if (std::abs(m * dr_ - l_ / 2) > 1e-9)
          throw std::runtime_error("half a reflection length is no whole number of samples");
        if (k >= m && k + m < d_) {
          const double before = plane("impedance").at(line, k - m), behind = plane("impedance").at(line, k + m);
          compare("alpha", std::pow((behind - before) / (behind + before), 2), alpha, tolerated);
        }
        // And from the CT at every sample, with the angle.
        const double hu_before = hu_at(p - l_ / 2 * along, r - l_ / 2),
                     hu_behind = hu_at(p + l_ / 2 * along, r + l_ / 2);
        const double before = tabled(hu_before).impedance, behind = tabled(hu_behind).impedance;
        compare("alpha from the CT", std::pow((behind - before) / (behind + before), 2), alpha, tolerated);
        const double rise[] = {hu_behind - hu_before, hu_at(p + l_ / 2 * lateral, r) - hu_at(p - l_ / 2 * lateral, r),
                               hu_at(p + l_ / 2 * elevation, r) - hu_at(p - l_ / 2 * elevation, r)};
        const double steepness = std::sqrt(rise[0] * rise[0] + rise[1] * rise[1] + rise[2] * rise[2]);
        // Where nothing rises by more than positions of 1e-12 mm can change, there is no angle to compare.
        if (steepness > 1e-5)
          compare("incidence", std::abs(rise[0]) / steepness, plane("incidence").at(line, k),
                  2 * kFloat + 1e-9 / steepness);
      }
    }
  }

  /// How much sound turns in a step, as rad across the line: the speed of sound's logarithm is linear in density below
  /// and above water, and its slope is taken over a reflection length.
  double rise_of_speed(const Vec3& p, const Vec3& across, double r) const {
    const auto& refraction = about_.at("refraction");
    const auto log_speed = [&](double hu) {
      hu = std::clamp(hu, refraction.at("least_hu").get<double>(), refraction.at("most_hu").get<double>());
      return hu * refraction.at(hu < 0 ? "log_speed_below_water" : "log_speed_above_water").get<double>();
    };
    const Vec3 half = l_ / 2 * across;
    return (log_speed(hu_at(p + half, r)) - log_speed(hu_at(p - half, r))) * dr_ / l_;
  }

  /// (5) along each line, from alpha and the absorption, and from the CT what is refracted out of the line.
  void intensity() {
    const double f = on("absorption") ? setting("frequency_mhz") : 0;
    const bool refracts = on("edge_shadow");
    const auto& refraction = about_.at("refraction");
    const double turn_mm = refraction.at("turn_mm"), turn_rad = refraction.at("turn_rad");
    double most_refracted_db = 0;
    for (int line = 0; line < n_; ++line) {
      double db = 0;        // of what is left of I
      double rounding = 0;  // relative, of 1 - alpha in all steps so far
      double turn[] = {0, 0}, refracted_db = 0;
      const Vec3 along = directions_[std::size_t(line)], lateral = beside(along), elevation = cross(along, lateral);
      for (int k = 0; k < d_; ++k) {
        const double step_db = plane("absorption").at(line, k) * f * dr_ / 10;
        if (k == 0) db = -step_db / 2;
        const double expected = std::pow(10, db / 10);
        compare("transmission", expected, plane("transmission").at(line, k),
                (tolerances_.intensity + rounding) * std::max(expected, 1e-6));
        most_refracted_db = std::max(most_refracted_db, refracted_db);
        const double alpha = plane("alpha").at(line, k);
        db += 10 * std::log10(1 - alpha) * dr_ / l_ - step_db;
        rounding += kFloat * alpha / (1 - alpha) * dr_ / l_;
        if (!refracts) continue;
        const double r = r_min_ + (k + 0.5) * dr_;
        const Vec3 p = starts_[std::size_t(line)] + r * along;
        const double kept = std::exp(-dr_ / turn_mm);
        turn[0] = kept * turn[0] + rise_of_speed(p, lateral, r);
        turn[1] = kept * turn[1] + rise_of_speed(p, elevation, r);
        const double q = std::pow(std::hypot(turn[0], turn[1]) / turn_rad, 4);
        const double lost_db = 10 * std::log10(std::exp(1)) * 2 * q / (2 + q) * dr_ / turn_mm;
        db -= lost_db;
        refracted_db += lost_db;
      }
    }
    if (refracts) compare("refracted", 1, most_refracted_db > 1, 0.5);  // so that it shows
  }

  /// Across a line in the imaging plane: lines of a fan part in it, those of a linear array stand side by side.
  Vec3 beside(const Vec3& along) const {
    Vec3 lateral = starts_.back() - starts_.front();
    lateral = lateral - dot(lateral, along) * along;
    return 1 / length(lateral) * lateral;
  }

  /// (3) from alpha, I and the angle.
  void reflection() {
    const double brightest = *std::max_element(plane("reflection").values.begin(), plane("reflection").values.end());
    compare("brightest", 1, brightest > 1e-6, 0.5);  // a frame without echo would agree with anything
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k)
        compare("reflection",
                plane("alpha").at(line, k) * std::pow(plane("transmission").at(line, k), 2) *
                    plane("incidence").at(line, k),
                plane("reflection").at(line, k), tolerances_.reflection * brightest);
  }

  /// The window over the lines of the aperture, which nothing beyond the outer ones is part of.
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

  /// (4) from R.
  void beam() {
    weights_ = weights();
    for (std::size_t i = 0; i < weights_.size(); ++i)
      compare("beam_weights", weights_[i], about_.at("beam_weights").at(i), 1e-12);
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k) {
        // Sums of positive numbers: in single precision each of the terms costs a rounding or two.
        const double expected = across_lines(plane("reflection"), line, k);
        compare("reflection_beam", expected, plane("reflection_beam").at(line, k),
                4 * kFloat * double(weights_.size()) * expected + 1e-30);
      }
  }

  /// Echoes of echoes, from I and R of each line, and behind the same window as R.
  void reverberation() {
    const auto& about = about_.at("reverberation");
    const double least_round = about.at("least_round"), least_reverberant = about.at("least_reverberant");
    const int most_repeats = about.at("most_repeats"), most_reflectors = about.at("most_reflectors");
    const double share = std::min(dr_ / l_, 1.0);
    const int near = std::max(int(std::ceil(l_ / dr_ - 1e-3)), 1);  // samples nearer than this are of one interface
    const auto counted = [&](double round) {
      return round > least_round ? round - least_round * least_round / round : 0;
    };
    Plane repeats = plane("repeated");
    for (double& v : repeats.values) v = 0;
    for (int line = 0; line < n_; ++line) {
      const auto i_at = [&](int k) { return plane("transmission").at(line, std::clamp(k, 0, d_ - 1)); };
      const auto reflects = [&](int k) {
        return i_at(k) > least_reverberant ? plane("reflection").at(line, k) / (i_at(k) * i_at(k)) : 0;
      };
      // Sound that goes to and fro over `way` shows sample k again and again.
      const auto ring = [&](int k, double way, double echo, double round) {
        for (int n = 1; n <= most_repeats && counted(round) > 0; ++n) {
          echo *= counted(round);
          const double at = k + n * way / dr_;
          const int low = int(std::floor(at));
          if (low < d_) repeats.at(line, low) += (low + 1 - at) * echo;
          if (low + 1 < d_) repeats.at(line, low + 1) += (at - low) * echo;
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
        const double here = moment / sum, echo = plane("reflection").at(line, k), before = i_at(k - near + 1);
        ring(k, here, echo, setting("face_reflection") * reflects(k) * before * before);
        for (std::size_t i = 0; i < found.size() && on("reverberation"); ++i) {
          const double way = here - place[i], between = std::min(1.0, before / i_at(found[i] + near));
          const double apart = std::clamp((way - l_ / 2) / (l_ / 2), 0.0, 1.0);
          ring(k, way, share * echo, apart * reflects(found[i]) * reflects(k) * between * between);
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

  /// The envelope of the scatterers' echo behind the same window.
  void speckle() {
    const bool speckle = on("speckle");
    for (int line = 0; line < n_; ++line)
      for (int k = 0; k < d_; ++k) {
        const double re = across_lines(plane("echo_re"), line, k), im = across_lines(plane("echo_im"), line, k);
        const double scale = speckle ? about_.at("envelope_scale").at(std::size_t(k)).get<double>() : 1.0;
        compare("speckle", std::hypot(re, im) * scale, plane("speckle").at(line, k), tolerances_.speckle);
        if (!speckle) {
          const double amplitude = std::pow(10, plane("echogenicity").at(line, k) / 10);
          compare("echo_re", amplitude, plane("echo_re").at(line, k), 100 * kFloat * amplitude);
        }
      }
  }

  /// Where each pixel lies among the lines, from the lines' own places.
  void pixels() {
    const auto& image = about_.at("image");
    const auto& pose = about_.at("patient_from_probe");
    const Vec3 d0 = directions_.front(), d1 = directions_.back();
    const bool fan = length(cross(d0, d1)) > 1e-9;
    // The point where the outer lines meet: start + t d on either, t by the sine rule.
    const double opening = std::atan2(length(cross(d0, d1)), dot(d0, d1));
    const double t = fan ? length(starts_.back() - starts_.front()) / 2 / std::sin(opening / 2) : 0;
    const Vec3 apex = starts_.front() - t * d0;
    const Vec3 across = starts_.back() - starts_.front();
    Plane line_at = plane("pixel_line");
    for (int y = 0; y < line_at.height; ++y)
      for (int x = 0; x < line_at.width; ++x) {
        const double in_probe[] = {
            image.at("top_left_mm").at(0).get<double>() + x * image.at("mm_per_pixel").get<double>(),
            image.at("top_left_mm").at(1).get<double>() + y * image.at("mm_per_pixel").get<double>()};
        Vec3 p{};
        for (std::size_t row = 0; row < 3; ++row)
          p[row] = pose.at(4 * row).get<double>() * in_probe[0] + pose.at(4 * row + 1).get<double>() * in_probe[1] +
                   pose.at(4 * row + 3).get<double>();
        double line = 0, r = 0;
        if (fan) {
          const Vec3 from_apex = p - apex, normal = cross(d0, d1);
          const double angle = std::atan2(dot(cross(d0, from_apex), normal) / length(normal), dot(d0, from_apex));
          line = angle / opening * (n_ - 1);
          r = length(from_apex) - t;
        } else {
          line = dot(p - starts_.front(), across) / dot(across, across) * (n_ - 1);
          r = dot(p - starts_.front(), d0);
        }
        const double sample = (r - r_min_) / dr_ - 0.5;
        const double to_edge = std::min({line + 0.5, n_ - 0.5 - line, sample + 0.5, d_ - 0.5 - sample});
        if (std::abs(to_edge) < 1e-6) continue;  // on the edge, where rounding decides
        compare("pixel_line", to_edge > 0 ? line : -2, line_at.at(x, y), kFloat * n_ + 1e-9);
        compare("pixel_sample", to_edge > 0 ? sample : -2, plane("pixel_sample").at(x, y), kFloat * d_ + 1e-9);
      }
  }

  bool inside(int x, int y) const { return plane("pixel_line").at(x, y) > -1; }

  /// Bilinear among the lines, which end in their middles.
  Plane converted(const Plane& from) const {
    Plane to = plane("pixel_line");
    for (int y = 0; y < to.height; ++y)
      for (int x = 0; x < to.width; ++x) {
        if (!inside(x, y)) {
          to.at(x, y) = 0;
          continue;
        }
        const double line = std::clamp(plane("pixel_line").at(x, y), 0.0, n_ - 1.0);
        const double sample = std::clamp(plane("pixel_sample").at(x, y), 0.0, d_ - 1.0);
        const int i = std::min(int(line), n_ - 2), k = std::min(int(sample), d_ - 2);
        const double u = line - i, v = sample - k;
        to.at(x, y) = (1 - u) * (1 - v) * from.at(i, k) + u * (1 - v) * from.at(i + 1, k) +
                      (1 - u) * v * from.at(i, k + 1) + u * v * from.at(i + 1, k + 1);
      }
    return to;
  }

  /// A Gaussian over what lies inside the fan, out to three sigma.
  Plane smoothed(Plane from, double sigma_mm) const {
    const double sigma = sigma_mm / about_.at("image").at("mm_per_pixel").get<double>();
    if (sigma < 0.05) return from;
    const int radius = int(std::ceil(3 * sigma));
    const auto pass = [&](const Plane& source, bool vertical) {
      Plane to = source;
      for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
          to.at(x, y) = 0;
          for (int j = -radius; j <= radius && inside(x, y); ++j) {
            const int u = vertical ? x : x + j, v = vertical ? y + j : y;
            if (u >= 0 && v >= 0 && u < to.width && v < to.height)
              to.at(x, y) += std::exp(-j * j / (2 * sigma * sigma)) * source.at(u, v);
          }
        }
      return to;
    };
    Plane within = from;
    for (int y = 0; y < from.height; ++y)
      for (int x = 0; x < from.width; ++x) within.at(x, y) = inside(x, y);
    from = pass(pass(from, false), true);
    within = pass(pass(within, false), true);
    for (std::size_t i = 0; i < from.values.size(); ++i)
      if (within.values[i] > 0) from.values[i] /= within.values[i];
    return from;
  }

  static void add(Plane& to, const Plane& what, double factor) {
    for (std::size_t i = 0; i < to.values.size(); ++i) to.values[i] += factor * what.values[i];
  }

  /// The scatterers' echo at each depth as all lines have it in the mean, fading into the depths behind.
  Plane mean_echo(const Plane& transmission) const {
    Plane mean = transmission;
    double before = 0;
    const double kept = std::exp(-dr_ / value("clutter_tail_mm"));
    for (int k = 0; k < d_; ++k) {
      double sum = 0;
      for (int line = 0; line < n_; ++line) sum += transmission.at(line, k) * plane("speckle").at(line, k);
      const double here = setting("blend") * sum / n_;
      before = k == 0 ? here : kept * before + (1 - kept) * here;
      for (int line = 0; line < n_; ++line) mean.at(line, k) = before;
    }
    return mean;
  }

  /// (6) from R behind the beam, I, S and what adds to them.
  void fusion() {
    Plane transmission = plane("transmission");
    if (on("two_way"))
      for (double& i : transmission.values) i *= i;
    const Plane r = smoothed(converted(plane("reflection_beam")), setting("reflection_sigma_mm"));
    const Plane t = smoothed(converted(transmission), setting("transmission_sigma_mm"));
    const Plane s = converted(plane("speckle"));
    Plane expected = r;
    for (std::size_t i = 0; i < r.values.size(); ++i)
      expected.values[i] = (r.values[i] + setting("blend") * t.values[i]) * s.values[i];
    if (planes_.count("repeated")) add(expected, converted(plane("repeated")), 1);
    if (on("electronic_noise")) add(expected, converted(plane("noise")), value("noise_level"));
    if (on("clutter")) {
      Plane beside = converted(mean_echo(transmission));
      const Plane noise = converted(plane("noise"));
      for (std::size_t i = 0; i < noise.values.size(); ++i) beside.values[i] *= noise.values[i];
      add(expected, beside, value("clutter_share"));
    }
    for (int y = 0; y < r.height; ++y)
      for (int x = 0; x < r.width; ++x) {
        double brightest = 1e-20;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, r.height - 1); ++v)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, r.width - 1); ++u)
            brightest = std::max(brightest, expected.at(u, v));
        compare("fused", expected.at(x, y), plane("fused").at(x, y), tolerances_.fused * brightest);
      }
  }

  /// (7) from U.
  void compression() {
    const Plane& u = plane("fused");
    const auto& tgc = set_.at("tgc_db");
    Plane db = u;  // of the echo behind gain
    double brightest = -HUGE_VAL;
    for (int y = 0; y < u.height; ++y)
      for (int x = 0; x < u.width; ++x) {
        const double depth = std::clamp((plane("pixel_sample").at(x, y) + 0.5) / d_, 0.0, 1.0) * double(tgc.size() - 1);
        const std::size_t below = std::min(std::size_t(depth), tgc.size() - 2);
        const double low = tgc.at(below), high = tgc.at(below + 1);
        db.at(x, y) = inside(x, y) && u.at(x, y) > 0 ? 10 * std::log10(u.at(x, y)) + low +
                                                           (high - low) * (depth - double(below)) + setting("gain_db")
                                                     : -HUGE_VAL;
        brightest = std::max(brightest, db.at(x, y));
      }
    const double white =
        set_.at("reference_level") == "frame_maximum" ? brightest : 10 * std::log10(setting("fixed_level"));
    for (std::size_t i = 0; i < db.values.size(); ++i) {
      const double grey = 255 * std::clamp(1 + (db.values[i] - white) / setting("dynamic_range_db"), 0.0, 1.0);
      // Half a level is rounding to whole ones; the hundredth is single precision's, whose logarithms of factors of
      // 10^30 are good to about 1e-5 dB.
      compare("image", grey, plane("image").values[i], 0.51);
    }
  }

  const nlohmann::json &about_, &set_;
  const std::map<std::string, Plane>& planes_;
  const SyntheticCt& ct_;
  const Tolerances tolerances_;
  std::vector<Vec3> starts_, directions_;
  std::vector<Knot> knots_;
  std::vector<double> weights_;
  int n_ = 0, d_ = 0;
  double dr_ = 0, r_min_ = 0, l_ = 0, gel_mm_ = 0, coupling_air_hu_ = 0;
  std::map<std::string, double> worst_;
};

}  // namespace

StageFolder read_stage_folder(const std::filesystem::path& folder) {
  StageFolder stages;
  std::ifstream stream(folder / "scanlines.json");
  stages.description = nlohmann::json::parse(stream);
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".nrrd") stages.planes[entry.path().stem().string()] = read_nrrd(entry.path());
  return stages;
}

std::map<std::string, double> misfits(const StageFolder& stages, const SyntheticCt& ct, const Tolerances& tolerances) {
  return Recomputation(stages, ct, tolerances).all();
}

}  // namespace outsider
