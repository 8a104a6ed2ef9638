// How a CT looks in the 3D view: transfer functions.
#include <algorithm>
#include <cmath>

#include "sim/view/body/transfer_function_file.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

using namespace view;

bool is_within(const TransferPoint& point) {
  const auto is_share = [](double value) { return value >= 0 && value <= 1; };
  return point.hu >= kFirstTransfer_hu && point.hu <= kLastTransfer_hu && point.opacity >= 0 &&
         point.opacity <= kMaxOpacity && is_share(point.colour.r) && is_share(point.colour.g) &&
         is_share(point.colour.b);
}

const Target transfer_function_target("transfer_function", [](std::string_view bytes) -> std::string {
  const TransferFunction function = read_transfer_function(file_with("look.toml", bytes));
  if (function.points.size() < 2 || function.points.size() > kMaxTransferPoints) return "it has too few or many points";
  for (std::size_t i = 0; i < function.points.size(); ++i) {
    if (!is_within(function.points[i])) return "a point is out of range";
    if (i > 0 && !(function.points[i].hu > function.points[i - 1].hu)) return "its points do not rise";
  }
  for (const double hu : {-1024.0, -0.5, 40.0, 3071.0})
    if (!is_within(function.at(hu))) return "between its points it is out of range";
  // An entry per HU takes a millisecond, as long as all else, and depends on the points alone.
  if (function.points.size() < 4) {
    const TransferTable table(function.moved(-17, 1.5));
    const auto is_finite = [](const glm::vec4& entry) { return std::isfinite(entry.x) && std::isfinite(entry.w); };
    if (!std::ranges::all_of(table.values, is_finite) || !std::ranges::all_of(table.integrals, is_finite))
      return "its table is not finite";
  }
  const std::filesystem::path again = file_with("again.toml", "");
  write_transfer_function(again, function);
  return read_transfer_function(again) == function ? "" : "written and read again it is another";
});

}  // namespace
}  // namespace insonate::fuzz
