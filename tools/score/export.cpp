#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "scenarios/results/export/results_export.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

struct ExportRequest {
  std::filesystem::path database, out;
};

int export_tables(const ExportRequest& given) {
  ResultsDatabase database = ResultsDatabase::open(given.database);
  const ExportedResults exported = export_results(database, given.out);
  for (const std::filesystem::path& file : exported.files) std::printf("wrote %s\n", file.c_str());
  for (const std::string& problem : exported.problems) std::fprintf(stderr, "insonate-score: %s\n", problem.c_str());
  return exported.problems.empty() ? 0 : 2;
}

}  // namespace

void add_export_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<ExportRequest>();
  CLI::App* command = arguments.add_subcommand(
      "export",
      "Write all learners, attempts, scores of criteria and comments in a database as CSV files: learners.csv, "
      "attempts.csv, scores.csv and comments.csv");
  command->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  command->add_option("--out", given->out, "Make this folder, which must be new")->type_name("FOLDER")->required();
  command->callback([given, &run] { run = [given] { return export_tables(*given); }; });
}

}  // namespace insonate
