#include "devices/spacemouse/spacemouse_tracker.h"

#include <glm/geometric.hpp>

#include <algorithm>

#include "devices/hid/hid_bus.h"
#include "devices/live/probe_buttons.h"
#include "devices/spacemouse/spacemouse_report.h"

namespace insonate {
namespace {

constexpr std::string_view kDesk = "moves the probe at a desk";
constexpr DeviceKind::Model kSpaceMouseModels[] = {
    {0x046d, 0xc626, "3Dconnexion SpaceNavigator", kDesk},
    {0x256f, 0xc635, "3Dconnexion SpaceMouse Compact", kDesk},
    {0x256f, 0xc62e, "3Dconnexion SpaceMouse Wireless", kDesk},
    {0x256f, kAnyProduct, "3Dconnexion SpaceMouse", kDesk},
};
constexpr ButtonMeaning kSpaceMouseButtons[] = {{0, kFreezeButton}, {1, kEventMarkerButton}};  // left, right

/// Converts the cap's axes (right, towards the user, down) to the probe's frame (marker, beam, elevation).
glm::dvec3 probe_from_cap(const glm::dvec3& cap) {
  return {-cap.x, cap.z, cap.y};
}

}  // namespace

const DeviceKind kSpaceMouseDevice{.name = "SpaceMouse", .models = kSpaceMouseModels, .steady = false};

SpaceMouseSource::SpaceMouseSource(std::shared_ptr<DeviceBus> bus, const std::string& serial, const Pose& start,
                                   double speed, std::function<double()> clock_s)
    : DeviceSource(kSpaceMouseDevice, std::move(bus), serial, std::move(clock_s)),
      speed_(speed),
      rotation_(glm::normalize(glm::quat_cast(start.rotation))),
      began_(start.translation),
      translation_(start.translation) {}

void SpaceMouseSource::start(Transport&, const AttachedDevice&) {
  push_ = turn_ = glm::dvec3(0);
  buttons_ = 0;
  now_s_ = 0;
}

void SpaceMouseSource::move(double elapsed_s) {
  const glm::dvec3 way = translation_ + rotation_ * (push_ * speed_ * kMmPerS * elapsed_s) - began_;
  translation_ = began_ + way * std::min(kRange_mm / std::max(glm::length(way), kRange_mm), 1.0);
  const glm::dvec3 turn = turn_ * speed_ * kRadPerS * elapsed_s;
  if (const double angle = glm::length(turn); angle > 0)
    rotation_ = glm::normalize(rotation_ * glm::angleAxis(angle, turn / angle));
}

bool SpaceMouseSource::take(Bytes bytes, double time_s, LiveBatch& batch, ReportTally& tally) {
  // Until now the cap moved at the rate it last reported, but no longer than kLetGo_s after that report.
  if (now_s_ > 0) move(std::clamp(std::min(time_s, reported_s_ + kLetGo_s) - now_s_, 0.0, kLetGo_s));
  now_s_ = time_s;
  bool understood = false;
  if (!bytes.empty()) {
    const Parsed<SpaceMouseReport> parsed = parse_spacemouse(bytes);
    // Reports of the battery and the like are not incidents.
    if (parsed.fault != ReportFault::header) tally.count(parsed.fault);
    understood = parsed.fault == ReportFault::none;
    if (understood) {
      const SpaceMouseReport& report = parsed.report;
      if (report.push) push_ = probe_from_cap(*report.push);
      if (report.turn) turn_ = probe_from_cap(*report.turn);
      if (report.push || report.turn) reported_s_ = time_s;
      if (report.buttons) buttons_ = *report.buttons;
    }
  }
  batch.samples.push_back(
      {time_s, PoseStatus::ok, {glm::mat3_cast(rotation_), translation_}, probe_buttons(kSpaceMouseButtons, buttons_)});
  return understood;
}

std::unique_ptr<RawSource> make_spacemouse(const TrackerUri& uri, const TrackerContext& context) {
  uri.allow_options({"speed"});
  return std::make_unique<SpaceMouseSource>(std::make_shared<HidBus>(), uri.subject, context.start,
                                            uri.number("speed", 1, 0.1, 10));
}

}  // namespace insonate
