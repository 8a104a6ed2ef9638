#include "tools/dataset/shots.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <map>
#include <set>

#include "devices/sequence/sequence.h"
#include "sim/core/input_error.h"
#include "sim/tissue/skin_contact.h"
#include "sim/truth/picture_truth.h"
#include "tests/tools/dataset/study_folder.h"
#include "tools/dataset/dataset_image.h"
#include "tools/dataset/skin_poses.h"

using namespace insonate;

namespace {

const char* const kHead = "format = 1\nname = \"n\"\nseed = 3\nimages = 100\nshard_images = 10\n";
const char* const kCase = "[[case]]\nphantom = { voxel_mm = 4 }\n";

/// The built-in patient at 4 mm, made once.
const Case& phantom() {
  static const Case subject = make_phantom(
      "abdomen.toml", read_file(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "phantoms" / "abdomen.toml"),
      {{"voxel_mm", "4"}});
  return subject;
}

/// A study with its one patient.
struct Prepared {
  test::StudyFolder folder;
  Study study;
  std::vector<StudyPatient> patients;
  explicit Prepared(const std::string& text)
      : study(read_study(folder.file("study.toml", kHead + text))), patients(patients_of(study)) {}
  ShotMaker maker(const Case& subject = phantom()) const { return {study, patients.front(), subject}; }
};

std::string why_refused(const std::string& text, const Case& subject = phantom()) {
  const Prepared prepared(text);
  try {
    prepared.maker(subject).at(0);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

double angle_deg(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

}  // namespace

TEST_CASE("an image follows from its index alone, and no two are alike") {
  const Prepared prepared(std::string(kCase) +
                          "[[probe]]\nname = \"curvilinear\"\ndepth_mm = [100, 200]\n[[poses]]\nkind = \"skin\"\n");
  const ShotMaker maker = prepared.maker(), again = prepared.maker();
  std::set<double> positions;
  for (std::uint32_t i = 0; i < 20; ++i) again.at(19 - i);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const Shot a = maker.at(i), b = again.at(i);
    CHECK(a.patient_from_probe == b.patient_from_probe);
    CHECK(a.settings == b.settings);
    CHECK(a.depth_mm == b.depth_mm);
    CHECK(a.index == i);
    positions.insert(a.patient_from_probe.translation.x);
  }
  CHECK(positions.size() == 20);
}

TEST_CASE("poses on the skin are rigid, within their ranges, and touch") {
  const Prepared prepared(
      std::string(kCase) +
      "[[probe]]\nname = \"curvilinear\"\ndepth_mm = [100, 200]\nfrequency_mhz = [2, 5]\n[[poses]]\nkind = "
      "\"skin\"\naround_deg = [0, 60]\nheight_percent = [40, 60]\n");
  const ShotMaker maker = prepared.maker();
  const Grid& grid = phantom().ct.grid;
  const double low = grid.origin.z, span = grid.spacing.z * (grid.size.z - 1);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Shot shot = maker.at(i);
    const Pose& pose = shot.patient_from_probe;
    CHECK_FALSE(why_not_rigid(pose.matrix()));
    CHECK(SkinContact(phantom().ct, shot.probe).at(pose));
    CHECK(std::fmod(shot.depth_mm, 10) == 0);
    CHECK((shot.depth_mm >= 100 && shot.depth_mm <= 200));
    CHECK(std::fmod(shot.settings.frequency_mhz, 0.5) == 0);
    CHECK(shot.pose_source == "skin");
    // The face is pressed in by at most 10 mm along a normal, so that it is moved by at most that in z.
    CHECK(pose.translation.z > low + 0.4 * span - 10);
    CHECK(pose.translation.z < low + 0.6 * span + 10);
    CHECK(pose.translation.x > -15);  // in front and on the patient's left
    // The beam runs into the body: towards its axis within the tilts, and what the skin's normal is off by.
    const glm::dvec3 inwards =
        glm::normalize(glm::dvec3(grid.centre().x, grid.centre().y, pose.translation.z) - pose.translation);
    CHECK(angle_deg(pose.rotation[1], inwards) < 60);
  }
}

TEST_CASE("without tilts the beam runs along the skin's normal, and the marker lies to the right in front") {
  Volume<std::int16_t> ct;
  ct.grid.size = glm::ivec3(101, 101, 101);
  ct.grid.spacing = glm::dvec3(2);
  ct.grid.origin = glm::dvec3(-100, -100, -100);
  ct.voxels.assign(ct.grid.count(), -1000);
  // A cone around z whose skin leans by 20 degrees.
  const double slope = std::tan(glm::radians(20.0));
  for (int z = 0; z < 101; ++z)
    for (int y = 0; y < 101; ++y)
      for (int x = 0; x < 101; ++x) {
        const glm::dvec3 p = ct.grid.patient_from_index(glm::dvec3(x, y, z));
        // Densities fall over 4 mm, so that the surface lies between voxels.
        const double depth = 60 - slope * p.z - glm::length(glm::dvec2(p));
        ct.at({x, y, z}) = std::int16_t(glm::clamp(-475 + 250 * depth, -1000.0, 50.0));
      }
  for (const double around : {-170.0, -90.0, 0.0, 45.0, 120.0}) {
    const auto pose = pose_on_skin(ct, around, 10);
    REQUIRE(pose);
    CHECK_FALSE(why_not_rigid(pose->matrix()));
    const double angle = glm::radians(around), lean = glm::radians(20.0);
    const glm::dvec3 outwards(std::sin(angle), -std::cos(angle), 0);
    const glm::dvec3 beam = -(std::cos(lean) * outwards + std::sin(lean) * glm::dvec3(0, 0, 1));
    CHECK(angle_deg(pose->rotation[1], beam) < 2);  // voxels of 2 mm over 20 mm
    CHECK(angle_deg(pose->rotation[0], -glm::dvec3(std::cos(angle), std::sin(angle), 0)) < 2);
    CHECK(glm::length(glm::dvec2(pose->translation)) == Approx(60 - slope * 10).margin(1));
    CHECK(pose->translation.z == Approx(10).margin(1e-9));
  }
  CHECK_FALSE(pose_on_skin(ct, 0, 500));
}

TEST_CASE("poses at views keep to their ranges, and to the probe of each view") {
  const Prepared prepared(std::string(kCase) +
                          "[[probe]]\nname = \"curvilinear\"\n[[poses]]\nkind = \"view\"\ntilt_deg = [-3, 3]\nrock_deg "
                          "= [-3, 3]\nturn_deg = "
                          "[-4, 4]\nslide_mm = 5\npress_mm = [0, 2]\n");
  const ShotMaker maker = prepared.maker();
  std::map<std::string, int> seen;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Shot shot = maker.at(i);
    REQUIRE(shot.pose_source.starts_with("view "));
    ++seen[shot.pose_source];
    const ReferenceView& view = *phantom().find_view(shot.pose_source.substr(5));
    CHECK(view.probe == shot.probe.name);
    const Pose change = view.patient_from_probe.inverse() * shot.patient_from_probe;
    CHECK(std::abs(change.translation.x) <= 5);
    CHECK(std::abs(change.translation.z) <= 5);
    CHECK((change.translation.y >= -1e-9 && change.translation.y <= 2));
    CHECK(angle_between_deg(view.patient_from_probe, shot.patient_from_probe) <= 10);  // at most the sum of the three
  }
  CHECK(seen.size() > 3);
}

TEST_CASE("poses of a log are those of its samples") {
  const std::string log = (std::filesystem::path(INSONATE_ASSETS_FOLDER) / "logs" / "ruq_good.igs.mha").string();
  const Prepared prepared(std::string(kCase) +
                          "[[probe]]\nname = \"curvilinear\"\n[[poses]]\nkind = \"log\"\nfile = \"" + log + "\"\n");
  const ShotMaker maker = prepared.maker();
  std::set<std::string> sources;
  for (std::uint32_t i = 0; i < 50; ++i) sources.insert(maker.at(i).pose_source);
  CHECK(sources.size() > 40);
  CHECK(sources.begin()->starts_with("log ruq_good.igs.mha, sample "));
}

TEST_CASE("poses that a patient does not have are refused, with place and remedy") {
  const std::string linear = "[[probe]]\nname = \"linear\"\n", curved = "[[probe]]\nname = \"curvilinear\"\n";
  const struct {
    std::string text, problem;
  } cases[] = {
      {kCase + curved + "[[poses]]\nkind = \"view\"\nviews = [\"hepatorenla\"]\n",
       "line 12, column 9: the patient 'abdomen' has no view 'hepatorenla'; did you mean 'hepatorenal'?"},
      {kCase + linear + "[[poses]]\nkind = \"view\"\nviews = [\"hepatorenal\"]\n",
       "line 12, column 9: the view 'hepatorenal' is held with the probe 'curvilinear', which the study does not list"},
      {kCase + linear + "[[poses]]\nkind = \"view\"\n",
       "line 11, column 8: the patient 'abdomen' has no view that is held with"},
      {kCase + curved +
           "[[poses]]\nkind = \"log\"\nfile = \"" INSONATE_ASSETS_FOLDER
           "/logs/ruq_good.igs.mha\"\ntransform = \"ToolToTracker\"\n",
       "study.toml: line 12, column 8: " INSONATE_ASSETS_FOLDER
       "/logs/ruq_good.igs.mha: no frame has the transform 'ToolToTracker'"},
      {std::string("[[case]]\nname = \"other\"\n") + kCase + curved +
           "[[poses]]\nkind = \"skin\"\ncases = [\"abdomen\"]\n",
       "no [[poses]] apply to the case 'other'"},
      {kCase + curved + "[[poses]]\nkind = \"view\"\nviews = [\"hepatorenal\"]\npress_mm = -20\n",
       "line 11, column 8: of 1000 poses that were drawn for image 0, none has the probe on the skin"},
  };
  for (const auto& bad : cases) {
    const std::string why = why_refused(bad.text);
    INFO(bad.text << " -> " << why);
    CHECK(why.find(bad.problem) != std::string::npos);
  }
  Case without_views = phantom();
  without_views.views.clear();
  CHECK(why_refused(kCase + curved + "[[poses]]\nkind = \"view\"\nviews = [\"front\"]\n", without_views)
            .find("has no view 'front'; add one with insonate-case add-view") != std::string::npos);
  // A view of another probe, on purpose.
  const Prepared other(kCase + linear + "[[poses]]\nkind = \"view\"\nprobes = [\"linear\"]\n");
  CHECK(other.maker().at(0).probe.name == "linear");
}

TEST_CASE("a log of another patient, whose probe lies within this one, is refused") {
  const std::string curved = "[[probe]]\nname = \"curvilinear\"\n[[poses]]\nkind = ";
  ProbeSample sample{0, PoseStatus::ok, Pose()};
  sample.patient_from_probe =
      Prepared(kCase + curved + "\"view\"\nviews = [\"hepatorenal\"]\n").maker().at(0).patient_from_probe;
  const test::StudyFolder folder;
  const auto of_log = [&](double deeper_mm) {
    ProbeSample moved = sample;
    moved.patient_from_probe.translation += deeper_mm * moved.patient_from_probe.direction({0, 1, 0});
    const auto log = folder.file("deep.igs.mha", write_sequence(std::vector{moved}));
    return why_refused(kCase + curved + "\"log\"\nfile = \"" + log.string() + "\"\n");
  };
  CHECK(of_log(0) == "");
  CHECK(of_log(90).find("none has the probe on the skin of the patient") != std::string::npos);
}

TEST_CASE("images are turned as clinics show them, and their matrix leads to the patient") {
  const Prepared prepared(std::string(kCase) + "[settings]\nimage_width = 120\nimage_height = 90\n" +
                          "[[probe]]\nname = \"curvilinear\"\n[[poses]]\nkind = \"skin\"\n");
  const TissueTable tissues = read_tissue_table(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "tissues.toml");
  TruthMaker maker(phantom(), tissues);
  const Shot shot = prepared.maker().at(5);
  Image<std::uint8_t> grey(120, 90);
  for (int x = 0; x < 120; ++x) grey.at(x, 40) = std::uint8_t(x);
  const DatasetImage image = with_truth(Shot(shot), grey, maker);
  int labelled = 0;
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) {
      if (image.truth.reach.at(x, y) == int(Reach::outside)) continue;
      const glm::dvec3 p(image.patient_from_pixel * glm::dvec4(x, y, 0, 1));
      const int wanted = sample_nearest(phantom().labels, phantom().ct.grid.index_from_patient(p));
      // Positions at the border of two voxels are rounded in another order.
      const glm::dvec3 index = phantom().ct.grid.index_from_patient(p) - 0.5;
      const glm::dvec3 to_border = glm::abs(index - glm::round(index));
      if (std::min({to_border.x, to_border.y, to_border.z}) > 1e-9) REQUIRE(int(image.truth.label.at(x, y)) == wanted);
      labelled += wanted != 0;
    }
  CHECK(labelled > 2000);
  CHECK(image.grey.at(0, 40) == 119);
  // The marker is on the left.
  const Pose probe_from_patient = shot.patient_from_probe.inverse();
  CHECK(probe_from_patient.point(glm::dvec3(image.patient_from_pixel * glm::dvec4(0, 80, 0, 1))).x > 10);
  CHECK(image.settings.find("\"image_width\":120") != std::string::npos);

  // The digest covers every part.
  DatasetImage other = with_truth(Shot(shot), grey, maker);
  CHECK(other.digest == image.digest);
  grey.at(3, 3) = 1;
  CHECK(with_truth(Shot(shot), grey, maker).digest != image.digest);
  grey.at(3, 3) = 0;
  Shot elsewhere = shot;
  elsewhere.settings.gain_db += 1;
  CHECK(with_truth(Shot(elsewhere), grey, maker).digest != image.digest);
}

TEST_CASE("a log without a pose of the probe is refused") {
  const test::StudyFolder folder;
  std::string text =
      "ObjectType = Image\nNDims = 3\nDimSize = 1 1 2\nElementType = MET_UCHAR\nSeq_Frame0000_Timestamp = 0\n"
      "Seq_Frame0000_ProbeToPatientTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0000_ProbeToPatientTransformStatus = INVALID\nSeq_Frame0001_Timestamp = 1\n"
      "Seq_Frame0001_ProbeToPatientTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0001_ProbeToPatientTransformStatus = INVALID\nElementDataFile = LOCAL\n";
  const std::filesystem::path log = folder.path / "lost.igs.mha";
  write_file(log, text + std::string(2, '\0'));
  CHECK(why_refused(std::string(kCase) + "[[probe]]\nname = \"curvilinear\"\n[[poses]]\nkind = \"log\"\nfile = \"" +
                    log.string() + "\"\n")
            .find("holds no pose of the probe; take a log of a probe that was tracked") != std::string::npos);
}
