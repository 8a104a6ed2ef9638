#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "devices/sequence/sequence.h"

namespace insonate {
namespace {

// The shortest decimal that reads back to the same double, at most 17 digits, whatever the locale.
void append(std::string& text, double number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

std::string_view igsio_word(const PoseSample& sample) {
  switch (sample.status) {
    case PoseStatus::ok:
      return "OK";
    case PoseStatus::missing:
      return "MISSING";
    case PoseStatus::out_of_view:
      return "OUT_OF_VIEW";
    case PoseStatus::out_of_volume:
      return "OUT_OF_VOLUME";
    case PoseStatus::switched:
      return "SWITCH1_IS_ON";
    case PoseStatus::invalid:
      return "INVALID";
    case PoseStatus::unknown:
      return "UNKNOWN";
  }
  return "UNKNOWN";
}

void check_readable(const std::vector<PoseSample>& samples) {
  if (samples.empty()) throw std::invalid_argument("a sequence file needs at least one sample");
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!std::isfinite(samples[i].time_s) || (i > 0 && !(samples[i].time_s > samples[i - 1].time_s)))
      throw std::invalid_argument("the time of sample " + std::to_string(i) + " is not after the one before");
    if (samples[i].status != PoseStatus::ok) continue;
    if (const auto why = why_not_rigid(samples[i].patient_from_probe.matrix()))
      throw std::invalid_argument("sample " + std::to_string(i) + ": " + *why);
  }
}

}  // namespace

std::string write_sequence(const std::vector<PoseSample>& samples) {
  check_readable(samples);
  // RAI is ITK's name for axes that run from right, anterior and inferior, which makes them LPS.
  std::string text =
      "ObjectType = Image\n"
      "NDims = 3\n"
      "AnatomicalOrientation = RAI\n"
      "BinaryData = True\n"
      "CenterOfRotation = 0 0 0\n"
      "CompressedData = False\n"
      "DimSize = 0 0 " +
      std::to_string(samples.size()) +
      "\n"
      "ElementSpacing = 1 1 1\n"
      "ElementType = MET_UCHAR\n"
      "Kinds = domain domain list\n"
      "Offset = 0 0 0\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\n"
      "UltrasoundImageOrientation = MF\n"
      "UltrasoundImageType = BRIGHTNESS\n";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const PoseSample& sample = samples[i];
    const std::string index = std::to_string(i);
    const std::string frame = "Seq_Frame" + std::string(index.size() < 4 ? 4 - index.size() : 0, '0') + index + "_";

    const auto field = [&](std::string_view name) -> std::string& { return text.append(frame).append(name); };

    field("ProbeToPatientTransform =");
    const glm::dmat4 matrix = sample.status == PoseStatus::ok ? sample.patient_from_probe.matrix() : glm::dmat4(1.0);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) append(text += ' ', matrix[column][row]);
    text += '\n';
    field("ProbeToPatientTransformStatus = ").append(igsio_word(sample)) += '\n';
    if (sample.buttons != 0 || sample.status == PoseStatus::switched)
      field("Buttons = ").append(std::to_string(sample.buttons)) += '\n';
    field("FrameNumber = ").append(index) += '\n';
    append(field("Timestamp = "), sample.time_s);
    text += '\n';
    append(field("UnfilteredTimestamp = "), sample.time_s);
    text += '\n';
  }
  return text + "ElementDataFile = LOCAL\n";
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
