#include "sim/files/toml_value.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "sim/files/toml_table.h"

using namespace insonate;

TEST_CASE("values that are written into a file are read back as they were") {
  const std::vector<std::string> texts{
      "liver", "a \"b\" \\ 'c'", "\n\t\r\x01\x7f", "k\xc3\xbcnstlich", "${x} # = [", "'''\"\"\"", " "};
  const std::vector<double> numbers{0.1, -0.0, 1, 1e22, 1e300, 5e-324, 1.0 / 3, -123456789.125};
  for (const std::string& text : texts) {
    CHECK(TomlDocument("t", "v = " + toml_value(text)).root().text("v", "") == text);
    CHECK(toml_value(text).find('\n') == std::string::npos);
  }
  for (const double number : numbers) {
    const double again = TomlDocument("t", "v = " + toml_value(number)).root().number("v");
    CHECK(again == number);
    CHECK(std::signbit(again) == std::signbit(number));
  }
  CHECK(toml_value(numbers).find('\n') == std::string::npos);
  CHECK(TomlDocument("t", "v = " + toml_value(numbers)).root().numbers("v", numbers.size()) == numbers);
  CHECK(TomlDocument("t", "v = " + toml_value(texts)).root().texts("v") == texts);
  CHECK(toml_value(std::vector<std::string>{}) == "[]");
  CHECK(toml_value("") == "\"\"");
  CHECK(toml_value(2.0) == "2.0");
}
