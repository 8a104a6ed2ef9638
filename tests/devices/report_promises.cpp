#include "report_promises.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "devices/hydra/hydra_report.h"
#include "devices/osvr/osvr_report.h"
#include "devices/polhemus/polhemus_stream.h"
#include "devices/spacemouse/spacemouse_report.h"
#include "sim/core/hash.h"

namespace insonate {
namespace {

bool is_pose(const SensorReading& reading) {
  if (reading.status == PoseStatus::invalid) return true;
  return reading.status == PoseStatus::ok && !why_not_rigid(reading.tracker_from_sensor.matrix());
}

bool within(const glm::dvec3& axes, double most) {
  return std::abs(axes.x) <= most && std::abs(axes.y) <= most && std::abs(axes.z) <= most;
}

bool equal(const PolhemusRecord& a, const PolhemusRecord& b) {
  const SensorReading &x = a.reading, &y = b.reading;
  return a.frame == b.frame && x.sensor == y.sensor && x.status == y.status && x.buttons == y.buttons &&
         x.distortion == y.distortion && x.tracker_from_sensor == y.tracker_from_sensor;
}

std::string broken_by_stream(Bytes bytes) {
  std::vector<PolhemusRecord> whole, in_portions;
  PolhemusStream one, other;
  one.add(bytes, whole);
  std::uint32_t seed = std::uint32_t(bytes.size());
  for (const std::uint8_t byte : bytes) seed = hash(seed, byte);
  for (std::size_t begin = 0, step = 0; begin < bytes.size(); ++step) {
    const std::size_t length = std::min<std::size_t>(1 + hash(seed, std::uint32_t(step)) % 97, bytes.size() - begin);
    other.add(bytes.subspan(begin, length), in_portions);
    begin += length;
  }
  if (!std::equal(whole.begin(), whole.end(), in_portions.begin(), in_portions.end(), equal))
    return "the records depend on the portions";
  if (one.corrupt() != other.corrupt() || one.foreign() != other.foreign()) return "the counts depend on the portions";
  // 32 bytes is the least that a sensor takes.
  if (whole.size() * 32 > bytes.size() || one.foreign() > whole.size()) return "more came out than went in";
  for (const PolhemusRecord& record : whole)
    if (!is_pose(record.reading) || record.reading.sensor > 127) return "a record is not a pose";
  return "";
}

}  // namespace

std::string broken_promise(Bytes bytes) {
  if (const auto hydra = parse_hydra(bytes); hydra.fault == ReportFault::none)
    for (const HydraReport::Handset& handset : hydra.report.handsets) {
      const bool in_range = std::abs(handset.stick_x) <= 1 && std::abs(handset.stick_y) <= 1 && handset.trigger >= 0 &&
                            handset.trigger <= 1 && handset.reading.buttons < 128;
      if (!is_pose(handset.reading) || !in_range) return "a Hydra's handset is out of range";
    }
  if (const auto mouse = parse_spacemouse(bytes); mouse.fault == ReportFault::none) {
    const SpaceMouseReport& report = mouse.report;
    if (!within(report.push.value_or(glm::dvec3(0)), 1) || !within(report.turn.value_or(glm::dvec3(0)), 1))
      return "a SpaceMouse is pushed beyond its travel";
    if (!report.push && !report.turn && !report.buttons) return "a SpaceMouse's report says nothing";
  }
  if (const auto osvr = parse_osvr(bytes); osvr.fault == ReportFault::none)
    if (std::abs(glm::length(osvr.report.world_from_sensor) - 1) > 1e-12 || !within(osvr.report.rad_per_s, 64))
      return "an OSVR report is not a rotation";
  return broken_by_stream(bytes);
}

}  // namespace insonate
