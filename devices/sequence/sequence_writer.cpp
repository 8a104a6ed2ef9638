#include <limits>
#include <stdexcept>

#include "devices/sequence/sequence.h"
#include "devices/sequence/sequence_text.h"

namespace insonate {

std::string write_sequence(const std::vector<ProbeSample>& samples, const std::map<double, std::string>& actions) {
  if (samples.empty()) throw std::invalid_argument("a sequence file needs at least one sample");
  std::string text = sequence_head("0 0 " + std::to_string(samples.size()), false);
  double before_s = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (const std::string why = why_not_recordable(samples[i], before_s); !why.empty())
      throw std::invalid_argument("sample " + std::to_string(i) + ": " + why);
    const auto done = actions.find(samples[i].time_s);
    append_frame(text, i, samples[i], nullptr, done == actions.end() ? std::string_view() : done->second);
    before_s = samples[i].time_s;
  }
  return text.append(kSequenceEnd);
}

PoseStatus status_from_igsio(std::string_view word) {
  std::string upper;
  for (const char c : word) upper += c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  for (const std::string_view prefix : {"TOOL_", "TR_"})
    if (upper.starts_with(prefix)) upper.erase(0, prefix.size());
  if (upper == "OK") return PoseStatus::ok;
  if (upper == "MISSING" || upper == "REQ_TIMEOUT") return PoseStatus::missing;
  if (upper == "OUT_OF_VIEW") return PoseStatus::out_of_view;
  if (upper == "OUT_OF_VOLUME") return PoseStatus::out_of_volume;
  if (upper == "SWITCH1_IS_ON" || upper == "SWITCH2_IS_ON" || upper == "SWITCH3_IS_ON") return PoseStatus::switched;
  if (upper == "INVALID" || upper == "PATH_NOT_FOUND") return PoseStatus::invalid;
  return PoseStatus::unknown;
}

}  // namespace insonate
