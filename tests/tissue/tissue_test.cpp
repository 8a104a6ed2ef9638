#include "sim/tissue/tissue.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <string>

#include "sim/core/input_error.h"
#include "sim/files/files.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

const fs::path kShipped = fs::path(INSONATE_ASSETS_FOLDER) / "tissues.toml";

struct TemporaryFile {
  fs::path path = fs::temp_directory_path() / ("insonate-tissue-test-" + std::to_string(::getpid()) + ".toml");
  explicit TemporaryFile(const std::string& text) { write_file(path, text); }
  ~TemporaryFile() { fs::remove(path); }
};

std::string why_refused(const std::string& text) {
  const TemporaryFile file(text);
  try {
    read_tissue_table(file.path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string knot(const std::string& hu, const std::string& rest = "impedance = 1.5\nabsorption = 0\nechogenicity = 0") {
  return "[[knot]]\nhu = " + hu + "\n" + rest + "\n";
}

}  // namespace

TEST_CASE("the shipped table gives the impedances that the model's definition names") {
  const TissueTable table = read_tissue_table(kShipped);
  CHECK(table.at(-100).impedance_mrayl == Approx(1.38));
  CHECK(table.at(0).impedance_mrayl == Approx(1.48));
  CHECK(table.at(60).impedance_mrayl == Approx(1.65));
  CHECK(table.at(-1000).impedance_mrayl == Approx(0.0004));
  CHECK(table.at(1500).impedance_mrayl == Approx(7.8));
  CHECK(table.at(-3000).impedance_mrayl == Approx(0.0004));
  CHECK(table.at(60).echogenicity_db == Approx(0));
}

TEST_CASE("the shipped table's impedance rises with density and is nearly linear over soft tissue") {
  const TissueTable table = read_tissue_table(kShipped);
  for (std::size_t k = 1; k < table.knots.size(); ++k)
    CHECK(table.knots[k].impedance_mrayl >= table.knots[k - 1].impedance_mrayl);
  for (int hu = -100; hu <= 100; ++hu) {
    // Through fat and liver; water, 4.4 % under that line, is the furthest of the three that the model fixes.
    const double line = 1.38 + (hu + 100) * (1.65 - 1.38) / 160;
    CHECK(table.at(hu).impedance_mrayl == Approx(line).epsilon(0.05));
  }
}

TEST_CASE("in the shipped table gas and bone reflect and absorb, fluid does neither") {
  const TissueTable table = read_tissue_table(kShipped);
  const auto reflected = [&](double a, double b) {
    const double za = table.at(a).impedance_mrayl, zb = table.at(b).impedance_mrayl;
    return (za - zb) * (za - zb) / ((za + zb) * (za + zb));
  };
  CHECK(reflected(60, -800) > 0.99);  // pleura
  CHECK(reflected(50, 400) > 0.3);    // a rib as thick slices show it
  CHECK(reflected(-100, 60) < 0.01);  // fat against liver
  CHECK(reflected(60, 180) < 0.002);  // an enhanced vessel must not look like a plate
  CHECK(table.at(8).absorption_db_cm_mhz < 0.1);
  CHECK(table.at(400).absorption_db_cm_mhz >= 5);
  CHECK(table.at(-800).absorption_db_cm_mhz >= 5);
  CHECK(table.at(5).echogenicity_db <= -40);
}

TEST_CASE("the shipped table grades labelled tissues as sonographers do") {
  const auto labelled = read_tissue_table(kShipped).labelled;
  for (const char* name : {"skin",         "fat",    "muscle",      "bone",     "cartilage",     "lung",
                           "liver",        "blood",  "vessel_wall", "bile",     "kidney_cortex", "kidney_medulla",
                           "kidney_sinus", "spleen", "stomach",     "bowel",    "gas",           "urine",
                           "fluid",        "stone",  "cyst",        "pancreas", "diaphragm",     "soft_tissue"})
    CHECK(labelled.count(name) == 1);
  const auto db = [&](const char* name) { return labelled.at(name).echogenicity_db; };
  CHECK(db("kidney_sinus") > db("pancreas"));
  CHECK(db("pancreas") > db("spleen"));
  CHECK(db("spleen") >= db("liver"));
  CHECK(db("liver") > db("kidney_cortex"));
  CHECK(db("kidney_cortex") > db("kidney_medulla"));
  CHECK(db("kidney_medulla") > db("blood"));
  CHECK(db("blood") > db("bile"));
}

TEST_CASE("between knots a tissue table is linear and beyond them constant") {
  const TissueTable table{{{-10, 1, 2, -20}, {10, 3, 0, 20}}, {}};
  CHECK(table.at(-10).impedance_mrayl == 1);
  CHECK(table.at(0).impedance_mrayl == Approx(2));
  CHECK(table.at(5).absorption_db_cm_mhz == Approx(0.5));
  CHECK(table.at(5).echogenicity_db == Approx(10));
  CHECK(table.at(10).impedance_mrayl == 3);
  CHECK(table.at(1e9).impedance_mrayl == 3);
  CHECK(table.at(-1e9).impedance_mrayl == 1);
}

TEST_CASE("an entry for each unit of a 12-bit CT holds all that a tissue table says") {
  // The last knots that are allowed: beyond them nothing changes, so that a lookup that ends there loses nothing.
  const TemporaryFile file(knot("-1024", "impedance = 1\nabsorption = 2\nechogenicity = 3") +
                           knot("3071", "impedance = 4\nabsorption = 5\nechogenicity = 6"));
  const TissueTable table = read_tissue_table(file.path);
  for (const double beyond : {3071.0, 3072.0, 32767.0}) {
    CHECK(table.at(beyond).impedance_mrayl == 4);
    CHECK(table.at(beyond).absorption_db_cm_mhz == 5);
  }
  CHECK(table.at(-1024).impedance_mrayl == 1);
  CHECK(table.at(3070).impedance_mrayl < 4);
}

TEST_CASE("a tissue table that cannot be used is refused with the place and the reason") {
  const std::string two = knot("0") + knot("10");
  CHECK(why_refused(two).empty());
  const struct {
    std::string text, place, problem;
  } cases[] = {
      {"[[knot]\nhu = 1\n", "line 1, column 8", "not TOML"},
      {knot("0"), "", "there are 1 knots"},
      {"[[knot]]\nhuu = 1\n", "line 1", "rename 'huu' if it is meant"},
      {"[[knott]]\nhu = 1\n", "line 1", "did you mean 'knot'?"},
      {knot("0") + knot("0"), "line 7, column 6: knot 2", "order the knots"},
      {knot("10") + knot("0"), "line 7", "'hu' is 0 after a knot at 10"},
      {knot("1.5"), "line 2", "not a whole number"},
      {knot("99999"), "line 2", "'hu' is 99999"},
      {knot("0") + knot("3072"), "line 7, column 6: knot 2", "give a whole number from -1024 to 3071"},
      {knot("-1025"), "line 2", "'hu' is -1025"},
      {knot("\"zero\""), "line 2", "not a whole number"},
      {knot("0", "impedance = 0\nabsorption = 0\nechogenicity = 0"), "line 3", "'impedance' is 0"},
      {knot("0", "impedance = -1\nabsorption = 0\nechogenicity = 0"), "line 3", "'impedance' is -1"},
      {knot("0", "impedance = nan\nabsorption = 0\nechogenicity = 0"), "line 3", "'impedance' is nan"},
      {knot("0", "impedance = 1\nabsorption = inf\nechogenicity = 0"), "line 4", "'absorption' is inf"},
      {knot("0", "impedance = 1\nabsorption = 0\nechogenicity = -61"), "line 5", "'echogenicity' is -61"},
      {knot("0", "impedance = 1\nechogenicity = 0"), "line 1, column 1: knot 1", "'absorption' is missing"},
      {"knot = 3\n", "line 1", "not a list of tables"},
      {"knot = [3]\n", "line 1", "not a list of tables"},
      {two + "[tissue]\nliver = 0\n", "line 12", "'liver' is not a table"},
      {two + "[tissue.liver]\nechogenicity_db = 99\n", "line 12, column 19: [tissue.liver]", "99"},
      {two + "[tissue.liver]\nechogenicity = 9\n", "line 11", "rename 'echogenicity' if it is meant"},
      {two + "[tissue.liver]\nechogenicity_db = 0\n[tissue.liver]\n", "line 13", "not TOML"},
      {std::string("\xff\xfe\x00k", 4), "line 1", "not TOML"},
      {std::string(100000, '['), "line 1", "not TOML"},
  };
  for (const auto& bad : cases) {
    const std::string why = why_refused(bad.text);
    INFO(bad.text.substr(0, 200) << " -> " << why);
    CHECK(why.find(bad.place) != std::string::npos);
    CHECK(why.find(bad.problem) != std::string::npos);
  }
  CHECK_THROWS_AS(read_tissue_table("/none/tissues.toml"), InputError);
}

TEST_CASE("a labelled tissue names its structure, or has none") {
  const std::string knots = knot("0") + knot("100");
  const TissueTable table = read_tissue_table(kShipped);
  CHECK(table.labelled.at("liver").structure == Structure::organ);
  CHECK(table.labelled.at("kidney_sinus").structure == Structure::sinus);
  CHECK(table.labelled.at("blood").structure == Structure::none);
  const TemporaryFile file(knots + "[tissue.plain]\nechogenicity_db = 0\n");
  CHECK(read_tissue_table(file.path).labelled.at("plain").structure == Structure::none);
  CHECK(why_refused(knots + "[tissue.a]\nechogenicity_db = 0\nstructure = 'fats'\n").find("fat") != std::string::npos);
}
