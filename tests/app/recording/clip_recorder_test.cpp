// Clips, read by other people's programs: the container by libwebm, the pictures by libvpx's decoder.
#include "app/recording/clip_recorder.h"

#include <catch2/catch.hpp>
#include <unistd.h>
#include <vpx/vp8dx.h>
#include <vpx/vpx_decoder.h>
#include <webm/callback.h>
#include <webm/istream_reader.h>
#include <webm/webm_parser.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "app/recording/webm.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;

namespace {

/// What a player finds in a WebM file.
struct Found : webm::Callback {
  double duration_ms = 0;
  std::string codec;
  std::uint64_t width = 0, height = 0, cluster_ms = 0;
  struct Frame {
    std::int64_t time_ms;
    bool is_key;
    std::string bytes;
  };
  std::vector<Frame> frames;
  std::vector<std::uint64_t> cue_times_ms, cue_positions, cluster_positions;
  std::uint64_t segment_at = 0;

  webm::Status OnSegmentBegin(const webm::ElementMetadata& metadata, webm::Action* action) override {
    segment_at = metadata.position + metadata.header_size;
    *action = webm::Action::kRead;
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnInfo(const webm::ElementMetadata&, const webm::Info& info) override {
    duration_ms = info.duration.value() * double(info.timecode_scale.value()) / 1e6;
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnTrackEntry(const webm::ElementMetadata&, const webm::TrackEntry& track) override {
    codec = track.codec_id.value();
    width = track.video.value().pixel_width.value();
    height = track.video.value().pixel_height.value();
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnClusterBegin(const webm::ElementMetadata& metadata, const webm::Cluster& cluster,
                              webm::Action* action) override {
    cluster_ms = cluster.timecode.value();
    cluster_positions.push_back(metadata.position - segment_at);
    *action = webm::Action::kRead;
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnSimpleBlockBegin(const webm::ElementMetadata&, const webm::SimpleBlock& block,
                                  webm::Action* action) override {
    frames.push_back({std::int64_t(cluster_ms) + block.timecode, block.is_key_frame, {}});
    *action = webm::Action::kRead;
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnFrame(const webm::FrameMetadata&, webm::Reader* reader, std::uint64_t* left) override {
    while (*left > 0) {
      std::uint8_t byte = 0;
      std::uint64_t count = 0;
      const webm::Status status = reader->Read(1, &byte, &count);
      if (!status.completed_ok()) return status;
      frames.back().bytes += char(byte);
      *left -= count;
    }
    return webm::Status(webm::Status::kOkCompleted);
  }
  webm::Status OnCuePoint(const webm::ElementMetadata&, const webm::CuePoint& cue) override {
    cue_times_ms.push_back(cue.time.value());
    cue_positions.push_back(cue.cue_track_positions.front().value().cluster_position.value());
    return webm::Status(webm::Status::kOkCompleted);
  }
};

Found parsed(const std::filesystem::path& file) {
  Found found;
  std::ifstream in(file, std::ios::binary);
  webm::IstreamReader reader(std::move(in));
  webm::WebmParser parser;
  REQUIRE(parser.Feed(&found, &reader).completed_ok());
  return found;
}

/// A grey picture with a bright square that moves.
Image<Rgba8> picture(int width, int height, int at) {
  Image<Rgba8> image(width, height, {40, 40, 40, 255});
  for (int y = 20; y < 40; ++y)
    for (int x = at; x < at + 20; ++x) image.at(x, y) = {230, 230, 230, 255};
  return image;
}

/// Root mean square of the difference in brightness between a decoded frame and what it was made from.
double difference(const vpx_image_t& decoded, const Image<Rgba8>& original) {
  double sum = 0;
  for (int y = 0; y < original.height; ++y)
    for (int x = 0; x < original.width; ++x) {
      const double luma = decoded.planes[VPX_PLANE_Y][y * decoded.stride[VPX_PLANE_Y] + x];
      const double grey = (luma - 16) * 255 / 219;
      sum += std::pow(grey - original.at(x, y)[0], 2);
    }
  return std::sqrt(sum / double(original.pixels.size()));
}

}  // namespace

TEST_CASE("a clip shows every picture at its time, and other programs can read it and seek in it") {
  const TemporaryFolder folder;
  const auto file = folder.path / "clip.webm";
  constexpr int kWidth = 151, kHeight = 99, kFrames = 100;  // odd, as panels are
  ClipRecorder clip;
  clip.start(file.parent_path() / "clip");
  for (int i = 0; i < kFrames; ++i)
    while (!clip.take(picture(kWidth, kHeight, i), 7 + i / 25.0)) usleep(4000);  // until the encoder has caught up
  CHECK(clip.duration_s() == Approx(99 / 25.0));
  CHECK_FALSE(std::filesystem::exists(file));
  clip.stop();
  clip.wait();
  REQUIRE(clip.take_finished() == file);
  CHECK_FALSE(clip.take_finished());

  const Found found = parsed(file);
  CHECK(found.codec == "V_VP8");
  CHECK(found.width == kWidth);
  CHECK(found.height == kHeight);
  REQUIRE(found.frames.size() == kFrames);
  CHECK(found.duration_ms == Approx(1000 * kFrames / 25.0).margin(1));
  CHECK(found.frames.front().is_key);
  CHECK(found.cue_positions == found.cluster_positions);
  CHECK(found.cue_positions.size() >= 2);
  CHECK(found.cue_times_ms.front() == 0);

  vpx_codec_ctx_t decoder{};
  REQUIRE(vpx_codec_dec_init(&decoder, vpx_codec_vp8_dx(), nullptr, 0) == VPX_CODEC_OK);
  for (int i = 0; i < kFrames; ++i) {
    CAPTURE(i);
    const Found::Frame& frame = found.frames[std::size_t(i)];
    CHECK(frame.time_ms == std::llround(i * 40.0));
    REQUIRE(vpx_codec_decode(&decoder, reinterpret_cast<const std::uint8_t*>(frame.bytes.data()),
                             unsigned(frame.bytes.size()), nullptr, 0) == VPX_CODEC_OK);
    vpx_codec_iter_t at = nullptr;
    const vpx_image_t* const image = vpx_codec_get_frame(&decoder, &at);
    REQUIRE(image);
    // The square against the frame before or after it differs by 27 grey levels.
    CHECK(difference(*image, picture(kWidth, kHeight, i)) < 8);
  }
  vpx_codec_destroy(&decoder);
}

TEST_CASE("a clip keeps the size of its first picture, and shows its last one until it is stopped") {
  const TemporaryFolder folder;
  ClipRecorder clip;
  clip.start(folder.path / "clip");
  clip.take(picture(120, 80, 10), 0);
  clip.take(picture(150, 60, 40), 0.5);  // the panel has become wider and lower
  clip.stop(2);
  clip.wait();
  const auto file = clip.take_finished();
  REQUIRE(file);
  const Found found = parsed(*file);
  CHECK(found.width == 120);
  CHECK(found.height == 80);
  REQUIRE(found.frames.size() == 3);
  CHECK(found.frames[1].time_ms == 500);
  CHECK(found.frames[2].time_ms == 2000);

  vpx_codec_ctx_t decoder{};
  REQUIRE(vpx_codec_dec_init(&decoder, vpx_codec_vp8_dx(), nullptr, 0) == VPX_CODEC_OK);
  // 15 columns are cut off on either side, and 10 rows of black added above and below.
  Image<Rgba8> second(120, 80, {0, 0, 0, 255});
  const Image<Rgba8> taken = picture(150, 60, 40);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 120; ++x) second.at(x, y + 10) = taken.at(x + 15, y);
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    const std::string& bytes = found.frames[i].bytes;
    REQUIRE(vpx_codec_decode(&decoder, reinterpret_cast<const std::uint8_t*>(bytes.data()), unsigned(bytes.size()),
                             nullptr, 0) == VPX_CODEC_OK);
    vpx_codec_iter_t at = nullptr;
    const vpx_image_t* const image = vpx_codec_get_frame(&decoder, &at);
    REQUIRE(image);
    CHECK(difference(*image, i == 0 ? picture(120, 80, 10) : second) < 8);
  }
  vpx_codec_destroy(&decoder);
}

TEST_CASE("two clips of one name are two files") {
  const TemporaryFolder folder;
  std::vector<std::filesystem::path> files;
  for (int i = 0; i < 2; ++i) {
    ClipRecorder clip;
    clip.start(folder.path / "clip");
    clip.take(picture(64, 64, 3), 0);
    clip.stop();
    clip.wait();
    files.push_back(clip.take_finished().value());
  }
  CHECK(files[0] == folder.path / "clip.webm");
  CHECK(files[1] == folder.path / "clip-2.webm");
}

TEST_CASE("a clip that is given up or has no picture leaves no file, and the next one works") {
  const TemporaryFolder folder;
  const auto file = folder.path / "clip.webm";
  {
    ClipRecorder clip;
    clip.start(file.parent_path() / "clip");
    clip.take(picture(64, 64, 3), 0);
  }
  CHECK_FALSE(std::filesystem::exists(file));
  ClipRecorder clip;
  clip.start(file.parent_path() / "clip");
  clip.stop();
  clip.wait();
  CHECK_THROWS_AS(clip.take_finished(), InputError);
  CHECK_FALSE(std::filesystem::exists(file));
  clip.start(file.parent_path() / "clip");
  clip.take(picture(64, 64, 3), 0);
  clip.stop();
  clip.wait();
  CHECK(clip.take_finished() == file);
  CHECK(parsed(file).frames.size() == 1);
}

TEST_CASE("a clip that cannot be written says so, and one that is too long ends by itself") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path);
  write_file(folder.path / "file", "no folder");
  ClipRecorder clip;
  clip.start(folder.path / "file" / "clip");
  clip.take(picture(64, 64, 3), 0);
  CHECK(clip.running());
  clip.take(picture(64, 64, 4), ClipRecorder::kLongest_s);
  CHECK_FALSE(clip.running());
  clip.wait();
  CHECK_THROWS_WITH(clip.take_finished(), Catch::Contains("file"));
}

TEST_CASE("a block's time stays within what the container can express") {
  const TemporaryFolder folder;
  WebmFile webm(64, 64);
  webm.add("key", 0, true);
  webm.add("next", 50000, false);  // without a key frame meanwhile
  write_file(folder.path / "clip.webm", webm.bytes());
  const Found found = parsed(folder.path / "clip.webm");
  REQUIRE(found.frames.size() == 2);
  CHECK(found.frames[1].time_ms == 50000);
}
