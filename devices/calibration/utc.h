#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace insonate {

/// Converts seconds since 1970 to "2026-03-01T09:30:00Z".
std::string utc_text(std::int64_t seconds);

/// Converts back. Empty for any other format or an invalid date.
std::optional<std::int64_t> utc_seconds(std::string_view text);

}  // namespace insonate
