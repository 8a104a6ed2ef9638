#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "devices/live/device_source.h"
#include "devices/live/placement.h"

namespace insonate {

/// A device on a bus that measures where its sensor is, relative to its own origin.
class MagneticSource : public DeviceSource {
public:
  MagneticSource(const DeviceKind& kind, std::shared_ptr<DeviceBus> bus, const std::string& serial,
                 const Placement& placement, std::function<double()> clock_s)
      : DeviceSource(kind, std::move(bus), serial, std::move(clock_s)), placement_(placement) {}

  std::optional<glm::dvec3> origin() const final { return placement_.origin(); }

protected:
  std::string_view remark() const final { return placement_.remark(); }

  Placement placement_;
};

}  // namespace insonate
