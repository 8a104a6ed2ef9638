#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "scenarios/result_json.h"
#include "scenarios/results/export/report_files.h"
#include "sim/core/input_error.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

struct ReportRequest {
  std::filesystem::path database;
  std::int64_t attempt = 0;
  std::filesystem::path out = ".";
  std::string home_page;
};

int report(const ReportRequest& given) {
  if (!given.home_page.empty() && given.home_page.find("://") == std::string::npos)
    throw InputError("command line", "--home-page", "'" + given.home_page + "' is not a web address",
                     "give one like https://lab.example/learners");
  ResultsDatabase database = ResultsDatabase::open(given.database);
  bool all = true;
  for (const std::int64_t number : chosen_attempts(database, given.attempt)) try {
      const Attempt attempt = database.read(number);
      result_from_json(attempt.score_json, database.file().string() + ": attempt " + std::to_string(number));
      const std::filesystem::path folder = given.out / ("attempt-" + std::to_string(number));
      std::printf("wrote %s\n", write_report_files(folder, attempt, given.home_page).report.c_str());
    } catch (const InputError& error) {  // a damaged attempt must not prevent the reports of the others
      std::fprintf(stderr, "insonate-score: %s\n", error.what());
      all = false;
    }
  return all ? 0 : 2;
}

}  // namespace

void add_report_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<ReportRequest>();
  CLI::App* command = arguments.add_subcommand(
      "report",
      "Write the reports of attempts in a database, each to a folder of its own: report.html, score.json, score.csv "
      "and xapi.json, as they were at the end of the exam");
  command->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  command->add_option("--attempt", given->attempt, "Write only the report of the attempt with this number")
      ->type_name("NUMBER")
      ->check(CLI::PositiveNumber);
  command->add_option("--out", given->out, "Make the folders in this folder")
      ->type_name("FOLDER")
      ->capture_default_str();
  command
      ->add_option("--home-page", given->home_page,
                   "Name this web address in xapi.json as the one that the learners' ids belong to")
      ->type_name("URL")
      ->default_str("an address that stands for the database");
  command->callback([given, &run] { run = [given] { return report(*given); }; });
}

}  // namespace insonate
