#include "sim/core/suggest.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace insonate {
namespace {

/// Returns the number of insertions, deletions and replacements that turn one word into the other (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

constexpr std::size_t kLongestListed = 40;

}  // namespace

std::optional<std::string> similar_name(std::string_view unknown, const std::vector<std::string>& known) {
  // A third of the letters may be wrong: more is another word, not a slip.
  const std::size_t slips = std::max<std::size_t>(1, std::min<std::size_t>(unknown.size(), 64) / 3);
  const std::string* nearest = nullptr;
  std::pair least(slips + 1, std::size_t(0));
  for (const std::string& name : known) {
    if (unknown.size() > name.size() + slips) continue;
    // Among equally near names, the one of the nearest length: 'lables' is 'labels' rather than 'label'.
    const std::size_t longer = std::max(unknown.size(), name.size()), shorter = std::min(unknown.size(), name.size());
    if (const std::pair distance(edit_distance(unknown, name), longer - shorter); distance < least) {
      least = distance;
      nearest = &name;
    }
  }
  return nearest ? std::optional(*nearest) : std::nullopt;
}

std::string suggest(std::string_view unknown, const std::vector<std::string>& known) {
  if (known.empty()) return "remove it";
  if (const auto similar = similar_name(unknown, known)) return "did you mean '" + *similar + "'?";
  std::string list;
  for (std::size_t i = 0; i < std::min(known.size(), kLongestListed); ++i) list += (i ? ", '" : "'") + known[i] + "'";
  return (known.size() == 1 ? "use " : "use one of ") + list + (known.size() > kLongestListed ? ", ..." : "");
}

}  // namespace insonate
