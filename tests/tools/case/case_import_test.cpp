// insonate-case import and add-view as a lab runs them: from files to a case that can be scored.

#include <glm/geometric.hpp>

#include "devices/sequence/sequence.h"
#include "sim/volume/case.h"
#include "tests/tools/case/case_workplace.h"

using namespace insonate;

namespace {

// A block of tissue with a ball in it, in 2 mm voxels; by TotalSegmentator's table its labels are the spleen (1) and
// the right kidney (2).
const std::string kTrunkRecipe = R"(name = "Trunk"
grid = { from = [-70, -60, -50], to = [70, 60, 50], voxel_mm = 2 }
labels = [{ name = "block", tissue = "soft_tissue", hu = 40 }, { name = "ball", tissue = "liver", hu = 60 }]
shapes = [
  { name = "block", kind = "box", centre = [0, 0, 0], half_sizes = [60, 40, 48], label = "block" },
  { name = "ball", kind = "ellipsoid", centre = [-10, 0, 4], radii = [14, 12, 20], label = "ball" }]
landmarks = [{ name = "middle", at = [-10, 0, 4] }]
views = [{ name = "front", title = "From the front", probe = "curvilinear", aim = "middle", from = [-10, -60, 4], marker = [0, 0, 1], press_mm = 8, landmarks = ["middle"], targets = ["ball"] }]
)";

struct Lab : Workplace {
  std::string ct, labels, out;

  Lab() {
    const auto recipe_file = folder.put("trunk.toml", kTrunkRecipe), scan = folder.path / "scan";
    REQUIRE(run("phantom --recipe " + recipe_file.string() + " " + scan.string()).code == 0);
    ct = (scan / "ct.nrrd").string();
    labels = (scan / "labels.nrrd").string();
    out = (folder.path / "patient7").string();
  }

  std::string import(const std::string& more = "--label-table total") const {
    return "import --ct " + ct + " --labels " + labels + " --out " + out + " " + more;
  }

  void make() const {
    const ProgramOutcome outcome = run(import());
    INFO(outcome.errors);
    REQUIRE(outcome.code == 0);
  }
};

std::string pose_text(const Pose& pose) {
  std::string text;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) text += std::to_string(pose.matrix()[c][r]) + " ";
  return text;
}

}  // namespace

TEST_CASE("insonate-case import makes a case with named targets, landmarks and views, and says what it did") {
  const Lab lab;
  const ProgramOutcome outcome = lab.run(lab.import("--label-table total --name 'Patient 7'"));
  INFO(outcome.errors << outcome.output);
  REQUIRE(outcome.code == 0);
  CHECK(contains(outcome.errors, "Importing: 100 %\n"));
  CHECK(contains(outcome.output, "2 structures"));
  CHECK(contains(outcome.output, "View 'kidney_right_long' shows"));
  const Case made = read_case(lab.out);
  CHECK(made.name == "Patient 7");
  CHECK(made.ct.grid.spacing == glm::dvec3(1.0));
  REQUIRE(made.find_label("kidney_right"));
  CHECK(made.find_label("kidney_right")->tissue == "kidney_cortex");
  REQUIRE(made.find_landmark("kidney_right_centre"));
  CHECK(glm::distance(made.find_landmark("kidney_right_centre")->position, glm::dvec3(-10, 0, 4)) < 1);
  CHECK(made.find_landmark("kidney_right_upper_pole")->position.z > 4 + 15);
  REQUIRE(made.find_view("kidney_right_long"));
  CHECK(made.find_view("kidney_right_short"));
  CHECK(made.find_view("kidney_right_long")->landmarks.size() == 3);
}

TEST_CASE("a case with an expert's view is written over only when that is asked for") {
  const Lab lab;
  REQUIRE(lab.run(lab.import("--label-table total")).code == 0);
  CHECK(read_case(lab.out).name == std::filesystem::path(lab.out).filename());
  ReferenceView expert = read_case(lab.out).views.front();
  expert.name = "expert";
  append_view(lab.out, expert);
  const ProgramOutcome again = lab.run(lab.import("--label-table total"));
  CHECK(again.code == 2);
  CHECK(contains(again.errors, "there is a case already"));
  CHECK(read_case(lab.out).find_view("expert"));
  REQUIRE(lab.run(lab.import("--label-table total --replace")).code == 0);
  CHECK_FALSE(read_case(lab.out).find_view("expert"));
}

TEST_CASE("insonate-case import refuses in a sentence what it cannot use, and writes nothing") {
  const Lab lab;
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const ProgramOutcome outcome = lab.run(arguments);
    INFO(outcome.output << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.output.empty());
    CHECK(contains(outcome.errors, "insonate-case: "));  // after the progress
    CHECK(contains(outcome.errors, words));
  };
  refused(lab.import(""), "labels.nrrd: its header does not name its labels");
  refused(lab.import("--label-table totl"), "did you mean 'total'");
  const std::string out = " --out " + lab.out;
  refused("import --ct /nowhere.nii --labels " + lab.labels + out, "/nowhere.nii: there is no such file");
  CHECK_FALSE(std::filesystem::exists(lab.out));
  CHECK(lab.run("import --ct " + lab.ct).code == 2);
}

TEST_CASE("insonate-case add-view adds the plane of a pose file or of a moment in a log") {
  const Lab lab;
  lab.make();
  const std::size_t before = read_case(lab.out).views.size();
  const Pose held = read_case(lab.folder.path / "scan").find_view("front")->patient_from_probe;
  const auto pose_file = lab.folder.put("pose.txt", pose_text(held));
  const ProgramOutcome by_pose = lab.run("add-view " + lab.out + " --name by_pose --targets kidney_right --pose " +
                                         pose_file.string() + " --landmarks kidney_right_centre --depth 140");
  INFO(by_pose.errors);
  REQUIRE(by_pose.code == 0);

  // A hand that comes down onto the skin in two seconds; for the last the tracker does not see it.
  std::vector<ProbeSample> samples;
  for (int i = 0; i <= 30; ++i) {
    ProbeSample sample;
    sample.time_s = 100 + i * 0.1;
    sample.status = i > 20 ? PoseStatus::out_of_view : PoseStatus::ok;
    sample.patient_from_probe = held;
    sample.patient_from_probe.translation.y -= std::max(0, 20 - i);
    samples.push_back(sample);
  }
  const auto log = lab.folder.put("expert.igs.mha", write_sequence(samples)).string();
  const std::string add = "add-view " + lab.out + " --name by_log --targets kidney_right,spleen --log " + log;
  const ProgramOutcome by_log = lab.run(add + " --at 1.99 --title 'As the expert held it'");
  INFO(by_log.errors);
  REQUIRE(by_log.code == 0);

  const Case made = read_case(lab.out);
  REQUIRE(made.views.size() == before + 2);
  CHECK(made.find_view("by_pose")->title == "By pose");
  CHECK(made.find_view("by_pose")->depth_mm == 140);
  CHECK(made.find_view("by_log")->title == "As the expert held it");
  CHECK(made.find_view("by_log")->targets.size() == 2);
  CHECK(made.find_view("by_log")->patient_from_probe == held);

  const std::string again = "add-view " + lab.out + " --name other --targets kidney_right ";
  lab.refused(again, {"--pose"});
  lab.refused(again + "--log " + log + " --at 2.5", {"expert.igs.mha", "second 2.5", "no valid pose"});
  lab.refused(again + "--log " + log + " --at 0", {"not on the skin"});
  lab.refused("add-view " + lab.out + " --name by_pose --pose " + pose_file.string(), {"has a view of this name"});
  lab.refused("add-view /nowhere --name a --pose " + pose_file.string(), {"/nowhere"});
  CHECK(lab.run(again + "--log " + log).code == 2);  // no moment
  CHECK(lab.run(again + "--pose " + pose_file.string() + " --log " + log + " --at 1").code == 2);
  CHECK(read_case(lab.out).views.size() == before + 2);
}
