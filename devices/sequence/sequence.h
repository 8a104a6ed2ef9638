#pragma once

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/sequence/cut_bytes.h"
#include "devices/sequence/sequence_layout.h"
#include "sim/core/pose_sample.h"

namespace insonate {

/// A transform of one frame of a sequence file. `AToB` takes points of frame A to frame B, mm.
struct SequenceTransform {
  int name = 0;  ///< index into Sequence::transform_names
  PoseStatus status = PoseStatus::unknown;
  glm::dmat4 matrix{0.0};  ///< finite where status is ok, not necessarily rigid; zero where it is not
};

struct SequenceFrame {
  std::size_t number = 0;                     ///< of the frame and its image in the file, from 0
  double time_s = 0;                          ///< the file's Timestamp: since some start or since 1970; 0 without one
  std::uint32_t buttons = 0;                  ///< bit b is set while button b is held
  std::optional<std::uint32_t> distortion;    ///< as the tracker graded it, where it did
  Rejection rejected = Rejection::none;       ///< why a filter took its pose away, where one did
  std::vector<SequenceTransform> transforms;  ///< in no particular order, none twice
  std::string actions;  ///< what was done besides moving since the frame before, in the recording program's words

  const SequenceTransform* find(int name) const;
};

/// Frames may stand this far behind a later one. Writers that take poses and images from two threads mix them up by
/// less than a frame; what lies further back is a clock that was set.
inline constexpr double kLargestDisorderS = 0.05;

/// What an IGSIO/PLUS sequence file (.igs.mha, .seq.mha, .seq.nrrd) says of its frames; the images are left where they
/// are (image_reader.h reads them).
struct Sequence {
  std::string file;                             ///< for messages
  std::vector<std::string> transform_names;     ///< of all frames, without "Transform": "ProbeToTracker"
  std::map<std::string, glm::dmat4> constants;  ///< transforms of the header, which hold for all frames; finite
  std::vector<SequenceFrame> frames;            ///< at least one; times finite and strictly rising
  bool has_times = true;                        ///< false: no frame has a Timestamp, and they are in the file's order
  std::size_t frames_out_of_order = 0;  ///< frames that stood behind a later one, and were sorted by their times
  double worst_disorder_s = 0;          ///< how far behind, at most kLargestDisorderS
  bool has_images = false;
  std::size_t image_offset = 0;         ///< in the file's bytes
  std::size_t image_bytes = 0;          ///< compressed, where the file is
  std::optional<ImageForm> image_form;  ///< empty without images, and where their frames are interleaved
  std::string image_orientation;        ///< of UltrasoundImageOrientation, as "MFA"; empty when it is not given

  /// Index into transform_names, or -1.
  int find(std::string_view transform) const;
};

/// Reads the header of a sequence file as PLUS, IGSIO and 3D Slicer write it: a MetaImage header with a line
/// `Seq_Frame0000_Field = value` for each field of each frame, or a NRRD header with `Seq_Frame0000_Field:=value`.
/// Of a frame it reads `...Transform` (16 numbers by rows), `...TransformStatus` (absent: unknown), `Timestamp` (of all
/// frames or of none), `Buttons`, `Distortion`, `Rejected` and `Actions` (Insonate's own, which others skip); of the
/// header the fields that give size, kind and orientation, and `...Transform` fields. It skips all else that is well
/// formed, images too: they are only checked to be there. Frames that stand at most kLargestDisorderS behind a later
/// one are sorted by their times. `file` names the file in messages.
///
/// A pure function of the bytes. Takes memory and time in proportion to them, whatever they claim. Throws InputError
/// for whatever is truncated, malformed, contradictory, or a sequence of a kind that is not read here (a separate data
/// file, bzip2).
Sequence parse_sequence(std::string_view bytes, const std::string& file);
/// The same of a file whose header is in front, with some bytes of the images to either end (sequence_file.h).
Sequence parse_sequence(const CutBytes& bytes, const std::string& file);

/// A transform-only sequence file that parse_sequence and probe_samples read back to the same bits, under the name
/// ProbeToPatient. Of samples that are not ok the pose is not kept. Throws std::invalid_argument when there are none,
/// or when their times do not strictly rise or an ok pose is not rigid, as then nobody could read them back.
/// @param actions  SequenceFrame::actions by the samples' times
std::string write_sequence(const std::vector<PoseSample>& samples, const std::map<double, std::string>& actions = {});

/// The status words of IGSIO's writers ("OK", "OUT_OF_VIEW", "SWITCH1_IS_ON"...); any case, and with the prefixes of
/// older versions ("TOOL_MISSING"). A word nobody knows is PoseStatus::unknown.
PoseStatus status_from_igsio(std::string_view word);

}  // namespace insonate
