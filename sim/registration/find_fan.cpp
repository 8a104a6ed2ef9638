#include "sim/registration/find_fan.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/core/text.h"
#include "sim/registration/minimise.h"

namespace insonate {
namespace {

constexpr double kMargin = 0.2;       // of the image: dark pixels that are thought around it
constexpr double kOutside = 0.005;    // share of the echo that may lie beyond a line that bounds it
constexpr double kMaxHalfAngle = 75;  // degrees
constexpr double kAngleStep = 2.5;    // degrees, of the starts
constexpr double kSimpler = 0.004;    // of the information, by which a fan has to beat a rectangle
constexpr double kMinInformation = 0.5;
constexpr double kMinFilled = 0.5;
constexpr double kMinArea = 0.03;  // of the image
constexpr std::size_t kMinPixels = 400;

// A fan in mm from the image's top left pixel: x along the rows, y along the columns.
struct Fan {
  ProbeKind kind = ProbeKind::linear;
  double middle = 0;                  // x of the central beam
  double face = 0, deep = 0;          // y of both ends of the central beam
  double top_half = 0, low_half = 0;  // distance of the edges from the central beam in the echo's top and lowest row

  double slope(double height) const { return (low_half - top_half) / height; }
};

struct Box {
  double left, right, top, bottom;  // pixels, outer edges
};

double binary_entropy(double share) {
  if (share <= 0 || share >= 1) return 0;
  return -share * std::log(share) - (1 - share) * std::log(1 - share);
}

class Fitter {
public:
  Fitter(const Image<std::uint8_t>& mask, const glm::dvec2& mm)
      : mask_(mask), mm_(mm), sums_(mask.width + 1, mask.height) {
    box_ = {double(mask.width), 0, double(mask.height), 0};
    std::vector<std::size_t> columns(std::size_t(mask.width)), rows(std::size_t(mask.height));
    for (int y = 0; y < mask.height; ++y)
      for (int x = 0; x < mask.width; ++x) {
        const bool echo = mask.at(x, y) > 0;
        sums_.at(x + 1, y) = sums_.at(x, y) + echo;
        if (!echo) continue;
        ++echo_;
        points_.emplace_back(x * mm.x, y * mm.y);
        ++columns[std::size_t(x)];
        ++rows[std::size_t(y)];
      }
    std::tie(box_.left, box_.right) = extent(columns);
    std::tie(box_.top, box_.bottom) = extent(rows);
  }

  std::size_t echo() const { return echo_; }
  const Box& box() const { return box_; }
  double top_mm() const { return (box_.top - 0.5) * mm_.y; }
  double bottom_mm() const { return (box_.bottom - 0.5) * mm_.y; }
  double height_mm() const { return bottom_mm() - top_mm(); }

  // Pixels of the image's part inside the fan, and how many of them carry echo.
  struct Inside {
    double pixels = 0, echo = 0;
  };
  Inside inside(const Fan& fan) const { return inside(fan, box_); }

  // Returns the area of the whole fan, pixels, as if no image cut it off.
  double whole(const Fan& fan) const {
    const double far = 1e4;
    return inside(fan, {-far, far, -far, far}).pixels;
  }

  /// Returns the share of the uncertainty about a pixel that the fan removes, 0 to 1.
  double information(const Fan& fan) const {
    const double all = (1 + kMargin) * double(mask_.width) * double(mask_.height);
    const Inside in = inside(fan);
    const double out = all - in.pixels;
    if (in.pixels <= 0 || out <= 0) return 0;
    const double before = all * binary_entropy(double(echo_) / all);
    const double after = in.pixels * binary_entropy(in.echo / in.pixels) +
                         out * binary_entropy(std::clamp((double(echo_) - in.echo) / out, 0.0, 1.0));
    return before > 0 ? 1 - after / before : 0;
  }

  Fan rectangle() const {
    Fan fan;
    fan.middle = (box_.left + box_.right - 1) / 2 * mm_.x;
    fan.face = top_mm();
    fan.deep = bottom_mm();
    fan.top_half = fan.low_half = (box_.right - box_.left) / 2 * mm_.x;
    return fan;
  }

  // Returns the fan of an opening angle that encloses the echo.
  Fan enclosing(ProbeKind kind, double half_angle_deg) const {
    const double tan = std::tan(glm::radians(half_angle_deg));
    const double left = low([&](const glm::dvec2&p) { return p.x + tan * p.y; }),
                 right = -low([&](const glm::dvec2&p) { return -(p.x - tan * p.y); });
    // The edges are x = left - tan y and x = right + tan y, and meet at the apex.
    Fan fan;
    fan.kind = kind;
    fan.middle = (left + right) / 2;
    const double apex = (left - right) / (2 * tan);
    fan.top_half = tan * (top_mm() - apex);
    fan.low_half = tan * (bottom_mm() - apex);
    if (kind == ProbeKind::phased) {
      fan.face = top_mm();
      fan.deep = bottom_mm();
    } else {
      const auto radius = [&](const glm::dvec2& p) { return std::hypot(p.x - fan.middle, p.y - apex); };
      fan.face = apex + low(radius);
      fan.deep = apex - low([&](const glm::dvec2& p) { return -radius(p); });
    }
    return fan;
  }

  Fan refined(const Fan& fan) const {
    const bool flat = fan.kind == ProbeKind::linear;
    Parameters start{fan.middle, fan.face, fan.deep, fan.low_half};
    if (!flat) start.push_back(fan.top_half);
    const auto made = [&](const Parameters& x) { return Fan{fan.kind, x[0], x[1], x[2], flat ? x[3] : x[4], x[3]}; };
    const EvaluateAll evaluate = [&](std::span<const Parameters> all) {
      std::vector<double> values;
      for (const Parameters& x : all) values.push_back(is_fan(made(x)) ? information(made(x)) : 0);
      return values;
    };
    const double size = std::max(mm_.x * mask_.width, mm_.y * mask_.height);
    LocalSearch search;
    for (const double each : start) {
      search.low.push_back(each - size / 4);
      search.high.push_back(each + size / 4);
    }
    search.first_step = size / 100;
    search.tolerance = size / 1e5;
    search.most_evaluations = 600;
    return within_box(made(maximise_from({start}, evaluate, search).front().at));
  }

  bool is_fan(const Fan& fan) const {
    if (!(fan.deep > fan.face) || !(fan.low_half > 0)) return false;
    if (fan.kind == ProbeKind::linear) return true;
    return fan.slope(height_mm()) > 1e-3 && apex_of(fan) < fan.face;
  }

  double apex_of(const Fan& fan) const { return top_mm() - fan.top_half / fan.slope(height_mm()); }

private:
  // Returns the fan without what the echo says nothing of: a rectangle's sides, a flat face and depths beyond it.
  Fan within_box(Fan fan) const {
    const double box_left = (box_.left - 0.5) * mm_.x, box_right = (box_.right - 0.5) * mm_.x;
    if (fan.kind != ProbeKind::curvilinear) fan.face = std::max(fan.face, top_mm());
    if (fan.kind == ProbeKind::linear) {
      fan.deep = std::min(fan.deep, bottom_mm());
      const double left = std::max(fan.middle - fan.low_half, box_left),
                   right = std::min(fan.middle + fan.low_half, box_right);
      fan.middle = (left + right) / 2;
      fan.top_half = fan.low_half = (right - left) / 2;
    } else {
      const double apex = apex_of(fan), aside = std::max(fan.middle - box_left, box_right - fan.middle);
      fan.deep = std::min(fan.deep, apex + std::hypot(aside, bottom_mm() - apex));
    }
    return fan;
  }

  // Returns the outer edges of the pixels that hold most of the echo.
  std::pair<double, double> extent(const std::vector<std::size_t>& counts) const {
    const auto most = std::size_t(1e-4 * double(echo_));
    std::size_t first = 0, last = counts.size();
    for (std::size_t passed = 0; first < last && (passed += counts[first]) <= most;) ++first;
    for (std::size_t passed = 0; last > first && (passed += counts[last - 1]) <= most;) --last;
    return {double(first), double(last)};
  }

  template <typename Value>
  double low(Value&& value) const {
    std::vector<double> values;
    values.reserve(points_.size());
    for (const glm::dvec2& point : points_) values.push_back(value(point));
    const auto at = values.begin() + std::ptrdiff_t(kOutside * double(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  }

  // Returns the echo of a row up to a column's position, with the pixel there in part.
  double echo_before(int row, double column) const {
    const double at = std::clamp(column, 0.0, double(mask_.width));
    const int whole = std::min(int(at), mask_.width - 1);
    return sums_.at(whole, row) + (at - whole) * (mask_.at(whole, row) > 0);
  }

  Inside inside(const Fan& fan, const Box& box) const {
    Inside sum;
    const bool flat = fan.kind == ProbeKind::linear, round = fan.kind == ProbeKind::curvilinear;
    const double apex = flat ? 0 : apex_of(fan), slope = flat ? 0 : fan.slope(height_mm());
    const double far = fan.deep - (flat ? 0 : apex), near = fan.face - apex;
    const int first = int(std::max(box.top, std::floor((round ? apex : fan.face) / mm_.y - 1))),
              last = int(std::min(box.bottom, std::ceil(fan.deep / mm_.y + 2)));
    for (int row = first; row < last; ++row) {
      const double y = row * mm_.y;
      double weight = 1, outer = fan.low_half, inner = 0;
      if (!round) weight = std::clamp((y - fan.face) / mm_.y + 0.5, 0.0, 1.0);
      if (flat) weight = std::min(weight, std::clamp((fan.deep - y) / mm_.y + 0.5, 0.0, 1.0));
      if (!flat) {
        const double below = y - apex;
        if (below <= 0) continue;
        // A phased array's line ends where its length from the flat face is the depth.
        const double reach = round || y <= fan.face ? far : (fan.deep - fan.face) * below / (y - fan.face);
        if (reach <= below) continue;
        outer = std::min(slope * below, std::sqrt(reach * reach - below * below));
        if (round && near > below) inner = std::sqrt(near * near - below * below);
      }
      if (weight <= 0 || outer <= inner) continue;
      const auto add = [&](double from_mm, double to_mm) {
        const double from = std::max(from_mm / mm_.x + 0.5, box.left), to = std::min(to_mm / mm_.x + 0.5, box.right);
        if (to <= from) return;
        sum.pixels += weight * (to - from);
        if (row >= 0 && row < mask_.height) sum.echo += weight * (echo_before(row, to) - echo_before(row, from));
      };
      add(fan.middle - outer, fan.middle - inner);
      add(fan.middle + inner, fan.middle + outer);
    }
    return sum;
  }

  const Image<std::uint8_t>& mask_;
  glm::dvec2 mm_;
  Image<int> sums_;  // of each row
  std::vector<glm::dvec2> points_;
  std::size_t echo_ = 0;
  Box box_{};
};

Fan best_of_kind(const Fitter& fitter, ProbeKind kind) {
  if (kind == ProbeKind::linear) return fitter.refined(fitter.rectangle());
  Fan best;
  double most = -1;
  for (double angle = kAngleStep; angle <= kMaxHalfAngle; angle += kAngleStep) {
    const Fan fan = fitter.enclosing(kind, angle);
    if (!fitter.is_fan(fan)) continue;
    const double information = fitter.information(fan);
    if (information > most) {
      most = information;
      best = fan;
    }
  }
  return most < 0 ? best : fitter.refined(best);
}

// Returns the probe of a fan, or why no probe has such a fan.
FanSearch as_probe(const Fitter& fitter, const Fan& fan, const glm::dvec2& mm) {
  FoundFan found;
  const auto beyond = [](const std::string& what, double value, double least, double most, const char* unit) {
    return "the fan in its images has a " + what + " of " + formatted("%.1f", value) + " " + unit + ", not " +
           formatted("%.0f", least) + " to " + formatted("%.0f", most);
  };
  std::string problem;
  const auto check = [&](const std::string& what, double value, double least, double most, const char* unit) {
    if (problem.empty() && !(value >= least && value <= most)) problem = beyond(what, value, least, most, unit);
  };
  for (const Probe& probe : probes())
    if (probe.kind == fan.kind) found.probe = probe;
  found.depth_mm = found.probe.depth_mm = fan.deep - fan.face;
  check("depth", found.depth_mm, 20, 400, "mm");  // shallower ones have pixels of another size
  if (fan.kind == ProbeKind::linear) {
    found.probe.width_mm = 2 * fan.low_half;
  } else {
    found.probe.field_of_view_deg = 2 * glm::degrees(std::atan(fan.slope(fitter.height_mm())));
    check("field of view", found.probe.field_of_view_deg, 5, 150, "degrees");
    const double behind = fan.face - fitter.apex_of(fan);
    if (fan.kind == ProbeKind::curvilinear) {
      found.probe.radius_mm = behind;
      check("radius", behind, 5, 200, "mm");
    } else {
      found.probe.width_mm = 2 * behind * fan.slope(fitter.height_mm());
    }
  }
  if (fan.kind != ProbeKind::curvilinear) check("face's width", found.probe.width_mm, 5, 200, "mm");
  if (!problem.empty()) return {{}, problem};
  found.face_pixel = {fan.middle / mm.x, fan.face / mm.y};
  const Box& box = fitter.box();
  found.clip = {int(box.left), int(box.top), int(box.right - box.left), int(box.bottom - box.top)};
  const Fitter::Inside in = fitter.inside(fan);
  found.filled = in.echo / in.pixels;
  found.shown = std::min(1.0, in.pixels / fitter.whole(fan));
  return {found, {}};
}

}  // namespace

FanSearch find_fan(const Image<std::uint8_t>& mask, const glm::dvec2& mm_per_pixel) {
  const Fitter fitter(mask, mm_per_pixel);
  const auto pixels = double(mask.pixels.size());
  if (fitter.echo() < kMinPixels || double(fitter.echo()) < kMinArea * pixels)
    return {{}, "its images show no fan: hardly any pixel carries echo"};
  Fan best = best_of_kind(fitter, ProbeKind::linear);
  double most = fitter.information(best) + kSimpler;
  for (const ProbeKind kind : {ProbeKind::curvilinear, ProbeKind::phased}) {
    const Fan fan = best_of_kind(fitter, kind);
    if (!fitter.is_fan(fan)) continue;
    const double information = fitter.information(fan);
    if (information > most) {
      most = information;
      best = fan;
    }
  }
  const Fitter::Inside in = fitter.inside(best);
  if (fitter.information(best) < kMinInformation || in.echo < kMinFilled * in.pixels)
    return {{}, "its images show no fan: what carries echo has the shape of none"};
  return as_probe(fitter, best, mm_per_pixel);
}

std::string probe_description(const FoundFan& fan) {
  const Probe& probe = fan.probe;
  std::string text = probe.name;
  if (probe.kind == ProbeKind::curvilinear) text += ", radius " + formatted("%.1f", probe.radius_mm) + " mm";
  if (probe.kind != ProbeKind::linear)
    text += ", field of view " + formatted("%.1f", probe.field_of_view_deg) + " degrees";
  if (probe.kind != ProbeKind::curvilinear) text += ", width " + formatted("%.1f", probe.width_mm) + " mm";
  return text + ", depth " + formatted("%.1f", fan.depth_mm) + " mm";
}

std::string description(const FoundFan& fan) {
  std::string text = probe_description(fan) + ", face at pixel " + formatted("%.1f", fan.face_pixel.x) + ", " +
                     formatted("%.1f", fan.face_pixel.y);
  if (fan.shown < 0.99) text += "; the images show " + formatted("%.0f", 100 * fan.shown) + " % of it";
  return text;
}

}  // namespace insonate
