#include "tools/cli/program_pages.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/run_program.h"
#include "tests/core/temporary_folder.h"
#include "tools/cli/program.h"

using namespace insonate;

namespace {

/// A program with one of everything.
struct Sample {
  CLI::App app{"Looks at things. It is - as `they' say - made up.\nOf:\n  first\n      .what it is", "insonate-sample"};
  std::string folder, file, word = "fast", mode, thing;
  double amount = 2;
  bool loud = false;

  Sample() {
    app.add_option("-o,--out", folder, "Where to")->type_name("FOLDER");
    app.add_option("--quality", word, "How well")->check(CLI::IsMember({"fast", "exact"}))->capture_default_str();
    app.add_option("--amount", amount, "How much")->check(CLI::Range(1.0, 400.0))->capture_default_str();
    app.add_option("--mode", mode, "Which way")->type_name(one_of({"up", "down"}))->default_str("the last one");
    app.add_option("--tracker", file, "Whence:\n  hydra:\n      by hand")->type_name("URI");
    app.add_option("--port", file, "Where at")->type_name("[ADDRESS:]PORT");
    app.add_flag("--secret", loud, "Not for help")->group("");
    app.footer("Examples:\n  insonate-sample look it\n\nMore of it.\nExit codes: 0 done.");
    CLI::App* look = app.add_subcommand("look", "Look at one");
    look->add_option("--log", file, "The log")->type_name("FILE")->required();
    look->footer("Examples:\n  insonate-sample look --log a b");
    look->add_option("THING", thing, "What")->type_name("FILE")->required();
    CLI::App* closer = app.add_subcommand("closer", "Look closer");
    CLI::Option* loudly = closer->add_flag("--loud", loud, "Loudly");
    closer->add_option("--at", amount, "At which of the many times that a person who looks closer can choose from")
        ->check(CLI::Range(0.0, 9.0))
        ->needs(loudly);
    closer->add_option("STEP", word, "How far")->check(CLI::IsMember({"near", "nearer"}))->excludes(loudly);
    CLI::App* put = app.add_subcommand("put", "Put it");
    put->add_subcommand("away", "Put it away")->add_option("FOLDER", folder, "Where to")->type_name("FOLDER");
    put->require_subcommand(1);
    add_self_descriptions(app, {});
  }
};

/// Returns what bash offers for a line that ends at the cursor: the calls of compopt, then the words of COMPREPLY.
/// @param words  the line's words as bash splits it, which makes words of = and :
/// @param line   the line
std::string completed(const std::string& words, const std::string& line) {
  Sample sample;
  const TemporaryFolder folder;
  const std::filesystem::path script = folder.path / "script", offered = folder.path / "offered";
  std::ofstream(script) << bash_completion(sample.app) << "\ncompopt() { echo \"compopt $*\"; }\nCOMP_WORDS=(" << words
                        << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\nCOMP_LINE=\"" << line
                        << "\"\nCOMP_POINT=${#COMP_LINE}\n_insonate_sample\necho \"${COMPREPLY[*]}\"\n";
  REQUIRE(std::system(("bash '" + script.string() + "' >'" + offered.string() + "' 2>&1").c_str()) == 0);
  std::ostringstream text;
  text << std::ifstream(offered).rdbuf();
  return text.str();
}

/// The same for a line without = and :.
std::string completed(const std::string& line) {
  return completed(line + (line.ends_with(' ') ? "''" : ""), line);
}

constexpr const char* kFiles = "compopt -o default\n\n";
constexpr const char* kFolders = "compopt -o dirnames\n\n";
constexpr const char* kNothing = "\n";

}  // namespace

TEST_CASE("a man page has every option and command, with what they take") {
  Sample sample;
  const std::string page = man_page(sample.app);
  CHECK(contains(page, ".SH NAME\ninsonate\\-sample \\- looks at things\n"));
  CHECK(contains(page,
                 "\\fBinsonate\\-sample look\\fR [\\fIOPTION\\fR]... \\fB\\-\\-log\\fR \\fIFILE\\fR \\fITHING\\fR\n"));
  CHECK(contains(page, "\\fB\\-o\\fR, \\fB\\-\\-out\\fR \\fIFOLDER\\fR\nWhere to\n"));
  CHECK(contains(page, "\\fB\\-\\-quality\\fR \\fBfast\\fR|\\fBexact\\fR\nHow well\n(default: fast)\n"));
  CHECK(contains(page, "\\fB\\-\\-port\\fR \\fI[ADDRESS:]PORT\\fR\n"));
  CHECK(contains(page, "How much\n(1 to 400; default: 2)\n"));
  CHECK(contains(page, "\\fB\\-\\-mode\\fR \\fBup\\fR|\\fBdown\\fR\nWhich way\n(default: the last one)\n"));
  CHECK(contains(page, ".SS put away\nPut it away\n.TP\n\\fIFOLDER\\fR\nWhere to\n"));
  CHECK(contains(page, "\\fISTEP\\fR\nHow far\n(near, nearer; not with \\-\\-loud)\n"));
  CHECK(contains(page, "\\fB\\-\\-version\\fR\n"));
  CHECK(contains(page, ".SH EXAMPLES\n.EX\ninsonate\\-sample look it\n.EE\n.PP\nMore of it.\n.SH EXIT STATUS\n"));
  CHECK(contains(page, "\\fBinsonate\\-score\\fR(1)"));
  CHECK(contains(page, ".PP\nExamples:\n.EX\ninsonate\\-sample look \\-\\-log a b\n.EE\n.SS closer\n"));
  CHECK(page.find("sample look \\-\\-log a") == page.rfind("sample look \\-\\-log a"));
  CHECK_FALSE(contains(page, "secret"));
  CHECK_FALSE(contains(page, "man\\-page"));
}

TEST_CASE("a man page prints text that roff would take for its own") {
  Sample sample;
  const std::string page = man_page(sample.app);
  CHECK(contains(
      page, "It is \\- as \\(gathey\\(aq say \\- made up.\nOf:\n.RS\n.TP 4\n\\fBfirst\\fR\n\\&.what it is\n.RE\n"));
}

TEST_CASE("help names the values and has their conditions behind the descriptions") {
  Sample sample;
  const std::string help = sample.app.help(), closer = sample.app.get_subcommand("closer")->help();
  CHECK(contains(help, "  -o,--out FOLDER             Where to\n"));
  CHECK(contains(help, "  --quality fast|exact        How well (default: fast)\n"));
  CHECK(contains(help, "  --amount NUMBER             How much (1 to 400; default: 2)\n"));
  CHECK(contains(help, "  --mode up|down              Which way (default: the last one)\n"));
  CHECK(contains(sample.app.get_subcommand("look")->help(), "  THING                       What\n"));
  CHECK(contains(closer, "  STEP                        How far (near, nearer; not with --loud)\n"));
  CHECK(contains(closer,
                 "  --at NUMBER                 At which of the many times that a person who looks closer can choose\n"
                 "                              from (0 to 9; needs --loud)\n"));
}

TEST_CASE("bash completes options, commands, words, folders and files") {
  CHECK(completed("insonate-sample --") == "--help --out --quality --amount --mode --tracker --port --version\n");
  CHECK(completed("insonate-sample ") == "look closer put\n");
  CHECK(completed("insonate-sample --quality e") == "exact\n");
  CHECK(completed("insonate-sample --quality = e", "insonate-sample --quality=e") == "exact\n");
  CHECK(completed("insonate-sample --quality =", "insonate-sample --quality=") == "fast exact\n");
  CHECK(completed("insonate-sample --mode ") == "up down\n");
  CHECK(completed("insonate-sample -o ") == kFolders);
  CHECK(completed("insonate-sample --amount ") == kNothing);
  CHECK(completed("insonate-sample look --log ") == kFiles);
  CHECK(completed("insonate-sample look --log a ") == kFiles);
  CHECK(completed("insonate-sample --quality fast look --l") == "--log\n");
  CHECK(completed("insonate-sample closer --") == "--help --loud --at\n");
  CHECK(completed("insonate-sample closer n") == "near nearer\n");
  CHECK(completed("insonate-sample put ") == "away\n");
  CHECK(completed("insonate-sample put away ") == kFolders);
}

TEST_CASE("bash takes an option's value for no command") {
  CHECK(completed("insonate-sample --out l") == kFolders);
  CHECK(completed("insonate-sample --out look ") == "look closer put\n");
  CHECK(completed("insonate-sample --out look --qu") == "--quality\n");
  CHECK(completed("insonate-sample --out = look ''", "insonate-sample --out=look ") == "look closer put\n");
  CHECK(completed("insonate-sample --out 'look closer' ") == "look closer put\n");
  CHECK(completed("insonate-sample --tracker replay : l", "insonate-sample --tracker replay:l") == kFiles);
  CHECK(completed("insonate-sample --tracker replay :", "insonate-sample --tracker replay:") == kFiles);
  CHECK(completed("insonate-sample --tracker hydra : ''", "insonate-sample --tracker hydra: ") == "look closer put\n");
  CHECK(completed("insonate-sample --tracker hydra : lo", "insonate-sample --tracker hydra: lo") == "look\n");
  CHECK(completed("insonate-sample --tracker hydra : --quality f", "insonate-sample --tracker hydra: --quality f") ==
        "fast\n");
  CHECK(completed("insonate-sample --tracker replay : look ''", "insonate-sample --tracker replay:look ") ==
        "look closer put\n");
}

TEST_CASE("an option that the program does not have is named, whatever else is wrong") {
  const auto unknown = [](std::vector<const char*> words) {
    Sample sample;
    words.insert(words.begin(), "insonate-sample");
    CHECK_THROWS_AS(sample.app.parse(int(words.size()), words.data()), CLI::ParseError);
    return unknown_option(sample.app, int(words.size()), const_cast<char**>(words.data()));
  };
  CHECK(unknown({"--qualty", "fast"}) == "it has no option '--qualty'; did you mean '--quality'?");
  CHECK(unknown({"--qualty=fast"}) == "it has no option '--qualty'; did you mean '--quality'?");
  CHECK(unknown({"look", "--lg", "a", "b"}) == "it has no option '--lg'; did you mean '--log'?");
  CHECK(unknown({"closer", "--lgo"}) == "it has no option '--lgo'");
  CHECK(unknown({"--amount", "500"}).empty());
  CHECK(unknown({"lok", "--log", "a", "b"}).empty());  // the command is misspelt, and the option is one of it
  CHECK(unknown({"--out", "--strange", "--amount", "500"}).empty());  // --strange is a folder's name
  CHECK(unknown({"look", "a", "--", "--lgo"}).empty());
}
