#include "scenarios/cases/acoustic_window.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/cases/structure_shape.h"
#include "sim/tissue/skin_contact.h"

namespace insonate {
namespace {

constexpr int kLines = 32;
constexpr double kSample_mm = 1;
constexpr double kDeepest_mm = 240;  // maximum depth of a curvilinear probe
constexpr double kLiver_hu = 60;
constexpr double kLost_db = 20;         // same as ViewMeter's limit for arriving sound
constexpr double kHalfOff = 0.5;        // loss of the rating for targets at the fan's edge
constexpr double kTypicalWay_mm = 100;  // distance over which the rating falls to 1/e

constexpr double kMaxToBack = 0.5;   // sine of 30 degrees: the couch
constexpr double kMaxAlong = 0.766;  // sine of 50 degrees
constexpr double kBone_hu = 200;     // start of bone in the tissue table
constexpr int kFacePlaces = 7;
constexpr double kFaceLifted_mm = 15;  // maximum gap between an end of the face and the skin
constexpr std::array kPresses_mm = {12.0, 8.0, 4.0};

}  // namespace

/// One way to hold the probe, with its rating.
struct WindowSearch::Choice {
  double round_deg = 0;  ///< rotation of the beam about the axis
  double lean_deg = 0;   ///< inclination of the beam towards the axis
  double rock_deg = 0;   ///< rotation of the probe in the plane about the centre of its face
  double press_mm = 0;
  double rating = 0;
};

/// The visible parts of the targets in a fan.
struct WindowSearch::View {
  std::vector<double> seen_mm2, clear_mm2;  ///< one per target
  double off_centre_mm2 = 0;                ///< integral of the clear area's position across the fan, -1 to 1
  double deepest_mm = 0;                    ///< deepest clear sample of the last target, along its line

  double seen() const;
  double clear() const;
};

double WindowSearch::View::seen() const {
  double sum = 0;
  for (const double area : seen_mm2) sum += area;
  return sum;
}

double WindowSearch::View::clear() const {
  double sum = 0;
  for (const double area : clear_mm2) sum += area;
  return sum;
}

WindowSearch::WindowSearch(const Case& subject, const BodyMask& body, const TissueTable& tissues, const Probe& probe)
    : subject_(&subject),
      body_(&body),
      probe_(probe),
      transmission_(subject.ct, tissues, kSample_mm, probe.frequency_mhz),
      soft_tissue_db_per_mm_(tissues.at(kLiver_hu).absorption_db_cm_mhz * probe.frequency_mhz / 10) {
  probe_.lines = kLines;
}

std::optional<glm::dvec3> WindowSearch::skin_from(const glm::dvec3& aim, const glm::dvec3& outwards) const {
  constexpr double kBeyond_mm = 3;
  const glm::dvec3 start = body_->grid.index_from_patient(aim);
  const glm::dvec3 per_mm = body_->grid.index_from_patient(aim + outwards) - start;
  for (double s = 0;; s += 1) {
    const glm::ivec3 voxel = glm::ivec3(glm::floor(start + per_mm * s + 0.5));
    if (!body_->grid.contains(voxel)) return std::nullopt;
    if (body_->at(voxel)) continue;
    const auto back = distance_to_skin(subject_->ct, aim + outwards * (s + kBeyond_mm), -outwards, 2 * kBeyond_mm);
    return aim + outwards * (s + kBeyond_mm - back.value_or(kBeyond_mm));
  }
}

/// Returns true if no bone lies between skin and face, and the probe does not intersect another part of the body.
bool WindowSearch::face_fits(const Pose& pose, double press_mm) const {
  Probe sparse = probe_;
  sparse.lines = kFacePlaces;
  const ScanLines face = scan_lines(sparse, 1, 1);
  const auto in_body = [&](const glm::dvec3& p) {
    const glm::ivec3 voxel = glm::ivec3(glm::floor(body_->grid.index_from_patient(p) + 0.5));
    return body_->grid.contains(voxel) && body_->at(voxel);
  };
  for (const ScanLine& line : face.lines) {
    const glm::dvec3 start = pose.point(line.start), outwards = -pose.direction(line.direction);
    // First outwards through the tissue that the face displaces, then through the air that the probe's head needs.
    double s = 0;
    for (; in_body(start + outwards * s); s += 1) {
      if (s > press_mm + kFaceLifted_mm) return false;
      if (sample_trilinear(subject_->ct, subject_->ct.grid.index_from_patient(start + outwards * s)) > kBone_hu)
        return false;
    }
    if (s == 0 && !distance_to_skin(subject_->ct, start, -outwards, kFaceLifted_mm)) return false;
    constexpr double kHead_mm = 40;
    for (const double end = s + kHead_mm; s < end; s += 2)
      if (in_body(start + outwards * (s + 3))) return false;
  }
  return true;
}

std::optional<Pose> WindowSearch::place(const WantedPicture& wanted, const Choice& choice) const {
  // Two directions perpendicular to the axis. The helper is never nearly parallel to it.
  const glm::dvec3& a = wanted.axis;
  const glm::dvec3 helper = std::abs(a.y) < 0.7 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 u = glm::normalize(helper - a * glm::dot(helper, a)), v = glm::cross(a, u);
  const double round = glm::radians(choice.round_deg), lean = glm::radians(choice.lean_deg);
  const glm::dvec3 level = u * std::cos(round) + v * std::sin(round);
  const glm::dvec3 beam = level * std::cos(lean) + a * std::sin(lean);
  const glm::dvec3 outwards = -beam;
  if (outwards.y > kMaxToBack || std::abs(outwards.z) > kMaxAlong) return std::nullopt;
  const auto skin = skin_from(wanted.aim, outwards);
  if (!skin) return std::nullopt;

  const glm::dvec3 lateral =
      glm::normalize(wanted.along ? a * std::cos(lean) - level * std::sin(lean) : glm::cross(a, level));
  const double rock = glm::radians(choice.rock_deg);
  const glm::dvec3 face = *skin + beam * choice.press_mm;
  const glm::dvec3 turned = beam * std::cos(rock) + lateral * std::sin(rock);
  const glm::dvec3 marker = marker_side(lateral * std::cos(rock) - beam * std::sin(rock));
  const Pose pose{glm::dmat3(marker, turned, glm::cross(marker, turned)), face};
  if (!face_fits(pose, choice.press_mm)) return std::nullopt;
  return pose;
}

WindowSearch::View WindowSearch::look(const WantedPicture& wanted, const Pose& pose) const {
  View view{std::vector<double>(wanted.targets.size()), std::vector<double>(wanted.targets.size())};
  const ScanLines lines = scan_lines(probe_, kDeepest_mm, int(kDeepest_mm / kSample_mm));
  std::vector<double> intensity(std::size_t(lines.samples));
  for (std::size_t i = 0; i < lines.lines.size(); ++i) {
    const VoxelLine way = voxel_line(subject_->ct.grid, lines, i, pose);
    const double across = (2.0 * double(i) + 1 - kLines) / kLines;
    // The lines of a fan diverge with depth. Their distance at each sample determines the area that the sample
    // represents.
    const ScanLine &line = lines.lines[i], &next = lines.lines[i + 1 < lines.lines.size() ? i + 1 : i - 1];
    const glm::dvec3 apart = line.start - next.start, parting = line.direction - next.direction;
    bool computed = false;
    for (int k = 0; k < lines.samples; ++k) {
      const std::uint8_t label = sample_nearest(subject_->labels, way.at(k + 0.5));
      if (label == 0) continue;
      for (std::size_t t = 0; t < wanted.targets.size(); ++t) {
        if (label != wanted.targets[t]) continue;
        if (!computed) transmission_.along(way, intensity);
        computed = true;
        const double r = (k + 0.5) * kSample_mm;
        const double cell = kSample_mm * glm::length(apart + parting * r);
        const double against_liver_db =
            10 * std::log10(std::max(intensity[std::size_t(k)], 1e-30)) + soft_tissue_db_per_mm_ * r;
        const double weight = std::clamp(1 + against_liver_db / kLost_db, 0.0, 1.0);
        view.seen_mm2[t] += cell;
        view.clear_mm2[t] += cell * weight;
        view.off_centre_mm2 += cell * weight * across;
        if (weight > 0 && t + 1 == wanted.targets.size()) view.deepest_mm = std::max(view.deepest_mm, r);
      }
    }
  }
  return view;
}

void WindowSearch::rate(const WantedPicture& wanted, std::vector<Choice>& choices) const {
  tbb::parallel_for(std::size_t(0), choices.size(), [&](std::size_t c) {
    Choice& choice = choices[c];
    choice.rating = 0;
    const auto pose = place(wanted, choice);
    if (!pose) return;
    const View view = look(wanted, *pose);
    if (view.clear() <= 0) return;
    const double least = *std::min_element(view.clear_mm2.begin(), view.clear_mm2.end());
    const double way = glm::distance(pose->translation, wanted.aim);
    choice.rating =
        least * (1 - kHalfOff * std::abs(view.off_centre_mm2) / view.clear()) * std::exp(-way / kTypicalWay_mm);
  });
  std::erase_if(choices, [](const Choice& choice) { return choice.rating <= 0; });
  std::stable_sort(choices.begin(), choices.end(),
                   [](const Choice& a, const Choice& b) { return a.rating > b.rating; });
}

double WindowSearch::section_mm2(const WantedPicture& wanted, const Pose& pose) const {
  constexpr double kReach_mm = 300, kStep_mm = 2;
  double area = 0;
  for (double x = -kReach_mm; x <= kReach_mm; x += kStep_mm)
    for (double y = 0; y <= 2 * kReach_mm; y += kStep_mm) {
      const std::uint8_t label =
          sample_nearest(subject_->labels, subject_->labels.grid.index_from_patient(pose.point({x, y, 0})));
      if (label && std::find(wanted.targets.begin(), wanted.targets.end(), label) != wanted.targets.end())
        area += kStep_mm * kStep_mm;
    }
  return area;
}

std::optional<Window> WindowSearch::best(const WantedPicture& wanted) const {
  constexpr int kRound_deg = 5, kLean_deg = 10, kMaxLean_deg = 40, kMaxTilt_deg = 20;
  std::vector<Choice> coarse;
  const int most = wanted.along ? kMaxLean_deg : kMaxTilt_deg;
  for (int round = 0; round < 360; round += kRound_deg)
    for (int lean = -most; lean <= most; lean += kLean_deg)
      for (const double press : kPresses_mm) coarse.push_back({double(round), double(lean), 0, press});
  rate(wanted, coarse);
  if (coarse.empty()) return std::nullopt;

  constexpr std::size_t kRefined = 4;
  std::vector<Choice> fine;
  for (std::size_t c = 0; c < std::min(kRefined, coarse.size()); ++c)
    for (const double round : {-2.5, 0.0, 2.5})
      for (const double lean : {-5.0, 0.0, 5.0})
        for (const double rock : {-20.0, -10.0, 0.0, 10.0, 20.0}) {
          Choice choice = coarse[c];
          choice.round_deg += round;
          choice.lean_deg = std::clamp(choice.lean_deg + lean, double(-most), double(most));
          choice.rock_deg = rock;
          fine.push_back(choice);
        }
  rate(wanted, fine);

  const Pose pose = *place(wanted, fine.front());
  const View view = look(wanted, pose);
  const double section = section_mm2(wanted, pose);
  return Window{pose, view.deepest_mm, view.clear() / view.seen(),
                section > 0 ? std::min(1.0, view.clear() / section) : 0};
}

}  // namespace insonate
