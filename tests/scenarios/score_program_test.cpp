#include <catch2/catch.hpp>
#include <sys/wait.h>

#include <cstdlib>

#include "devices/sequence/probe_samples.h"
#include "scenarios/result_json.h"
#include "scenarios/runner.h"
#include "sim/core/digest.h"
#include "sim/core/files.h"

using namespace insonate;

namespace {

const std::filesystem::path kAssets = INSONATE_ASSETS_FOLDER;

struct Outcome {
  int code;
  std::string output;
  std::string errors;
};

/// A folder of its own for files, gone at the end.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("insonate_score_" + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path file(const char* name, const std::string& text) const {
    write_file(path / name, text);
    return path / name;
  }
};

std::string text_of(const std::filesystem::path& file) {
  return std::filesystem::file_size(file) > 0 ? read_file(file) : "";
}

Outcome run(const Folder& folder, const std::string& arguments) {
  const auto output = folder.path / "output";
  const auto errors = folder.path / "errors";
  const int status = std::system(
      (std::string(INSONATE_SCORE_PROGRAM) + " " + arguments + " >" + output.string() + " 2>" + errors.string())
          .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(output), text_of(errors)};
}

/// The bundled exam on a phantom that is made in seconds.
std::string coarse_exam() {
  std::string text = read_file(kAssets / "scenarios" / "ruq_hepatorenal.toml");
  const std::string key = "free_fluid = true\n";
  return text.insert(text.find(key) + key.size(), "voxel_mm = 2\n");
}

}  // namespace

TEST_CASE("insonate-score prints the very score that the trainer comes to, and a failed exam is a result") {
  const Folder folder;
  const auto exam = folder.file("exam.toml", coarse_exam());
  const auto log = kAssets / "logs" / "ruq_poor.igs.mha";
  const auto report = folder.path / "report.html";
  const Outcome outcome =
      run(folder, "--log " + log.string() + " --scenario " + exam.string() + " --report " + report.string());
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.errors.empty());

  const Scenario scenario = read_scenario(exam);
  const Case subject = load_case(scenario, kAssets, cache_folder());
  Runner runner(scenario, subject, read_tissue_table(kAssets / "tissues.toml"));
  for (const PoseSample& sample : read_recorded_scan(log).samples) runner.feed(sample);
  runner.end();
  ExamResult expected = runner.result();
  expected.provenance.log = "ruq_poor.igs.mha";
  expected.provenance.log_digest = digest_of(read_file(log));
  expected.provenance.log_transform = "ProbeToTracker";
  CHECK(outcome.output == to_json(expected));
  CHECK_FALSE(result_from_json(outcome.output, "output").passed);
  CHECK(read_file(report).find("Not passed") != std::string::npos);
}

TEST_CASE("insonate-score says in one sentence what is wrong with its input, and exits with 2") {
  const Folder folder;
  const std::string log = (kAssets / "logs" / "ruq_good.igs.mha").string();
  const std::string exam = (kAssets / "scenarios" / "ruq_hepatorenal.toml").string();
  const std::string misspelt = folder.file("misspelt.toml", "format = 1\ntittle = \"x\"\n").string();
  const std::string elsewhere =
      folder
          .file("elsewhere.toml",
                [] {
                  std::string text = coarse_exam();
                  text.replace(text.find("view = \"hepatorenal\""), 20, "view = \"hepatorenl\"");
                  return text;
                }())
          .string();
  const std::string cut = folder.file("cut.igs.mha", read_file(log).substr(0, 5000)).string();

  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = run(folder, arguments);
    INFO(arguments << "\n" << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.output.empty());
    CHECK(outcome.errors.find(words) != std::string::npos);
  };
  refused("--scenario " + exam, "--log");
  refused("--log " + log, "--scenario");
  refused("--log /nowhere.mha --scenario " + exam, "/nowhere.mha");
  refused("--log " + exam + " --scenario " + exam, "ruq_hepatorenal.toml");
  refused("--log " + cut + " --scenario " + exam, "cut.igs.mha");
  refused("--log " + log + " --scenario " + misspelt, "did you mean 'title'?");
  refused("--log " + log + " --scenario " + exam + " --case /nowhere", "/nowhere");
  refused("--log " + log + " --scenario " + exam + " --cse x", "--cse");
  refused("check " + misspelt, "lacks the key 'case'");
  refused("check " + elsewhere,
          "step 2 names the view 'hepatorenl', which the case 'Abdomen phantom' does not have; did you mean "
          "'hepatorenal'?");
}

TEST_CASE("insonate-score check passes the bundled exam") {
  const Folder folder;
  const Outcome outcome = run(folder, "check " + folder.file("exam.toml", coarse_exam()).string());
  INFO(outcome.errors);
  CHECK(outcome.code == 0);
  CHECK(outcome.output.find("no problems found") != std::string::npos);
}
