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
#include "sim/core/probe_sample.h"

namespace insonate {

/// A transform of one frame of a sequence file. `AToB` maps points of frame A to frame B, mm.
struct SequenceTransform {
  int name = 0;  ///< index into Sequence::transform_names
  PoseStatus status = PoseStatus::unknown;
  glm::dmat4 matrix{0.0};  ///< finite if status is ok, not necessarily rigid; otherwise zero
};

/// One frame of a sequence file.
struct SequenceFrame {
  std::size_t number = 0;                     ///< number of the frame and its image in the file, from 0
  double time_s = 0;                          ///< the file's Timestamp: since some start or since 1970; 0 without one
  std::uint32_t buttons = 0;                  ///< bit b is set while button b is held
  std::optional<std::uint32_t> distortion;    ///< the tracker's distortion grade, if it gave one
  Rejection rejected = Rejection::none;       ///< why a filter removed the pose, if one did
  std::vector<SequenceTransform> transforms;  ///< in no particular order, without duplicates
  std::string actions;  ///< what was done besides moving since the previous frame, in the recording program's words

  const SequenceTransform* find(int name) const;
};

/// Largest delay of a frame behind a later one. Writers that take poses and images from two threads swap them by less
/// than a frame; a larger step back means that a clock was set.
inline constexpr double kLargestDisorder_s = 0.05;

/// The frames of an IGSIO/PLUS sequence file (.igs.mha, .seq.mha, .seq.nrrd). The images stay in the file
/// (recorded_images.h reads them).
struct Sequence {
  std::string file;                             ///< for error messages
  std::vector<std::string> transform_names;     ///< of all frames, without "Transform": "ProbeToTracker"
  std::map<std::string, glm::dmat4> constants;  ///< transforms in the header, which hold for all frames; finite
  std::vector<SequenceFrame> frames;            ///< at least one; times finite and strictly rising
  bool has_times = true;                        ///< false: no frame has a Timestamp; the frames are in the file's order
  std::size_t frames_out_of_order = 0;          ///< frames that stood behind a later one and were sorted by time
  double worst_disorder_s = 0;                  ///< the largest such delay, at most kLargestDisorder_s
  bool has_images = false;
  std::size_t image_offset = 0;         ///< offset in the file's bytes
  std::size_t image_bytes = 0;          ///< compressed size if the file is compressed
  std::optional<ImageForm> image_form;  ///< SequenceLayout::form
  std::string image_orientation;        ///< value of UltrasoundImageOrientation, such as "MFA"; empty if it is missing

  /// Returns the index into transform_names, or -1.
  int find(std::string_view transform) const;
};

/// Parses a sequence file as PLUS, IGSIO and 3D Slicer write it. It has a MetaImage header with a line
/// `Seq_Frame0000_Field = value` for each field of each frame, or a NRRD header with `Seq_Frame0000_Field:=value`. For
/// a frame it reads `...Transform` (16 numbers by rows), `...TransformStatus` (default: unknown), `Timestamp` (of all
/// frames or of none), `Buttons`, `Distortion`, `Rejected` and `Actions` (Insonate's own, which other readers skip). In
/// the header it reads the fields for size, kind and orientation, and `...Transform` fields. It skips everything else
/// that is well formed, including images: it only checks that they are present. Frames that stand at most
/// kLargestDisorder_s behind a later one are sorted by time. `file` names the file in error messages.
///
/// A pure function of the bytes. Memory and time are proportional to the number of bytes, whatever sizes they claim.
/// Throws InputError if the file is truncated, malformed or contradictory, or is of an unsupported kind (a separate
/// data file, bzip2).
Sequence parse_sequence(std::string_view bytes, const std::string& file);
/// Does the same for a file whose `front` holds the header and whose ends hold some bytes of the images
/// (sequence_file.h).
Sequence parse_sequence(const CutBytes& bytes, const std::string& file);

/// Returns a transform-only sequence file that parse_sequence and probe_samples read back bit for bit, under the name
/// ProbeToPatient. The poses of samples that are not ok are not stored. Throws std::invalid_argument if there are no
/// samples, or if they could not be read back: their times do not strictly rise, or an ok pose is not rigid.
/// @param actions  SequenceFrame::actions by the samples' times
std::string write_sequence(const std::vector<ProbeSample>& samples, const std::map<double, std::string>& actions = {});

/// Converts a status word of IGSIO's writers ("OK", "OUT_OF_VIEW", "SWITCH1_IS_ON"...), in upper or lower case, and
/// with the prefixes of older versions ("TOOL_MISSING"). An unknown word gives PoseStatus::unknown.
PoseStatus status_from_igsio(std::string_view word);

}  // namespace insonate
