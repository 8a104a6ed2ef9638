#pragma once

#include <cstdint>
#include <string_view>

namespace insonate {

enum class Bus { hid, usb };

/// A tracker that is recognised by its USB vendor and product numbers.
struct KnownTracker {
  Bus bus;
  std::uint16_t vendor;
  std::uint16_t product;  ///< or kAnyProduct
  std::string_view name;
  std::string_view note;  ///< what users should know about it at present; may be empty
};

inline constexpr std::uint16_t kAnyProduct = 0;

/// Returns the tracker with these numbers on this bus, or nullptr if it is unknown.
const KnownTracker* known_tracker(Bus bus, std::uint16_t vendor, std::uint16_t product);

}  // namespace insonate
