#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "scenarios/results/database/results_database.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

struct CommentRequest {
  std::filesystem::path database;
  std::int64_t attempt = 0, removed = 0;
  std::string text, author;
};

int comment(const CommentRequest& given) {
  if (given.removed != 0) {
    ResultsDatabase::open(given.database).remove_comment(given.removed);
    std::printf("comment %lld is removed\n", static_cast<long long>(given.removed));
    return 0;
  }
  if (given.attempt == 0) throw CLI::RequiredError("--attempt or --remove");
  if (given.text.empty()) throw CLI::RequiredError("--text");
  Comment made;
  made.attempt = given.attempt;
  made.author = given.author;
  made.text = given.text;
  check_comment(made, "command line");
  made.written_ms = now_since_1970_ms();
  ResultsDatabase::open(given.database).add(made);
  std::printf("comment %lld on attempt %lld\n", static_cast<long long>(made.number),
              static_cast<long long>(made.attempt));
  return 0;
}

}  // namespace

void add_comment_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<CommentRequest>();
  CLI::App* command = arguments.add_subcommand(
      "comment",
      "Store a comment with an attempt, for its report, or remove one. The attempt itself never changes. 'attempts' "
      "lists the comments");
  command->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  CLI::Option* attempt = command->add_option("--attempt", given->attempt, "Comment on the attempt with this number");
  attempt->type_name("NUMBER")->check(CLI::PositiveNumber);
  CLI::Option* text = command->add_option(
      "--text", given->text,
      "Store this text: one paragraph of at most " + std::to_string(Comment::kMaxCharacters) + " characters");
  text->type_name("TEXT");
  CLI::Option* author =
      command->add_option("--author", given->author, "State this id as the author's, which is not a name");
  author->type_name("ID");
  command->add_option("--remove", given->removed, "Remove the comment with this number instead")
      ->type_name("NUMBER")
      ->check(CLI::PositiveNumber)
      ->excludes(attempt)
      ->excludes(text)
      ->excludes(author);
  command->callback([given, &run] { run = [given] { return comment(*given); }; });
}

}  // namespace insonate
