#include "app/recording/webm.h"

#include <bit>

namespace insonate {
namespace {

// Elements of EBML and Matroska, by their IDs in RFC 8794 and RFC 9559.
enum Id : std::uint32_t {
  kEbml = 0x1A45DFA3,
  kEbmlVersion = 0x4286,
  kEbmlReadVersion = 0x42F7,
  kEbmlMaxIdLength = 0x42F2,
  kEbmlMaxSizeLength = 0x42F3,
  kDocType = 0x4282,
  kDocTypeVersion = 0x4287,
  kDocTypeReadVersion = 0x4285,
  kSegment = 0x18538067,
  kSeekHead = 0x114D9B74,
  kSeek = 0x4DBB,
  kSeekId = 0x53AB,
  kSeekPosition = 0x53AC,
  kInfo = 0x1549A966,
  kTimestampScale = 0x2AD7B1,
  kDuration = 0x4489,
  kMuxingApp = 0x4D80,
  kWritingApp = 0x5741,
  kTracks = 0x1654AE6B,
  kTrackEntry = 0xAE,
  kTrackNumber = 0xD7,
  kTrackUid = 0x73C5,
  kTrackType = 0x83,
  kFlagLacing = 0x9C,
  kCodecId = 0x86,
  kVideo = 0xE0,
  kPixelWidth = 0xB0,
  kPixelHeight = 0xBA,
  kCluster = 0x1F43B675,
  kTimestamp = 0xE7,
  kSimpleBlock = 0xA3,
  kCues = 0x1C53BB6B,
  kCuePoint = 0xBB,
  kCueTime = 0xB3,
  kCueTrackPositions = 0xB7,
  kCueTrack = 0xF7,
  kCueClusterPosition = 0xF1,
};

constexpr std::uint64_t kTrack = 1;
/// A block's time is a signed 16-bit number of milliseconds from its cluster's.
constexpr std::int64_t kLongestCluster_ms = 30000;

std::string big_endian(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = bytes - 1; i >= 0; --i) out += char(value >> (8 * i) & 0xff);
  return out;
}

std::string id_bytes(Id id) {
  return big_endian(id, (std::bit_width(std::uint32_t(id)) + 7) / 8);
}

/// Returns an element whose size takes 8 bytes, so that positions do not depend on contents.
std::string element(Id id, std::string_view content) {
  constexpr std::uint64_t kEightBytes = std::uint64_t(1) << 56;
  return id_bytes(id) + big_endian(kEightBytes | content.size(), 8) + std::string(content);
}

std::string number(Id id, std::uint64_t value) {
  return element(id, big_endian(value, 8));
}

std::string real(Id id, double value) {
  return element(id, big_endian(std::bit_cast<std::uint64_t>(value), 8));
}

std::string seek(Id to, std::uint64_t position) {
  return element(kSeek, element(kSeekId, id_bytes(to)) + number(kSeekPosition, position));
}

}  // namespace

void WebmFile::add(std::string_view frame, std::int64_t time_ms, bool is_key) {
  if (clusters_.empty() || is_key || time_ms - clusters_.back().time_ms > kLongestCluster_ms)
    clusters_.push_back({time_ms, {}});
  constexpr char kKeyFrame = char(0x80);
  std::string block = big_endian(0x80 | kTrack, 1);
  block += big_endian(std::uint64_t(time_ms - clusters_.back().time_ms), 2);
  block += is_key ? kKeyFrame : char(0);
  block += frame;
  clusters_.back().blocks += element(kSimpleBlock, block);
  last_ms_ = time_ms;
  ++frames_;
}

std::string WebmFile::bytes() const {
  const std::string head =
      element(kEbml, number(kEbmlVersion, 1) + number(kEbmlReadVersion, 1) + number(kEbmlMaxIdLength, 4) +
                         number(kEbmlMaxSizeLength, 8) + element(kDocType, "webm") + number(kDocTypeVersion, 4) +
                         number(kDocTypeReadVersion, 2));
  const double frame_ms = frames_ > 1 ? double(last_ms_) / double(frames_ - 1) : 0;
  const std::string info =
      element(kInfo, number(kTimestampScale, 1000000) + real(kDuration, double(last_ms_) + frame_ms) +
                         element(kMuxingApp, "Insonate") + element(kWritingApp, "Insonate"));
  const std::string video =
      element(kVideo, number(kPixelWidth, std::uint64_t(width_)) + number(kPixelHeight, std::uint64_t(height_)));
  const std::string tracks = element(
      kTracks, element(kTrackEntry, number(kTrackNumber, kTrack) + number(kTrackUid, kTrack) + number(kTrackType, 1) +
                                        number(kFlagLacing, 0) + element(kCodecId, "V_VP8") + video));
  // Positions count from the segment's content on.
  const std::size_t seek_size = element(kSeekHead, seek(kInfo, 0) + seek(kTracks, 0) + seek(kCues, 0)).size();
  const std::size_t first_cluster = seek_size + info.size() + tracks.size();
  std::string clusters, cues;
  for (const Cluster& cluster : clusters_) {
    const std::string place = number(kCueTrack, kTrack) + number(kCueClusterPosition, first_cluster + clusters.size());
    cues += element(kCuePoint, number(kCueTime, std::uint64_t(cluster.time_ms)) + element(kCueTrackPositions, place));
    clusters += element(kCluster, number(kTimestamp, std::uint64_t(cluster.time_ms)) + cluster.blocks);
  }
  const std::string seeks = element(kSeekHead, seek(kInfo, seek_size) + seek(kTracks, seek_size + info.size()) +
                                                   seek(kCues, first_cluster + clusters.size()));
  return head + element(kSegment, seeks + info + tracks + clusters + element(kCues, cues));
}

}  // namespace insonate
