#include "scenarios/cases/import_case.h"

#include <algorithm>
#include <cmath>

#include "scenarios/cases/anatomy.h"
#include "scenarios/cases/body.h"
#include "scenarios/cases/kidney_sinus.h"
#include "scenarios/cases/plausibility.h"
#include "scenarios/cases/segmentation.h"
#include "scenarios/cases/suggested_views.h"
#include "sim/core/input_error.h"
#include "sim/volume/ct_reader.h"
#include "sim/volume/open_case.h"

namespace insonate {
namespace {

// Shares of the work for a 2 mm CT of an abdomen; used only for the progress.
constexpr double kCtRead = 0.1, kLabelsRead = 0.3, kBodyFound = 0.4;

Volume<std::int16_t> read_at_working_spacing(const ImportRequest& request) {
  Volume<std::int16_t> ct = read_ct(request.ct);
  const glm::dvec3 spacing = ct.grid.spacing;
  if (std::max({spacing.x, spacing.y, spacing.z}) > kInsonatedVoxel_mm)
    ct = resample_isotropic(ct, kInsonatedVoxel_mm, request.ct.string());
  return ct;
}

/// Removes everything around the body, and the labels there. Returns the body.
BodyMask clear_surroundings(const std::string& ct_name, Case& subject, std::vector<std::string>& notes) {
  BodyMask body = find_body(subject.ct);
  if (body.empty())
    throw InputError(ct_name, "", "there is no body in it: nothing denser than -500 HU is thicker than 7 mm",
                     "give a CT in Hounsfield units");
  const glm::dvec3 s = subject.ct.grid.spacing;
  const double cleared_ml = double(clear_around(body, subject.ct)) * s.x * s.y * s.z / 1000;
  if (cleared_ml >= 1)
    notes.push_back(std::to_string(std::lround(cleared_ml)) +
                    " ml around the body, such as table, clothes or arms, became air.");
  std::size_t outside = 0;
  for (std::size_t v = 0; v < body.voxels.size(); ++v)
    if (!body.voxels[v] && subject.labels.voxels[v]) {
      subject.labels.voxels[v] = 0;
      ++outside;
    }
  if (outside > 0) notes.push_back(std::to_string(outside) + " labelled voxels outside the body lost their label.");
  return body;
}

void note_cut_organs(const Anatomy& anatomy, std::vector<std::string>& notes) {
  for (const StructureShape* organ : anatomy.organs)
    if (organ->cut)
      notes.push_back("The CT ends within '" + organ->label.name +
                      "': its axes, ends and centre are those of the part that is there.");
}

}  // namespace

ImportedCase import_case(const ImportRequest& request, const TissueTable& tissues, const Progress& progress) {
  const auto report_progress = [&](double share) {
    if (progress) progress(share);
  };
  report_progress(0);
  ImportedCase made;
  Case& subject = made.subject;
  subject.name = request.name.empty() ? "Patient" : request.name;
  subject.ct = read_at_working_spacing(request);
  report_progress(kCtRead);
  Segmentation segmentation =
      read_segmentation(request.labels, subject.ct.grid, request.label_table,
                        [&](double share) { report_progress(kCtRead + share * (kLabelsRead - kCtRead)); });
  subject.labels = std::move(segmentation.labels);
  subject.label_table = std::move(segmentation.table);
  made.notes = std::move(segmentation.notes);
  report_progress(kLabelsRead);

  // Checked before the surroundings are cleared: labels outside the body indicate labels of another scan.
  for (std::string& note : check_plausible(request.labels.string(), subject, structure_shapes(subject)))
    made.notes.push_back(std::move(note));
  const BodyMask body = clear_surroundings(request.ct.string(), subject, made.notes);
  for (std::string& note : label_kidney_sinuses(subject)) made.notes.push_back(std::move(note));
  report_progress(kBodyFound);

  const std::vector<StructureShape> shapes = structure_shapes(subject);
  std::erase_if(subject.label_table, [&](const Label& label) {
    return std::none_of(shapes.begin(), shapes.end(), [&](const auto& s) { return s.label.value == label.value; });
  });
  const Anatomy anatomy = find_anatomy(subject, shapes);
  note_cut_organs(anatomy, made.notes);
  subject.landmarks = landmarks_of(anatomy);
  SuggestedViews suggested = suggest_views(
      subject, anatomy, body, tissues, [&](double share) { report_progress(kBodyFound + share * (1 - kBodyFound)); });
  subject.views = std::move(suggested.views);
  for (std::string& note : suggested.notes) made.notes.push_back(std::move(note));
  report_progress(1);
  return made;
}

}  // namespace insonate
