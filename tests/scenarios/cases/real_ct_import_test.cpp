// A real CT with TotalSegmentator's labels, from files to views.

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>

#include "scenarios/cases/acoustic_window.h"
#include "scenarios/cases/import_case.h"
#include "scenarios/cases/plausibility.h"
#include "scenarios/cases/suggested_views.h"
#include "scenarios/metrics/view_meter.h"
#include "sim/tissue/skin_contact.h"

using namespace insonate;

namespace {

const std::filesystem::path kScans = INSONATE_SCANS_FOLDER "/abdomen_ct";

}  // namespace

TEST_CASE("a real CT with TotalSegmentator's labels becomes a case with views that show their organs") {
  const std::filesystem::path ct = kScans / "upper_ct.nii.gz", labels = kScans / "upper_labels.nii.gz";
  if (!std::filesystem::exists(ct) || !std::filesystem::exists(labels)) {
    WARN("skipped: there are no real scans in " << kScans);
    return;
  }
  const TissueTable tissues = read_tissue_table(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "tissues.toml");
  std::vector<double> shares;
  const ImportedCase imported =
      import_case({ct, labels, "", "Upper abdomen"}, tissues, [&](double share) { shares.push_back(share); });
  CHECK(std::is_sorted(shares.begin(), shares.end()));
  CHECK(shares.back() == 1);

  const Case& subject = imported.subject;
  CHECK(subject.name == "Upper abdomen");
  CHECK(subject.ct.grid.spacing == glm::dvec3(1.0));
  CHECK(subject.labels.grid.size == subject.ct.grid.size);
  // The slab's own figures, in 3 mm voxels: 38634 of liver; smooth surfaces keep its volume.
  const auto liver = subject.find_label("liver");
  REQUIRE(liver);
  CHECK(double(std::count(subject.labels.voxels.begin(), subject.labels.voxels.end(), liver->value)) ==
        Approx(38634 * 27).epsilon(0.01));
  for (const char* name : {"kidney_right_sinus", "kidney_left_sinus"}) {
    const Label* sinus = subject.find_label(name);
    REQUIRE(sinus);
    CHECK(std::count(subject.labels.voxels.begin(), subject.labels.voxels.end(), sinus->value) > 5000);
  }
  const Landmark *right = subject.find_landmark("kidney_right_centre"),
                 *left = subject.find_landmark("kidney_left_centre");
  REQUIRE(right);
  REQUIRE(left);
  CHECK(right->position.x < left->position.x);

  INFO("labels of the same grid that belong 20 mm to the side are not this CT's");
  Case beside = subject;
  std::rotate(beside.labels.voxels.begin(), beside.labels.voxels.begin() + 20, beside.labels.voxels.end());
  CHECK(check_plausible("labels", subject, structure_shapes(subject)).empty());
  CHECK_THROWS_WITH(check_plausible("labels", beside, structure_shapes(beside)), Catch::Contains("on their bones"));

  for (const char* name : {"liver_short", "aorta_long"}) {
    INFO(name);
    CHECK(subject.find_view(name));
  }
  for (const ReferenceView& view : subject.views) {
    INFO(view.name);
    const Probe& probe = *find_probe(view.probe);
    CHECK(SkinContact(subject.ct, probe).at(view.patient_from_probe));
    const ViewValues values = ViewMeter(subject, view, tissues).measure(view.patient_from_probe);
    CHECK(values.target_insonated_percent == Approx(100));
    if (!view.landmarks.empty()) CHECK(values.landmarks_in_view_percent == 100);
    CHECK(values.off_centre_percent < 60);
  }
}
