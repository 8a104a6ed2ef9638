#include "devices/sequence/sequence_text.h"

#include <charconv>
#include <cmath>

namespace insonate {
namespace {

// The shortest decimal that reads back to the same double, at most 17 digits, in any locale.
void append(std::string& text, double number) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}

void append(std::string& text, const glm::dmat4& matrix) {
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) append(text += ' ', matrix[column][row]);
  text += '\n';
}

std::string_view igsio_word(const ProbeSample& sample) {
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

}  // namespace

std::string sequence_head(const std::string& size, bool compressed) {
  // RAI is ITK's name for axes that start at right, anterior and inferior, which makes them LPS. MF: the picture's
  // columns run to the marked side, its rows away from the probe.
  return std::string(
             "ObjectType = Image\n"
             "NDims = 3\n"
             "AnatomicalOrientation = RAI\n"
             "BinaryData = True\n"
             "CenterOfRotation = 0 0 0\n"
             "CompressedData = ") +
         (compressed ? "True" : "False") + "\nDimSize = " + size +
         "\n"
         "ElementSpacing = 1 1 1\n"
         "ElementType = MET_UCHAR\n"
         "Kinds = domain domain list\n"
         "Offset = 0 0 0\n"
         "TransformMatrix = 1 0 0 0 1 0 0 0 1\n"
         "UltrasoundImageOrientation = MF\n"
         "UltrasoundImageType = BRIGHTNESS\n";
}

void append_frame(std::string& text, std::size_t index, const ProbeSample& sample, const glm::dmat4* probe_from_pixel,
                  std::string_view actions) {
  const std::string number = std::to_string(index);
  const std::string frame = "Seq_Frame" + std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number + "_";
  const auto field = [&](std::string_view name) -> std::string& { return text.append(frame).append(name); };

  append(field("ProbeToPatientTransform ="),
         sample.status == PoseStatus::ok ? sample.patient_from_probe.matrix() : glm::dmat4(1.0));
  field("ProbeToPatientTransformStatus = ").append(igsio_word(sample)) += '\n';
  if (probe_from_pixel) {
    append(field("ImageToProbeTransform ="), *probe_from_pixel);
    field("ImageToProbeTransformStatus = OK\n");
    field("ImageStatus = OK\n");
  }
  if (sample.buttons != 0 || sample.status == PoseStatus::switched)
    field("Buttons = ").append(std::to_string(sample.buttons)) += '\n';
  if (sample.distortion) field("Distortion = ").append(std::to_string(*sample.distortion)) += '\n';
  if (sample.rejected != Rejection::none) field("Rejected = ").append(to_string(sample.rejected)) += '\n';
  if (!actions.empty()) field("Actions = ").append(actions) += '\n';
  field("FrameNumber = ").append(number) += '\n';
  append(field("Timestamp = "), sample.time_s);
  text += '\n';
  append(field("UnfilteredTimestamp = "), sample.time_s);
  text += '\n';
}

std::string why_not_recordable(const ProbeSample& sample, double before_s) {
  if (!std::isfinite(sample.time_s) || !(sample.time_s > before_s)) return "its time is not after the one before";
  if (sample.time_s - before_s > kLongestStep_s && std::isfinite(before_s))
    return "its time is more than a day after the one before";
  if (sample.status != PoseStatus::ok) return "";
  return why_not_rigid(sample.patient_from_probe.matrix()).value_or("");
}

}  // namespace insonate
