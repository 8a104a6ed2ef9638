#include <catch2/catch.hpp>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <functional>
#include <string>

#include "devices/sequence/probe_samples.h"
#include "devices/sequence/recorded_images.h"
#include "sim/core/hash.h"
#include "sim/core/input_error.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;
using Catch::Contains;

namespace {

std::string frames_text(int frames, const std::string& separator, const std::string& more = "") {
  std::string text;
  for (int f = 0; f < frames; ++f) {
    const std::string frame = "Seq_Frame" + std::to_string(10000 + f).substr(1) + "_";
    text += frame + "ProbeToPatientTransform" + separator + "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";
    text += frame + "ProbeToPatientTransformStatus" + separator + "OK\n";
    text += frame + "Timestamp" + separator + std::to_string(f) + "\n";
    if (!more.empty()) text += frame + more + "\n";
  }
  return text;
}

std::string metaimage(const std::string& header, int frames, const std::string& data, const std::string& more = "") {
  return "ObjectType = Image\nNDims = 3\n" + header + frames_text(frames, " = ", more) + "ElementDataFile = LOCAL\n" +
         data;
}

/// As zlib, or as gzip.
std::string packed(const std::string& data, bool gzip) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 6, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string out(deflateBound(&stream, uLong(data.size())) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
  stream.avail_in = uInt(data.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  out.resize(out.size() - stream.avail_out);
  deflateEnd(&stream);
  return out;
}

std::string noise(std::size_t bytes) {
  std::string data(bytes, '\0');
  for (std::size_t i = 0; i < bytes; ++i) data[i] = char(hash(std::uint32_t(i / 4096), std::uint32_t(i)) & 0xff);
  return data;
}

template <typename Number>
std::string bytes_of_numbers(std::initializer_list<Number> numbers, bool big_endian) {
  std::string bytes;
  for (const Number number : numbers) {
    char one[sizeof(Number)];
    std::memcpy(one, &number, sizeof one);
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(std::begin(one), std::end(one));
    bytes.append(one, sizeof one);
  }
  return bytes;
}

/// The values of an image of a file with these bytes, row by row.
std::vector<int> grey_of(const std::string& bytes, const std::string& name = "scan.igs.mha", std::uint64_t number = 0) {
  TemporaryFolder folder;
  const RecordedScan scan = read_recorded_scan(folder.put(name, bytes));
  REQUIRE(scan.images);
  ImageReader reader(*scan.images);
  const Image<std::uint8_t>& grey = reader.grey(number);
  return {grey.pixels.begin(), grey.pixels.end()};
}

const std::string kBytes2x3 = "DimSize = 2 3 2\nElementType = MET_UCHAR\n";
const std::string kTwelve = "ABCDEFGHIJKL";

}  // namespace

TEST_CASE("images are read raw and compressed, of MetaImage and of NRRD") {
  const std::vector<int> second{'G', 'H', 'I', 'J', 'K', 'L'};
  CHECK(grey_of(metaimage(kBytes2x3, 2, kTwelve), "a.igs.mha", 1) == second);
  CHECK(grey_of(metaimage(kBytes2x3 + "CompressedData = True\n", 2, packed(kTwelve, false)), "a.igs.mha", 1) == second);
  const std::string nrrd = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 2\nkinds: domain domain list\n";
  CHECK(grey_of(nrrd + "encoding: raw\n" + frames_text(2, ":=") + "\n" + kTwelve, "a.seq.nrrd", 1) == second);
  CHECK(grey_of(nrrd + "encoding: gzip\n" + frames_text(2, ":=") + "\n" + packed(kTwelve, true), "a.seq.nrrd", 1) ==
        second);
  // A single frame of PLUS, whose dimensions do not count it.
  const std::string single = "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 4 3\nkinds: domain domain\n";
  CHECK(grey_of(single + "encoding: raw\n" + frames_text(1, ":=") + "\n" + kTwelve, "a.seq.nrrd").size() == 12);
  CHECK(grey_of(single + "encoding: gzip\n" + frames_text(1, ":=") + "\n" + packed(kTwelve, true), "a.seq.nrrd")[11] ==
        'L');
}

TEST_CASE("values of other types are scaled to the image's largest, and colours become grey") {
  const auto with_type = [](const std::string& type, const std::string& data, const std::string& more = "") {
    return grey_of(
        metaimage("DimSize = 2 2 1\nKinds = domain domain list\nElementType = " + type + "\n" + more, 1, data));
  };
  const std::vector<int> expected{0, 51, 102, 255};
  for (const bool big : {false, true}) {
    const std::string order = std::string("BinaryDataByteOrderMSB = ") + (big ? "True\n" : "False\n");
    CAPTURE(big);
    CHECK(with_type("MET_SHORT", bytes_of_numbers<std::int16_t>({-7, 200, 400, 1000}, big), order) == expected);
    CHECK(with_type("MET_USHORT", bytes_of_numbers<std::uint16_t>({0, 12000, 24000, 60000}, big), order) == expected);
    CHECK(with_type("MET_INT", bytes_of_numbers<std::int32_t>({-7, 200, 400, 1000}, big), order) == expected);
    CHECK(with_type("MET_UINT", bytes_of_numbers<std::uint32_t>({0, 200, 400, 1000}, big), order) == expected);
    CHECK(with_type("MET_LONG_LONG", bytes_of_numbers<std::int64_t>({-7, 200, 400, 1000}, big), order) == expected);
    CHECK(with_type("MET_ULONG_LONG", bytes_of_numbers<std::uint64_t>({0, 200, 400, 1000}, big), order) == expected);
    CHECK(with_type("MET_FLOAT", bytes_of_numbers<float>({-1, 0.2f, 0.4f, 1}, big), order) == expected);
    CHECK(with_type("MET_DOUBLE", bytes_of_numbers<double>({-1, 0.2, 0.4, 1}, big), order) == expected);
    CHECK(with_type("MET_FLOAT", bytes_of_numbers<float>({NAN, 0.2f, 0.4f, 1}, big), order) == expected);
  }
  CHECK(with_type("MET_CHAR", bytes_of_numbers<std::int8_t>({-7, 20, 40, 100}, false)) == expected);
  CHECK(with_type("MET_FLOAT", bytes_of_numbers<float>({0, 0, 0, 0}, false)) == std::vector<int>{0, 0, 0, 0});
  // Red, green, blue and white.
  const std::string colours =
      "\xff" + std::string(2, '\0') + std::string(1, '\0') + "\xff" + std::string(3, '\0') + "\xff" + "\xff\xff\xff";
  CHECK(with_type("MET_UCHAR", colours, "ElementNumberOfChannels = 3\n") == std::vector<int>{76, 150, 29, 255});
}

TEST_CASE("columns run to the marker and rows away from the probe, however the file has them") {
  const auto with = [](const std::string& orientation) {
    return grey_of(metaimage("UltrasoundImageOrientation = " + orientation + "\n" + kBytes2x3, 2, kTwelve));
  };
  CHECK(with("MFA") == std::vector<int>{'A', 'B', 'C', 'D', 'E', 'F'});
  CHECK(with("UF") == std::vector<int>{'B', 'A', 'D', 'C', 'F', 'E'});
  CHECK(with("MN") == std::vector<int>{'E', 'F', 'C', 'D', 'A', 'B'});
  CHECK(with("UNX") == std::vector<int>{'F', 'E', 'D', 'C', 'B', 'A'});
  TemporaryFolder folder;
  const auto images = [&](const std::string& bytes) {
    return read_recorded_scan(folder.put("scan.igs.mha", bytes)).images.has_value();
  };
  CHECK(images(metaimage(kBytes2x3, 2, kTwelve)));
  // Scan lines as rows, and frames that are interleaved, are not shown.
  CHECK_FALSE(images(metaimage("UltrasoundImageOrientation = FM\n" + kBytes2x3, 2, kTwelve)));
  CHECK_FALSE(images(metaimage("DimSize = 2 2 3\nKinds = list domain domain\n", 2, kTwelve)));
  CHECK_FALSE(images(metaimage("DimSize = 0 0 2\n", 2, "")));
}

TEST_CASE("images that their file cannot hold are refused, and images that are too large are left in it") {
  TemporaryFolder folder;
  const auto scan = [&](const std::string& sizes, const std::string& more, const std::string& data) {
    return read_recorded_scan(
        folder.put("scan.igs.mha", metaimage("DimSize = " + sizes + "\nElementType = MET_UCHAR\n" + more, 1, data)));
  };
  const std::string compressed = "CompressedData = True\n";
  CHECK_THROWS_WITH(scan("10000 10000 1", compressed, std::string(96898, 'x')),
                    Contains("image data: it is truncated: 96898 bytes cannot hold images of 100000000 bytes, even"));
  CHECK(scan("10000 10000 1", compressed, std::string(96899, 'x')).images);
  CHECK(scan("16384 2 1", "", std::string(32768, 'x')).images);
  CHECK_FALSE(scan("16385 2 1", "", std::string(32770, 'x')).images);
  CHECK_FALSE(scan("2 16385 1", "", std::string(32770, 'x')).images);
  CHECK(scan("16384 16384 1", compressed + "ElementNumberOfChannels = 4\n", std::string(1100000, 'x')).images);
  CHECK_FALSE(scan("16384 16384 1", compressed + "ElementNumberOfChannels = 5\n", std::string(1400000, 'x')).images);
}

TEST_CASE("an image lies where ImageToProbe puts it, of its frame or of the header") {
  TemporaryFolder folder;
  const auto placed = [&](const std::string& header, const std::string& more) {
    const RecordedScan scan =
        read_recorded_scan(folder.put("scan.igs.mha", metaimage(header + kBytes2x3, 2, kTwelve, more)));
    return scan.images->frames[1].probe_from_pixel;
  };
  const std::string matrix = "0.2 0 0 -30 0 0.25 0 1 0 0 1 0 0 0 0 1";
  CHECK_FALSE(placed("", ""));
  const auto constant = placed("ImageToProbeTransform = " + matrix + "\n", "");
  REQUIRE(constant);
  CHECK(glm::dvec4((*constant) * glm::dvec4(10, 20, 0, 1)) == glm::dvec4(-28, 6, 0, 1));
  // A matrix of the frame has to be OK, a header's is.
  CHECK_FALSE(placed("", "ImageToProbeTransform = " + matrix));
  CHECK_FALSE(placed("", "ImageToProbeTransformStatus = INVALID"));
  CHECK(placed("ProbeToImageTransform = 5 0 0 150 0 4 0 -4 0 0 1 0 0 0 0 1\n", ""));
}

TEST_CASE("any image of a long compressed recording is found, forwards, backwards and at random") {
  constexpr int kFrames = 300, kSide = 256;  // 18.75 MiB, so that places on the way are kept
  const std::string data = noise(std::size_t(kFrames) * kSide * kSide);
  const std::string header = "DimSize = 256 256 300\nElementType = MET_UCHAR\nCompressedData = True\n";
  TemporaryFolder folder;
  const RecordedScan scan =
      read_recorded_scan(folder.put("scan.igs.mha", metaimage(header, kFrames, packed(data, false))));
  REQUIRE(scan.images);
  ImageReader reader(*scan.images);
  const auto check = [&](std::size_t number) {
    const Image<std::uint8_t>& grey = reader.grey(number);
    CAPTURE(number);
    CHECK(std::memcmp(grey.pixels.data(), data.data() + number * kSide * kSide, kSide * kSide) == 0);
  };
  check(299);
  check(280);
  check(0);
  check(1);
  for (std::uint32_t i = 0; i < 20; ++i) check(hash(i, 7) % kFrames);
  check(298);
  check(299);
}

TEST_CASE("image data that are damaged or end too early are refused when they are read") {
  TemporaryFolder folder;
  std::string data = packed(kTwelve, false);
  const auto refusal = [&](const std::string& bytes) {
    const RecordedScan scan = read_recorded_scan(folder.put("scan.igs.mha", bytes));
    ImageReader reader(*scan.images);
    CHECK(reader.grey(0).at(0, 0) == 'A');
    try {
      reader.grey(1);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  const std::string header = kBytes2x3 + "CompressedData = True\n";
  CHECK(refusal(metaimage(header, 2, data)).empty());
  CHECK_THAT(refusal(metaimage(header, 2, packed(kTwelve.substr(0, 9), false))),
             Contains("ends before the last image"));
  std::string damaged = packed(noise(6) + noise(6), false);
  damaged = data.substr(0, 2) + std::string(20, '\xff');
  const RecordedScan scan = read_recorded_scan(folder.put("b.igs.mha", metaimage(header, 2, damaged)));
  ImageReader reader(*scan.images);
  CHECK_THROWS_WITH(reader.grey(0), Contains("cannot be decompressed"));
  // A file that has become shorter since.
  const RecordedScan raw = read_recorded_scan(folder.put("c.igs.mha", metaimage(kBytes2x3, 2, kTwelve)));
  folder.put("c.igs.mha", metaimage(kBytes2x3, 2, kTwelve.substr(0, 8)));
  ImageReader shorter(*raw.images);
  CHECK_THROWS_WITH(shorter.grey(1), Contains("ends before the last image"));
  const std::string whole = metaimage(header, 2, data);
  const RecordedScan zipped = read_recorded_scan(folder.put("d.igs.mha", whole));
  folder.put("d.igs.mha", whole.substr(0, whole.size() - data.size() + 5));
  ImageReader cut(*zipped.images);
  CHECK_THROWS_WITH(cut.grey(1), Contains("d.igs.mha: image data: it ends before the last image; copy"));
  std::filesystem::remove(folder.path / "c.igs.mha");
  CHECK_THROWS_WITH(ImageReader(*raw.images), Contains("cannot be read"));
}
