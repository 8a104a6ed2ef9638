#include "devices/spacemouse/spacemouse_report.h"

#include <algorithm>

namespace insonate {
namespace {

enum Number : std::uint8_t { kPush = 1, kTurn = 2, kButtons = 3 };
constexpr double kFullTravel = 350;  // as in public drivers; a hard push can exceed it

glm::dvec3 axes(Bytes bytes, std::size_t offset) {
  glm::dvec3 axes;
  for (int i = 0; i < 3; ++i) axes[i] = std::clamp(i16_at(bytes, offset + 2 * std::size_t(i)) / kFullTravel, -1.0, 1.0);
  return axes;
}

}  // namespace

Parsed<SpaceMouseReport> parse_spacemouse(Bytes bytes) {
  Parsed<SpaceMouseReport> parsed;
  if (bytes.empty()) {
    parsed.fault = ReportFault::length;
    return parsed;
  }
  const std::uint8_t number = bytes[0];
  const bool one_axis_set = bytes.size() == 7, both = number == kPush && bytes.size() == 13;
  if (number < kPush || number > kButtons) {
    parsed.fault = ReportFault::header;
  } else if (number == kButtons ? bytes.size() < 2 || bytes.size() > 7 : !one_axis_set && !both) {
    parsed.fault = ReportFault::length;
  } else if (number == kButtons) {
    std::uint32_t buttons = 0;
    for (std::size_t i = std::min<std::size_t>(bytes.size(), 5); i-- > 1;) buttons = buttons << 8 | bytes[i];
    parsed.report.buttons = buttons;
  } else {
    (number == kPush ? parsed.report.push : parsed.report.turn) = axes(bytes, 1);
    if (both) parsed.report.turn = axes(bytes, 7);
  }
  return parsed;
}

}  // namespace insonate
