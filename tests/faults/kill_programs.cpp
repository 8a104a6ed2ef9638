// The real programs, killed while they write.

#include <algorithm>

#include "devices/record/recording_files.h"
#include "devices/replay/read_log.h"
#include "devices/sequence/sequence.h"
#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "sim/core/input_error.h"
#include "sim/phantom/phantom.h"
#include "sim/volume/case.h"
#include "tests/faults/kill_checks.h"
#include "tests/faults/kill_kinds.h"
#include "tests/scenarios/tiny_case.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

const std::string kTrunkRecipe = R"(name = "Trunk"
grid = { from = [-70, -60, -50], to = [70, 60, 50], voxel_mm = 2 }
labels = [{ name = "block", tissue = "soft_tissue", hu = 40 }, { name = "ball", tissue = "liver", hu = 60 }]
shapes = [
  { name = "block", kind = "box", centre = [0, 0, 0], half_sizes = [60, 40, 48], label = "block" },
  { name = "ball", kind = "ellipsoid", centre = [-10, 0, 4], radii = [14, 12, 20], label = "ball" }]
landmarks = [{ name = "middle", at = [-10, 0, 4] }]
views = [{ name = "front", title = "From the front", probe = "curvilinear", aim = "middle", from = [-10, -60, 4], marker = [0, 0, 1], press_mm = 8, landmarks = ["middle"], targets = ["ball"] }]
)";

/// A program's own committing is not seen from outside; what a round must not lose is what earlier rounds left.
class Program : public Kind {
public:
  Program(std::string program, fs::path made) : Kind(std::move(program)), made_(std::move(made)) {}
  void write(const fs::path&, const Promises&, const Commit&) override {}

protected:
  /// Counted, so that a later round sees that an earlier one's is still there.
  static int counted(const fs::path& folder, const char* things, int now) {
    const fs::path file = folder / things;
    const int before = fs::exists(file) ? std::stoi(read_file(file)) : 0;
    require(now >= before, std::string("there were more ") + things);
    write_file(file, std::to_string(now));
    return before;
  }
  static void finish_recordings(const fs::path& folder) {
    for (const std::string& name : names_in(folder)) {
      if (!name.ends_with(".recording")) continue;
      const fs::path file = folder / name.substr(0, name.size() - std::string(".recording").size());
      const std::string text = fs::file_size(folder / name) > 0 ? read_file(folder / name) : "";
      std::size_t frames = 0;
      for (std::size_t at = 0; (at = text.find("\nframe ", at)) != std::string::npos; ++at)
        frames += text.find('\n', at + 1) != std::string::npos ? 1 : 0;
      const bool with_pictures = fs::exists(images_file(file));
      try {
        const std::size_t recovered = recover_recording(file);
        require(with_pictures || recovered >= frames, "a frame is lost");
      } catch (const InputError& error) {
        require(frames == 0 || with_pictures, error.what());
        remove_working_files(file);
      }
    }
    for (const std::string& name : names_in(folder))
      if (name.ends_with(".mha") && name.front() != '.') require(!read_log(folder / name).samples.empty(), name);
  }
  const fs::path made_;
};

class Watch : public Program {
public:
  explicit Watch(fs::path made) : Program("insonate-devices watch --record", std::move(made)) {}
  std::vector<std::string> command(const fs::path& folder, int round) override {
    return {INSONATE_DEVICES_PROGRAM,
            "watch",
            "synthetic:1?rate=200&live=1",
            "--seconds",
            "0.8",
            "--record",
            (folder / ("run-" + std::to_string(round) + ".igs.mha")).string()};
  }
  void check(const fs::path& folder, const Promises&) override {
    finish_recordings(folder);
    int files = 0;
    for (const std::string& name : names_in(folder)) files += name.front() != '.' && name.ends_with(".mha");
    counted(folder, "recordings", files);
  }
};

class Import : public Program {
public:
  explicit Import(fs::path made) : Program("insonate-case import --replace", std::move(made)) {}
  std::vector<std::string> command(const fs::path& folder, int) override {
    return {INSONATE_CASE_PROGRAM,
            "import",
            "--ct",
            (made_ / "scan" / "ct.nrrd").string(),
            "--labels",
            (made_ / "scan" / "labels.nrrd").string(),
            "--label-table",
            "total",
            "--out",
            (folder / "patient").string(),
            "--replace"};
  }
  void check(const fs::path& folder, const Promises&) override {
    const bool there = fs::exists(folder / "patient");
    if (there) {
      const Case found = read_case(folder / "patient");
      require(!found.views.empty() && !found.label_table.empty(), "half a case looks whole");
    }
    counted(folder, "cases", there ? 1 : 0);
  }
};

class Score : public Program {
public:
  explicit Score(fs::path made) : Program("insonate-score --results", std::move(made)) {}
  std::vector<std::string> command(const fs::path& folder, int round) override {
    return {INSONATE_SCORE_PROGRAM,         "--log",     (made_ / "scan.igs.mha").string(), "--scenario",
            (made_ / "exam.toml").string(), "--results", (folder / "results.db").string(),  "--learner",
            "L-" + std::to_string(round),   "--report",  (folder / "report.html").string()};
  }
  void check(const fs::path& folder, const Promises&) override {
    ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
    database.check();
    counted(folder, "attempts", int(database.attempts().size()));
    if (fs::exists(folder / "report.html"))
      require(read_file(folder / "report.html").find("</html>") != std::string::npos, "half a report looks whole");
  }
};

class Trainer : public Program {
public:
  explicit Trainer(fs::path made) : Program("insonate --headless", std::move(made)) {}
  std::vector<std::string> command(const fs::path& folder, int round) override {
    return {INSONATE_PROGRAM,
            "--headless",
            "--scenario",
            (made_ / "exam.toml").string(),
            "--tracker",
            "replay:" + (made_ / "scan.igs.mha").string(),
            "--record",
            (folder / ("run-" + std::to_string(round) + ".igs.mha")).string(),
            "--record-images",
            "--results",
            (folder / "results.db").string(),
            "--out",
            (folder / "out").string()};
  }
  void check(const fs::path& folder, const Promises&) override {
    finish_recordings(folder);
    ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
    database.check();
    counted(folder, "attempts", int(database.attempts().size()));
    if (const fs::path score = folder / "out" / "score.json"; fs::exists(score))
      result_from_json(read_file(score), score.string());
    for (const char* name : {"trainer.png", "score_sheet.png", "ultrasound.png"})
      if (const fs::path file = folder / "out" / name; fs::exists(file))
        require(read_file(file).ends_with(std::string("IEND\xae\x42\x60\x82")), std::string(name) + " is cut");
  }
};

}  // namespace

std::vector<std::unique_ptr<Kind>> program_kinds(const fs::path& made) {
  const std::string why = run_in_child([&] {
    write_case(made / "tiny", tiny_case());
    write_file(made / "exam.toml", kTinyScenario);
    write_file(made / "scan.igs.mha", write_sequence(samples_of(4, 60, [](double t) {
                 return Pose{glm::dmat3(1.0), {0, 1, std::max(2.0, 20 - 20 * t)}};
               })));
    write_case(made / "scan", make_phantom("trunk.toml", kTrunkRecipe));
  });
  require(why.empty(), why);
  std::vector<std::unique_ptr<Kind>> kinds;
  kinds.push_back(std::make_unique<Watch>(made));
  kinds.push_back(std::make_unique<Import>(made));
  kinds.push_back(std::make_unique<Score>(made));
  kinds.push_back(std::make_unique<Trainer>(made));
  return kinds;
}

}  // namespace insonate
