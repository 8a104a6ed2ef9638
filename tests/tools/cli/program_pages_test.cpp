#include "tools/cli/program_pages.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/volume/temporary_folder.h"
#include "tools/cli/program.h"

using namespace insonate;

namespace {

/// A program with one of everything.
struct Sample {
  CLI::App app{"Looks at things. It is - as `they' say - made up.\nOf:\n  first\n      .what it is", "insonate-sample"};
  std::string folder, file, word = "fast", thing;
  double amount = 2;
  bool loud = false;

  Sample() {
    app.add_option("-o,--out", folder, "Where to")->type_name("FOLDER");
    app.add_option("--quality", word, "How well")->check(CLI::IsMember({"fast", "exact"}))->capture_default_str();
    app.add_option("--amount", amount, "How much")->check(CLI::Range(1.0, 400.0))->capture_default_str();
    app.add_option("--port", file, "Where at")->type_name("[ADDRESS:]PORT");
    app.add_flag("--secret", loud, "Not for help")->group("");
    app.footer("Examples:\n  insonate-sample look it\n\nMore of it.\nExit codes: 0 done.");
    CLI::App* look = app.add_subcommand("look", "Look at one");
    look->add_option("--log", file, "The log")->type_name("FILE")->required();
    look->footer("Examples:\n  insonate-sample look --log a b");
    look->add_option("thing", thing, "What")->required();
    look->add_subcommand("closer", "Look closer")->add_flag("--loud", loud, "Loudly");
    add_self_descriptions(app, {});
  }
};

bool contains(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

/// What bash offers, a word a line, for a command line that ends in the word under the cursor.
std::string completed(const std::string& words) {
  Sample sample;
  const TemporaryFolder folder;
  const std::filesystem::path script = folder.path / "script", offered = folder.path / "offered";
  std::ofstream(script) << bash_completion(sample.app) << "\ncompopt() { echo \"compopt $*\"; }\nCOMP_WORDS=(" << words
                        << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_insonate_sample\necho \"${COMPREPLY[*]}\"\n";
  REQUIRE(std::system(("bash '" + script.string() + "' >'" + offered.string() + "' 2>&1").c_str()) == 0);
  std::ostringstream text;
  text << std::ifstream(offered).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("a man page has every option and command, with what they take") {
  Sample sample;
  const std::string page = man_page(sample.app);
  CHECK(contains(page, ".SH NAME\ninsonate\\-sample \\- looks at things\n"));
  CHECK(contains(page,
                 "\\fBinsonate\\-sample look\\fR [\\fIOPTION\\fR]... \\fB\\-\\-log\\fR \\fIFILE\\fR \\fIthing\\fR\n"));
  CHECK(contains(page, "\\fB\\-o\\fR, \\fB\\-\\-out\\fR \\fIFOLDER\\fR\nWhere to\n"));
  CHECK(contains(page, "\\fB\\-\\-quality\\fR \\fBfast\\fR|\\fBexact\\fR\nHow well\n(default: fast)\n"));
  CHECK(contains(page, "\\fB\\-\\-port\\fR \\fI[ADDRESS:]PORT\\fR\n"));
  CHECK(contains(page, "How much\n(1 to 400; default: 2)\n"));
  CHECK(contains(page, ".SS look closer\nLook closer\n.TP\n\\fB\\-\\-loud\\fR\nLoudly\n"));
  CHECK(contains(page, "\\fB\\-\\-version\\fR\n"));
  CHECK(contains(page, ".SH EXAMPLES\n.EX\ninsonate\\-sample look it\n.EE\n.PP\nMore of it.\n.SH EXIT STATUS\n"));
  CHECK(contains(page, "\\fBinsonate\\-score\\fR(1)"));
  CHECK(contains(page, ".PP\nExamples:\n.EX\ninsonate\\-sample look \\-\\-log a b\n.EE\n.SS look closer\n"));
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

TEST_CASE("bash completes options, commands, words and folders, and leaves files to itself") {
  CHECK(completed("insonate-sample --") == "--help --out --quality --amount --port --version\n");
  CHECK(completed("insonate-sample ''") == "look\n");
  CHECK(completed("insonate-sample --quality e") == "exact\n");
  CHECK(completed("insonate-sample --quality = e") == "exact\n");
  CHECK(completed("insonate-sample --quality =") == "fast exact\n");
  CHECK(completed("insonate-sample -o ''") == "compopt +o default -o dirnames\n\n");
  CHECK(completed("insonate-sample --amount ''") == "compopt +o default\n\n");
  CHECK(completed("insonate-sample look --log ''") == "\n");
  CHECK(completed("insonate-sample --quality fast look --l") == "--log\n");
  CHECK(completed("insonate-sample look closer --") == "--help --loud\n");
}
