#include "sim/volume/open_case.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>

#include "sim/volume/ct_reader.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr double kBody_hu = -300;
constexpr double kThick_mm = 20;

ReferenceView looking_in(std::string name, std::string title, const glm::dvec3& face, const glm::dvec3& into,
                         const glm::dvec3& marker) {
  ReferenceView view;
  view.name = std::move(name);
  view.title = std::move(title);
  view.probe = "curvilinear";
  view.patient_from_probe = {glm::dmat3(marker, into, glm::cross(marker, into)), face};
  return view;
}

}  // namespace

std::optional<glm::dvec3> skin_along(const Volume<std::int16_t>& ct, const glm::dvec3& from,
                                     const glm::dvec3& direction, double reach_mm) {
  constexpr double kStep_mm = 0.5;
  std::optional<double> entered;
  for (double s = 0; s < reach_mm; s += kStep_mm) {
    if (sample_trilinear(ct, ct.grid.index_from_patient(from + s * direction)) < kBody_hu)
      entered.reset();
    else if (!entered)
      entered = s;
    else if (s - *entered >= kThick_mm)
      return from + *entered * direction;
  }
  return std::nullopt;
}

Case open_case(const fs::path& path) {
  std::error_code error;
  if (fs::exists(path / "case.toml", error)) return read_case(path);
  Case subject;
  subject.name = (path.has_filename() ? path : path.parent_path()).filename().string();
  subject.ct = read_ct(path);
  const glm::dvec3 spacing = subject.ct.grid.spacing;
  if (std::max({spacing.x, spacing.y, spacing.z}) > kInsonatedVoxel_mm)
    subject.ct = resample_isotropic(subject.ct, kInsonatedVoxel_mm, path.string());
  subject.views = default_views(subject.ct);
  return subject;
}

std::vector<std::string> tissue_by_label(const Case& subject) {
  std::vector<std::string> tissues(256);
  for (const Label& label : subject.label_table) tissues[label.value] = label.tissue;
  return tissues;
}

std::vector<ReferenceView> default_views(const Volume<std::int16_t>& ct, double press_mm) {
  const glm::dvec3 right(-1, 0, 0), back(0, 1, 0), head(0, 0, 1), left(1, 0, 0);
  const glm::dvec3 centre = ct.grid.centre();
  const double reach = glm::length(ct.grid.spacing * glm::dvec3(ct.grid.size));
  std::vector<ReferenceView> views;
  if (const auto skin = skin_along(ct, centre - reach / 2 * back, back, reach))
    views.push_back(looking_in("front", "From the front, across", *skin + press_mm * back, back, right));
  if (const auto skin = skin_along(ct, centre - reach / 2 * left, left, reach))
    views.push_back(looking_in("right_flank", "From the right flank, along", *skin + press_mm * left, left, head));
  return views;
}

}  // namespace insonate
