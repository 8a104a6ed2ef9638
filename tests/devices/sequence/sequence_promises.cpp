#include "sequence_promises.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "devices/sequence/sequence_text.h"
#include "sim/core/input_error.h"
#include "tests/devices/test_samples.h"

namespace insonate {
namespace {

/// The samples, or nothing when the bytes are refused.
std::optional<std::vector<ProbeSample>> samples_of(const CutBytes& bytes) {
  try {
    return probe_samples(parse_sequence(bytes, "fuzzed"));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

std::string broken_sequence_promise(std::string_view bytes) {
  std::size_t offset = bytes.size();
  try {
    offset = parse_sequence(bytes, "fuzzed").image_offset;
  } catch (const InputError&) {
  }
  const auto samples = samples_of(CutBytes::whole(bytes));
  constexpr std::size_t kEnds = 64;
  const std::string_view front = bytes.substr(0, std::min(bytes.size(), offset + kEnds));
  const auto cut = samples_of({front, bytes.size(), bytes.substr(bytes.size() - std::min(bytes.size(), kEnds))});
  if (samples.has_value() != cut.has_value()) return "whether it is taken depends on the images at hand";
  if (!samples) return "";
  if (!same_bits(*samples, *cut)) return "the samples depend on the images at hand";
  double before_s = -std::numeric_limits<double>::infinity();
  for (const ProbeSample& sample : *samples) {
    if (const std::string why = why_not_recordable(sample, before_s); !why.empty()) return why;
    before_s = sample.time_s;
  }
  const auto again = samples_of(CutBytes::whole(write_sequence(*samples)));
  if (!again || !same_bits(*samples, *again)) return "written and read again it is another scan";
  return "";
}

}  // namespace insonate
