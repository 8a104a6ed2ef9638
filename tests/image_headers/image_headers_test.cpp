#include <catch2/catch.hpp>

#include <string>
#include <tuple>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/image_headers/metaimage_header.h"
#include "sim/image_headers/nrrd_header.h"

using namespace insonate;

namespace {

struct Line {
  std::string name, value;
  std::size_t number;
  bool operator==(const Line&) const = default;
};

struct Header {
  std::vector<Line> fields, keys;
  std::size_t end = 0;
};

Header nrrd(const std::string& bytes) {
  Header header;
  const auto into = [](std::vector<Line>& lines) {
    return [&](std::string_view name, std::string_view value, std::size_t number) {
      lines.push_back({std::string(name), std::string(value), number});
    };
  };
  header.end = read_nrrd_header(bytes, "a.nrrd", "give another file", into(header.fields), into(header.keys));
  return header;
}

Header metaimage(const std::string& bytes) {
  Header header;
  header.end = read_metaimage_header(bytes, "a.mha", "give another file",
                                     [&](std::string_view name, std::string_view value, std::size_t number) {
                                       header.fields.push_back({std::string(name), std::string(value), number});
                                     });
  return header;
}

}  // namespace

TEST_CASE("an NRRD header is its fields and keys, with the lines that they stand in") {
  const std::string bytes = "NRRD0005\n# a comment\ntype: short\nsizes:4 3 2 \ntype:=a key: of one's own\r\n\r\ndata";
  const Header header = nrrd(bytes);
  CHECK(header.fields == std::vector<Line>{{"type", "short", 3}, {"sizes", "4 3 2", 4}});
  CHECK(header.keys == std::vector<Line>{{"type", "a key: of one's own", 5}});
  CHECK(bytes.substr(header.end) == "data");
  CHECK(nrrd("NRRD00.01\n\n").end == 11);
  CHECK(nrrd("NRRD0004\ndata file: a.raw").fields == std::vector<Line>{{"data file", "a.raw", 2}});
  CHECK(is_nrrd_data_file("DataFile"));
  CHECK_FALSE(is_nrrd_data_file("data"));
}

TEST_CASE("bytes that are not an NRRD header are refused with the line") {
  const std::string other = "a.nrrd: line 1: this is not an NRRD file of version 1 to 5: it begins with ";
  CHECK_THROWS_WITH(nrrd(""), other + "''; give another file.");
  CHECK_THROWS_WITH(nrrd("NRRD0006\n\n"), other + "'NRRD0006'; give another file.");
  CHECK_THROWS_WITH(nrrd("NRRD0004\ntype short\n\n"),
                    "a.nrrd: line 2: 'type short' is not of the form 'name: value' or 'key:=value'; correct it, or "
                    "export the file again.");
  for (const char* bad : {"NRRD0004\n: short\n\n", "NRRD0004\n\x01type: short\n\n"})
    CHECK_THROWS_WITH(nrrd(bad), Catch::Contains("line 2: ") && Catch::Contains("is not of the form"));
  for (const char* cut : {"NRRD0004", "NRRD0004\ntype: short", "NRRD0004\ntype: short\n", "NRRD0004\ndata file:=a\n"})
    CHECK_THROWS_WITH(nrrd(cut), Catch::Contains("header: the header does not end: the empty line"));
}

TEST_CASE("a MetaImage header is its fields up to ElementDataFile") {
  const std::string bytes = "\nComment = a = b\r\nNDims=3\n\n Name =\nElementDataFile = LOCAL\ndata = 1";
  const Header header = metaimage(bytes);
  CHECK(
      header.fields ==
      std::vector<Line>{{"Comment", "a = b", 2}, {"NDims", "3", 3}, {"Name", "", 5}, {"ElementDataFile", "LOCAL", 6}});
  CHECK(bytes.substr(header.end) == "data = 1");
  CHECK(metaimage("ElementDataFile = a.raw").end == 23);
}

TEST_CASE("bytes that are not a MetaImage header are refused with the line") {
  CHECK_THROWS_WITH(metaimage("\nDear radiologist,\n"),
                    "a.mha: line 2: this is not a MetaImage file: it begins with 'Dear radiologist,'; give another "
                    "file.");
  CHECK_THROWS_WITH(metaimage("NDims = 3\nDimSize 4 3 2\n"),
                    Catch::Contains("a.mha: line 2: 'DimSize 4 3 2' is not of the form 'name = value'"));
  for (const char* bad : {"NDims = 3\n= 4\n", "NDims = 3\nDim\x7fSize = 4\n"})
    CHECK_THROWS_WITH(metaimage(bad), Catch::Contains("line 2: ") && Catch::Contains("is not of the form"));
  for (const char* cut : {"", "NDims = 3", "NDims = 3\nElementDataFil = LOCAL\n"})
    CHECK_THROWS_WITH(metaimage(cut), Catch::Contains("header: the header does not end: the line 'ElementDataFile"));
}

TEST_CASE("types, and flags of a MetaImage, are known by their names") {
  CHECK(nrrd_type("Signed Long Long Int") == ElementType::int64);
  CHECK(nrrd_type("float") == ElementType::float32);
  CHECK_FALSE(nrrd_type("block"));
  CHECK(metaimage_type("MET_LONG") == ElementType::int32);
  CHECK(metaimage_type("MET_ULONG_LONG") == ElementType::uint64);
  for (const char* other : {"met_short", "MET_OTHER", ""}) CHECK_FALSE(metaimage_type(other));
  CHECK(metaimage_flag("a.mha", "BinaryData", "true"));
  CHECK_FALSE(metaimage_flag("a.mha", "BinaryData", "FALSE"));
  CHECK_THROWS_WITH(metaimage_flag("a.mha", "BinaryData", "1"),
                    Catch::Contains("a.mha: header: BinaryData is '1' instead of True or False"));
}
