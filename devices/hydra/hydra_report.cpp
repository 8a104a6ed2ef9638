#include "devices/hydra/hydra_report.h"

#include <algorithm>

#include "devices/crc16.h"

namespace insonate {
namespace {

constexpr std::array<std::uint8_t, 7> kHydraHeader = {0x01, 0x00, 0x34, 0x00, 0x02, 0x00, 0x01};
constexpr std::size_t kSequence = 7, kSecondHandset = 28, kCrc = 50;
constexpr std::size_t kHandsets[] = {8, 30};
constexpr std::uint16_t kCrcStart = 0x1d0f;
constexpr std::uint32_t kButtonBits = 0x7f;  // bit 7 is always set
constexpr double kOne = 32768;

HydraReport::Handset handset(Bytes bytes, std::uint32_t number) {
  HydraReport::Handset handset;
  const auto at = [&](std::size_t offset) { return double(i16_at(bytes, offset)); };
  set_pose(handset.reading, {at(0), at(2), at(4)}, at(6) / kOne, at(8) / kOne, at(10) / kOne, at(12) / kOne);
  handset.reading.sensor = number;
  handset.reading.buttons = bytes[14] & kButtonBits;
  handset.stick_x = at(15) / kOne;
  handset.stick_y = at(17) / kOne;
  handset.trigger = bytes[19] / 255.0;
  return handset;
}

}  // namespace

Parsed<HydraReport> parse_hydra(Bytes bytes) {
  Parsed<HydraReport> parsed;
  if (bytes.size() != kHydraReportLength)
    parsed.fault = ReportFault::length;
  else if (!std::equal(kHydraHeader.begin(), kHydraHeader.end(), bytes.begin()) || bytes[kSecondHandset] != 2)
    parsed.fault = ReportFault::header;
  else if (crc16_1021(bytes.first(kCrc), kCrcStart) != u16_at(bytes, kCrc))
    parsed.fault = ReportFault::checksum;
  if (parsed.fault != ReportFault::none) return parsed;

  parsed.report.sequence = bytes[kSequence];
  for (std::uint32_t i = 0; i < 2; ++i) parsed.report.handsets[i] = handset(bytes.subspan(kHandsets[i]), i);
  return parsed;
}

std::array<std::uint8_t, kHydraFeatureLength> hydra_mode(bool poses) {
  std::array<std::uint8_t, kHydraFeatureLength> feature{};
  feature[6] = 1;
  feature[8] = 4;
  feature[9] = poses ? 3 : 0;
  feature[89] = poses ? 6 : 5;
  return feature;
}

}  // namespace insonate
