#include "devices/polhemus/polhemus_stream.h"

#include <algorithm>
#include <string_view>

#include "devices/crc16.h"

namespace insonate {
namespace {

constexpr double kMmPerCm = 10;

// Liberty and Patriot.
constexpr std::size_t kLibertyHeader = 8, kLibertyBody = 40;
constexpr int kMaxStations = 16;

// Viper: sizes of the frame's parts before the sensors, per sensor, and after them.
constexpr std::size_t kViperHeader = 8, kViperInfo = 16, kViperSensor = 32, kViperCrc = 4;

/// Classification of the first stored bytes.
struct Front {
  enum { nothing, begun, damaged, complete } what;
  std::size_t length = 0;  ///< of a complete record
};

bool begins(Bytes bytes, std::string_view tag) {
  const std::size_t n = std::min(bytes.size(), tag.size());
  return std::equal(tag.begin(), tag.begin() + std::ptrdiff_t(n), bytes.begin());
}

Front liberty(Bytes bytes, std::vector<PolhemusRecord>& records) {
  if (bytes.size() < kLibertyHeader) return {Front::begun};
  const int station = bytes[2];
  const bool is_pose = bytes[3] == 'C' || bytes[3] == 'P' || bytes[3] == 'c' || bytes[3] == 'p';
  if (station < 1 || station > kMaxStations || !is_pose || u16_at(bytes, 6) != kLibertyBody) return {Front::nothing};
  if (bytes.size() < kLibertyHeader + kLibertyBody) return {Front::begun};

  PolhemusRecord record;
  const Bytes body = bytes.subspan(kLibertyHeader);
  record.frame = u32_at(body, 4);
  const auto at = [&](std::size_t offset) { return double(f32_at(body, offset)); };
  set_pose(record.reading, kMmPerCm * glm::dvec3(at(12), at(16), at(20)), at(24), at(28), at(32), at(36));
  if (record.reading.status != PoseStatus::ok) return {Front::damaged};
  record.reading.sensor = std::uint32_t(station - 1);
  record.reading.distortion = u32_at(body, 8) & 0x7fffffffu;
  if (bytes[4] != ' ') record.reading.status = PoseStatus::invalid;
  records.push_back(record);
  return {Front::complete, kLibertyHeader + kLibertyBody};
}

SensorReading viper_sensor(Bytes bytes) {
  constexpr double kMmPerUnit[] = {25.4, 304.8, kMmPerCm, 1000};
  constexpr std::uint32_t kQuaternion = 2;
  SensorReading reading;
  const std::uint32_t info = u32_at(bytes, 0);
  const auto at = [&](std::size_t offset) { return double(f32_at(bytes, offset)); };
  if ((info >> 10 & 3) == kQuaternion)
    set_pose(reading, kMmPerUnit[info >> 8 & 3] * glm::dvec3(at(4), at(8), at(12)), at(16), at(20), at(24), at(28));
  reading.sensor = info & 0x7f;
  reading.buttons = info >> 12 & 3;
  reading.distortion = info >> 14 & 0xff;
  return reading;
}

Front viper_frame(Bytes bytes, std::vector<PolhemusRecord>& records) {
  if (bytes.size() < kViperHeader + kViperInfo) return {Front::begun};
  const std::uint32_t size = u32_at(bytes, 4), sensors = u32_at(bytes, 20);
  if (sensors > kMaxPolhemusSensors || size != kViperInfo + kViperSensor * sensors + kViperCrc) return {Front::nothing};
  const std::size_t length = kViperHeader + size;
  if (bytes.size() < length) return {Front::begun};
  if (crc16_arc(bytes.first(length - kViperCrc)) != u32_at(bytes, length - kViperCrc)) return {Front::damaged};
  for (std::size_t i = 0; i < sensors; ++i)
    records.push_back({u32_at(bytes, 12), viper_sensor(bytes.subspan(kViperHeader + kViperInfo + kViperSensor * i))});
  return {Front::complete, length};
}

Front look(Bytes bytes, std::vector<PolhemusRecord>& records) {
  if (begins(bytes, "VPRP")) return viper_frame(bytes, records);
  if (begins(bytes, "LY") || begins(bytes, "PA")) return liberty(bytes, records);
  return {Front::nothing};
}

}  // namespace

void PolhemusStream::add(Bytes bytes, std::vector<PolhemusRecord>& records) {
  kept_.insert(kept_.end(), bytes.begin(), bytes.end());
  std::size_t done = 0;
  while (done < kept_.size()) {
    const Front front = look(Bytes(kept_).subspan(done), records);
    if (front.what == Front::begun) break;
    corrupt_ += front.what == Front::damaged;
    foreign_ += front.what == Front::nothing && in_order_;
    in_order_ = front.what == Front::complete;
    done += front.what == Front::complete ? front.length : 1;
  }
  kept_.erase(kept_.begin(), kept_.begin() + std::ptrdiff_t(done));
}

std::vector<std::uint8_t> viper::command(Command command, Action action, const std::vector<std::uint32_t>& payload) {
  constexpr std::uint32_t kEveryUnit = 0xffffffff;
  const auto follows = std::uint32_t(4 * (5 + payload.size()) + kViperCrc);
  std::vector<std::uint8_t> bytes = {'V', 'P', 'R', 'C'};
  const auto add = [&](std::uint32_t number) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(std::uint8_t(number >> shift));
  };
  for (const std::uint32_t number : {follows, kEveryUnit, std::uint32_t(command), std::uint32_t(action), 0u, 0u})
    add(number);
  for (const std::uint32_t number : payload) add(number);
  add(crc16_arc(bytes));
  return bytes;
}

}  // namespace insonate
