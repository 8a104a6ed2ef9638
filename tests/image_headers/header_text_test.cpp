#include "sim/image_headers/header_text.h"

#include <catch2/catch.hpp>

#include "sim/image_headers/element_type.h"

using namespace insonate;

TEST_CASE("numbers are read whole, in any locale, and words between blanks and tabs") {
  CHECK(to_number<double>("-1.5e3") == -1500);
  CHECK(to_number<double>("+8") == 8);
  for (const char* bad : {"", "+", "+-8", "1,5", "1.5 ", "0x10", "1e999", "five"}) CHECK_FALSE(to_number<double>(bad));
  CHECK(to_number<std::uint64_t>("18446744073709551615") == ~std::uint64_t(0));
  for (const char* bad : {"-1", "+1", "1.0", "18446744073709551616"}) CHECK_FALSE(to_number<std::uint64_t>(bad));
  CHECK(words(" 1\t22  333 ") == std::vector<std::string_view>{"1", "22", "333"});
  CHECK(words("").empty());
}

TEST_CASE("a quoted text is short and safe for a terminal") {
  CHECK(quoted("liver") == "'liver'");
  CHECK(quoted("a\x1b[2J\xff") == "'a?[2J?'");
  const std::string most(60, 'x'), more = most + "x";
  CHECK(quoted(std::string_view(more)) == "'" + most + "...'");
}

TEST_CASE("a number of each type is read from bytes in either order") {
  const unsigned char bytes[] = {0x80, 0, 0, 0, 0, 0, 0, 0x01};
  CHECK(number_at<std::int8_t>(bytes, false) == -128);
  CHECK(number_at<std::int16_t>(bytes, true) == -32768);
  CHECK(number_at<std::uint16_t>(bytes, false) == 128);
  CHECK(number_at<std::int64_t>(bytes, true) == INT64_MIN + 1);
  CHECK(number_at<std::uint64_t>(bytes, false) == (std::uint64_t(1) << 56) + 128);
  const unsigned char one[] = {0x3f, 0x80, 0, 0};
  CHECK(number_at<float>(one, true) == 1);
  const std::pair<ElementType, std::size_t> sizes[] = {
      {ElementType::int8, 1},    {ElementType::uint8, 1},  {ElementType::int16, 2}, {ElementType::uint16, 2},
      {ElementType::int32, 4},   {ElementType::uint32, 4}, {ElementType::int64, 8}, {ElementType::uint64, 8},
      {ElementType::float32, 4}, {ElementType::float64, 8}};
  for (const auto& [type, size] : sizes) {
    CHECK(bytes_of(type) == size);
    CHECK(to_string(type).ends_with(std::to_string(8 * size)));
  }
}
