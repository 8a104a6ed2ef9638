#include "sim/core/toml_table.h"

#include <catch2/catch.hpp>

#include <string>

#include "sim/core/input_error.h"

using namespace insonate;

namespace {

/// "a.a.a": a key of so many parts.
std::string key_of(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

}  // namespace

TEST_CASE("a key of too many parts is refused before it overflows the stack, wherever it stands") {
  const std::string deep = key_of(500'000);
  for (const std::string& text :
       {"one = 1\n" + deep + " = 1\n", "\n[" + deep + "]\n", "\n[[" + deep + "]]\n",
        "\nb = { c = 1, " + deep + " = 1 }\n", "\nb = [1, 2, { " + deep + " = 1 }]\n",
        "\nb = { c = \"\"\"a\"\"\"\", " + deep + " = 1 }\n", "\nb = { c = '''a''''', " + deep + " = 1 }\n",
        "\nb = { c = \"\\\"\", " + deep + " = 1 }\n", "c = '\\' # '\n" + deep + " = 1\n",
        "c = 1 # \"\n" + deep + " = 1\n", "\n\"a,\" . 'b=' . " + deep + " = 1\n"})
    CHECK_THROWS_WITH(parse_toml("deep.toml", text),
                      Catch::Contains("line 2") && Catch::Contains("more than 16 parts"));
  CHECK_THROWS_AS(parse_toml("deep.toml", "c = '''\n'''\n" + deep + " = 1\n"), InputError);
}

TEST_CASE("what looks like a key of many parts and is none is taken") {
  const std::string deep = key_of(100);
  for (const std::string& text :
       {"a = \"" + deep + "\"\n", "a = '" + deep + "'\n", "a = \"\"\"\n\"" + deep + "\n\\\"\"\" " + deep + "\"\"\"\n",
        "a = '''\n" + deep + "''''\n", "# " + deep + "\na = 1\n", key_of(16) + " = 1\n",
        std::string(
            "a = [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5, 0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5]\n")})
    CHECK_NOTHROW(parse_toml("flat.toml", text));
  for (const std::string ending : {R"("""a""")", R"('''a''')", R"("a)", R"("a\)", R"("""a\)", R"(')", R"(#)"})
    CHECK(line_of_deep_key("a = " + ending) == 0);
}

TEST_CASE("what has to be a list and is none is refused with its place and its key") {
  const toml::table parsed = parse_toml("lab.toml", "[tip]\nplace_mm = 3\nnames = 'navel'\n");
  const TomlTable tip = TomlTable("lab.toml", "", parsed).table("tip");
  CHECK_THROWS_WITH(tip.numbers("place_mm", 3),
                    "lab.toml: line 2, column 12, [tip]: 'place_mm' is no list; write 3 numbers in square brackets.");
  CHECK_THROWS_WITH(tip.texts("names"),
                    "lab.toml: line 3, column 9, [tip]: 'names' is no list; write texts in square brackets.");
}
