#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace insonate {

/// Seconds since 1970 as "2026-03-01T09:30:00Z".
std::string utc_text(std::int64_t seconds);

/// And back; empty for anything else, or a date that is none.
std::optional<std::int64_t> utc_seconds(std::string_view text);

}  // namespace insonate
