#include "sim/files/toml_table.h"

#include <catch2/catch.hpp>

#include <functional>
#include <string>
#include <vector>

using namespace insonate;

namespace {

/// "a.a.a": a key of so many parts.
std::string key_of(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

/// Returns the mistakes that `read` finds, in the order of the file, as "LINE:COLUMN PROBLEM; REMEDY".
std::vector<std::string> mistakes_in(const std::string& text, const std::function<void(const TomlTable&)>& read) {
  const TomlDocument document("lab.toml", text, OnMistake::collect);
  read(document.root());
  std::vector<std::string> all;
  for (const Mistake& mistake : in_order_of_file(document.mistakes()))
    all.push_back(std::to_string(mistake.place.line) + ":" + std::to_string(mistake.place.column) + " " +
                  mistake.problem + "; " + mistake.remedy);
  return all;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("a key of too many parts is refused before it overflows the stack, wherever it stands") {
  const std::string deep = key_of(500'000);
  for (const std::string& text :
       {"one = 1\n" + deep + " = 1\n", "\n[" + deep + "]\n", "\n[[" + deep + "]]\n",
        "\nb = { c = 1, " + deep + " = 1 }\n", "\nb = [1, 2, { " + deep + " = 1 }]\n",
        "\nb = { c = \"\"\"a\"\"\"\", " + deep + " = 1 }\n", "\nb = { c = '''a''''', " + deep + " = 1 }\n",
        "\nb = { c = \"\\\"\", " + deep + " = 1 }\n", "c = '\\' # '\n" + deep + " = 1\n",
        "c = 1 # \"\n" + deep + " = 1\n", "\n\"a,\" . 'b=' . " + deep + " = 1\n"})
    CHECK_THROWS_WITH(TomlDocument("deep.toml", text),
                      Catch::Contains("line 2") && Catch::Contains("more than 16 parts"));
  CHECK_THROWS_AS(TomlDocument("deep.toml", "c = '''\n'''\n" + deep + " = 1\n"), InputError);
}

TEST_CASE("what looks like a key of many parts and is none is taken") {
  const std::string deep = key_of(100);
  for (const std::string& text :
       {"a = \"" + deep + "\"\n", "a = '" + deep + "'\n", "a = \"\"\"\n\"" + deep + "\n\\\"\"\" " + deep + "\"\"\"\n",
        "a = '''\n" + deep + "''''\n", "# " + deep + "\na = 1\n", key_of(16) + " = 1\n",
        std::string(
            "a = [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5, 0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5]\n")})
    CHECK_NOTHROW(TomlDocument("flat.toml", text));
  for (const std::string whole : {R"("""a""")", R"('''a''')"}) CHECK_NOTHROW(TomlDocument("flat.toml", "a = " + whole));
  for (const std::string ending : {R"("a)", R"("a\)", R"("""a\)", R"(')", R"(#)"})
    CHECK_THROWS_WITH(TomlDocument("cut.toml", "a = " + ending), Catch::Contains("not TOML"));
}

TEST_CASE("a document throws its first mistake with its place, its table and its key") {
  const TomlDocument document("lab.toml", "[tip]\nplace_mm = 3\nnames = 'navel'\n");
  const TomlTable tip = document.root().table("tip");
  CHECK_THROWS_WITH(tip.numbers("place_mm", 3),
                    "lab.toml: line 2, column 12: [tip]: 'place_mm' is not a list; write 3 finite numbers in square "
                    "brackets.");
  CHECK_THROWS_WITH(tip.texts("names"),
                    "lab.toml: line 3, column 9: [tip]: 'names' is not a list; write texts in square brackets, names = "
                    "[\"...\"].");
  CHECK_THROWS_WITH(TomlDocument("lab.toml", "a = \n"),
                    Catch::StartsWith("lab.toml: line 1, column 5: this is not TOML: "));
}

TEST_CASE("values come back as they were written") {
  const TomlDocument document("lab.toml", R"(
width = 3
depth_mm = 12.5
seed = 4294967295
on = true
title = "Liver"
empty = ""
organ = ["liver", "spleen"]
at = [1, -2.5, 3e2]
rows = [[1, 2], [3, 4, 5]]
gain = [-3, 3]
colour = "red"
)");
  const TomlTable root = document.root();
  CHECK(root.number("width") == 3);
  CHECK(root.number("depth_mm", {12.5, 12.5}) == 12.5);
  CHECK(root.whole_number("seed", 0, 4294967295) == 4294967295);
  CHECK(root.boolean("on"));
  CHECK(root.text("title") == "Liver");
  CHECK(root.text("empty", "none").empty());
  CHECK(root.texts("organ", 2, 2) == Lines{"liver", "spleen"});
  CHECK(root.numbers("at", 3) == std::vector<double>{1, -2.5, 300});
  CHECK(root.vector("at") == glm::dvec3(1, -2.5, 300));
  CHECK(root.rows("rows", 2, 2, 3, {}) == std::vector<std::vector<double>>{{1, 2}, {3, 4, 5}});
  CHECK(root.interval("gain", {-3, 3})->most == 3);
  CHECK(root.choice("colour", {"green", "red"}) == 1);
  CHECK(root.list_length("organ") == 2);
  CHECK(root.list_length("title") == 0);
  CHECK(root.kind("at") == TomlKind::list);
  CHECK(root.kind("none") == TomlKind::missing);
  CHECK(root.keys().front() == "width");
  CHECK(root.keys().back() == "colour");

  CHECK(root.number("none", {0, 9}, 7) == 7);
  CHECK(root.whole_number("none", 0, 9, 7) == 7);
  CHECK(root.boolean("none", true));
  CHECK(root.text("none", "x") == "x");
  CHECK(root.choice("none", {"a", "b"}, 1) == 1);
  CHECK(root.texts("none").empty());
  CHECK(root.vector("none", {}, glm::dvec3(4)) == glm::dvec3(4));
  CHECK_FALSE(root.interval("none", {0, 9}));
  CHECK(root.tables("none").empty());
}

TEST_CASE("a key that is missing, of another kind or out of range is a mistake in words") {
  using T = const TomlTable&;
  const struct {
    std::string text;
    std::function<void(T)> read;
    std::string mistake;
  } cases[] = {
      {"",
       [](T t) {
         t.number("a", {1, 9});
       },
       "1:1 the key 'a' is missing; add it: a number from 1 to 9"},
      {"dept = 3",
       [](T t) {
         t.number("depth", {1, 9});
       },
       "1:1 the key 'depth' is missing; add it: a number from 1 to 9, or rename 'dept' if it is meant"},
      {"a = '3'",
       [](T t) {
         t.number("a", {1, 9});
       },
       "1:5 'a' is not a number; give a number from 1 to 9"},
      {"a = 10",
       [](T t) {
         t.number("a", {1, 9}, 2);
       },
       "1:5 'a' is 10; give a number from 1 to 9"},
      {"a = nan", [](T t) { t.number("a"); }, "1:5 'a' is nan; give a finite number"},
      {"a = 0.5", [](T t) { t.whole_number("a", 0, 100000); },
       "1:5 'a' is not a whole number; give a whole number from 0 to 100000"},
      {"a = 2", [](T t) { t.whole_number("a", 1, 1); }, "1:5 'a' is 2; give the number 1"},
      {"a = -1", [](T t) { t.whole_number("a", 0, 9, 3); }, "1:5 'a' is -1; give a whole number from 0 to 9"},
      {"", [](T t) { t.boolean("a"); }, "1:1 the key 'a' is missing; add it: true or false"},
      {"a = 1", [](T t) { t.boolean("a", true); },
       "1:5 'a' is neither true nor false; write true or false without quotation marks"},
      {"", [](T t) { t.text("a"); }, "1:1 the key 'a' is missing; add it: a text between quotation marks"},
      {"a = 1", [](T t) { t.text("a"); }, "1:5 'a' is not a text; put it between quotation marks"},
      {"a = ' '", [](T t) { t.text("a"); }, "1:5 'a' is empty; write something between the quotation marks"},
      {"",
       [](T t) {
         t.choice("a", {"green", "red"});
       },
       "1:1 the key 'a' is missing; add it: one of 'green', 'red'"},
      {"a = 'blue'",
       [](T t) {
         t.choice("a", {"green", "red"});
       },
       "1:5 'a' is 'blue'; use one of 'green', 'red'"},
      {"a = 'rad'",
       [](T t) {
         t.choice("a", {"green", "red"}, 0);
       },
       "1:5 'a' is 'rad'; did you mean 'red'?"},
      {"a = 1",
       [](T t) {
         t.choice("a", {"green", "red"});
       },
       "1:5 'a' is not a text; put it between quotation marks"},
      {"a = []", [](T t) { t.texts("a", 1); }, "1:5 'a' is empty; write texts in square brackets, a = [\"...\"]"},
      {"a = ['x', 'y']", [](T t) { t.texts("a", 0, 1); }, "1:5 'a' has 2 texts; write at most 1"},
      {"a = ['x', 2]", [](T t) { t.texts("a"); },
       "1:11 'a' holds something that is not a text; put it between quotation marks"},
      {"a = ['']", [](T t) { t.texts("a"); },
       "1:6 'a' holds an empty text; write something between the quotation marks"},
      {"a = [1, 2]",
       [](T t) {
         t.numbers("a", 3, {0, 5});
       },
       "1:5 'a' has 2 numbers; write 3 numbers from 0 to 5 in square brackets"},
      {"a = [1, 9]",
       [](T t) {
         t.numbers("a", 2, {0, 5});
       },
       "1:9 'a' holds 9; write 2 numbers from 0 to 5 in square brackets"},
      {"a = [1, 2, 'x']",
       [](T t) {
         t.vector("a", {0, 5});
       },
       "1:12 'a' holds something that is not a number; write 3 numbers from 0 to 5 in square brackets"},
      {"a = [[1, 2]]",
       [](T t) {
         t.rows("a", 2, 2, 2, {0, 5});
       },
       "1:5 'a' has 1 rows; write at least 2 rows, each a list of 2 numbers"},
      {"a = [[1, 2], [1]]",
       [](T t) {
         t.rows("a", 2, 2, 3, {0, 5});
       },
       "1:14 'a' holds a row that is not a list of 2 to 3 numbers; write at least 2 rows, each a list of 2 to 3 "
       "numbers"},
      {"a = [[1, 6]]",
       [](T t) {
         t.rows("a", 1, 2, 3, {0, 5});
       },
       "1:10 'a' holds 6; give a number from 0 to 5"},
      {"a = [3, 1]",
       [](T t) {
         t.interval("a", {0, 5});
       },
       "1:5 'a' begins with its larger number; write [1, 3]"},
      {"a = [1, 6]",
       [](T t) {
         t.interval("a", {0, 5});
       },
       "1:5 'a' goes beyond its limits; write two numbers from 0 to 5"},
      {"", [](T t) { t.table("a").number("b"); }, "1:1 the key 'a' is missing; add it: [a]"},
      {"a = { b = 3 }", [](T t) { t.table("a").table("b").text("c"); },
       "1:11 [a]: 'b' is not a table; write [a.b] above its keys"},
      {"a = [1]", [](T t) { t.tables("a"); }, "1:5 'a' is not a list of tables; write [[a]] above the keys of each"},
      {"a = [{}, {}]", [](T t) { t.tables("a", 1); }, "1:5 there are 2 of 'a'; write at most 1"},
  };
  for (const auto& one : cases) {
    INFO(one.text << " -> " << one.mistake);
    CHECK(mistakes_in(one.text, one.read) == Lines{one.mistake});
  }
}

TEST_CASE("tables are named after their headings and their numbers") {
  const std::string text = "[[step]]\n[[step]]\n[[step.hint]]\n[step.tolerance]\n[a.b]\n";
  const TomlDocument document("lab.toml", text);
  const std::vector<TomlTable> steps = document.root().tables("step");
  REQUIRE(steps.size() == 2);
  CHECK(document.root().name().empty());
  CHECK(steps[1].name() == "step 2");
  CHECK(steps[1].tables("hint")[0].name() == "hint 1 of step 2");
  CHECK(steps[1].table("tolerance").name() == "[step.tolerance] of step 2");
  CHECK(document.root().table("a").table("b").name() == "[a.b]");
  steps[1].rename("step 'last'");
  CHECK(steps[1].tables("hint", 1, "help")[0].name() == "help 1 of step 'last'");
  CHECK_THROWS_WITH(steps[1].text("title"),
                    "lab.toml: line 2, column 1: step 'last': the key 'title' is missing; add "
                    "it: a text between quotation marks.");
}

TEST_CASE("reading goes on after a mistake, with a value within the range or the default") {
  const TomlDocument document("lab.toml", "a = 99\nb = 'x'\nc = [1]\n", OnMistake::collect);
  const TomlTable root = document.root();
  CHECK(root.number("a", {1, 9}) == 1);
  CHECK(root.number("a", {1, 9}, 5) == 5);
  CHECK(root.whole_number("a", 10, 20) == 10);
  CHECK(root.vector("b", {2, 3}) == glm::dvec3(2));
  CHECK(root.numbers("c", 2, {2, 3}).size() == 2);
  const TomlTable none = root.table("b");
  const std::size_t before = root.mistake_count();
  CHECK_FALSE(none.has("d"));
  CHECK(none.text("d").empty());
  none.report("", "it is empty", "fill it");
  CHECK(root.mistake_count() == before);
  CHECK_THROWS_WITH(root.fail("a", "that is the end", "stop"),
                    Catch::StartsWith("lab.toml: ") && Catch::Contains("line 1, column 5: that is the end; stop"));
  CHECK_THROWS_AS(document.throw_mistakes(), InputError);
  CHECK_NOTHROW(TomlDocument("lab.toml", "a = 1\n", OnMistake::collect).throw_mistakes());
  const TomlDocument unreadable("lab.toml", "a = ", OnMistake::collect);
  CHECK(unreadable.mistakes().size() == 1);
  unreadable.root().number("a", {0, 1});  // which the text may hold for all one can know
  CHECK(unreadable.mistakes().size() == 1);
}

TEST_CASE("keys that nobody asked for are refused, with a suggestion, in every table that was read") {
  const std::string text = "names = 1\nother = { x = 1 }\n[tip]\nplaice = 2\n[[step]]\nview = 1\nvieew = 2\n";
  const Lines mistakes = mistakes_in(text, [](const TomlTable& root) {
    root.number("name", {}, 0);
    root.has("other");
    root.table("tip").number("place", {}, 0);
    for (const TomlTable& step : root.tables("step")) step.number("view");
    root.refuse_unknown_keys();
  });
  CHECK(mistakes == Lines{"1:1 the key 'names' is unknown here; did you mean 'name'?",
                          "4:1 [tip]: the key 'plaice' is unknown here; did you mean 'place'?",
                          "7:1 step 1: the key 'vieew' is unknown here; did you mean 'view'?"});

  const TomlDocument document("lab.toml", text);
  document.root().table("tip");
  CHECK_THROWS_WITH(document.root().refuse_unknown_keys(), Catch::Contains("'names' is unknown here; use 'tip'"));
  document.root().allow_unknown_keys();
  CHECK_THROWS_WITH(document.root().refuse_unknown_keys(), Catch::Contains("[tip]: the key 'plaice'"));
  CHECK(document.root().table("tip").keys() == Lines{"plaice"});
  CHECK_NOTHROW(document.root().refuse_unknown_keys());
}

TEST_CASE("texts are evaluated where numbers are expected, if the document knows how") {
  TomlDocument document("lab.toml", "a = 'two'\nb = [1, 'two', 2]\nc = 'three'\ng = [['two', 1]]\n");
  CHECK_THROWS_WITH(document.root().number("a"), Catch::Contains("'a' is not a number"));
  document.evaluate_texts([](const std::string& text) {
    return text == "two" ? TomlDocument::Evaluation{2.0, "", ""}
                         : TomlDocument::Evaluation{std::nullopt, "there is no " + text, "count to two"};
  });
  const TomlTable root = document.root();
  CHECK(root.number("a", {0, 2}) == 2);
  CHECK(root.vector("b") == glm::dvec3(1, 2, 2));
  CHECK(root.rows("g", 1, 2, 2, {})[0][0] == 2);
  CHECK(root.text("a") == "two");
  CHECK_THROWS_WITH(root.number("a", {0, 1}), Catch::Contains("line 1, column 5: 'a' is 2; give a number from 0 to 1"));
  CHECK_THROWS_WITH(root.number("c"), "lab.toml: line 3, column 5: there is no three; count to two.");
}

TEST_CASE("every text under a key can be replaced") {
  TomlDocument document("lab.toml", "a = 'x'\n[b]\nc = 'x'\ng = ['x', { e = 'x' }]\n");
  int replaced = 0;
  document.replace_texts("b", [&](const std::string& text, const SourcePlace& place) {
    CHECK((place.line == 3 || place.line == 4));
    ++replaced;
    return text + "!";
  });
  CHECK(replaced == 3);
  CHECK(document.root().text("a") == "x");
  CHECK(document.root().table("b").text("c") == "x!");
}
