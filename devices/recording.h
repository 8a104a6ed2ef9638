#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace insonate {

/// What the reader repaired in a recording that another program wrote.
struct RecordingRepairs {
  std::size_t rounded_rotations = 0;    ///< frames whose rotation was replaced by the nearest valid rotation
  double worst_rotation_error = 0;      ///< the largest orthonormal_error() among them
  std::size_t frames_out_of_order = 0;  ///< frames that stood behind a later one and were sorted in
  double worst_disorder_s = 0;          ///< the largest distance behind a later frame among them

  bool any() const { return rounded_rotations > 0 || frames_out_of_order > 0; }
};

/// Provenance of a recorded scan's samples, so that a score can name it.
struct Recording {
  std::string file;                         ///< file name without the folder
  std::string digest;                       ///< digest of exactly the bytes that were parsed (sim/files/digest.h)
  std::string transform;                    ///< the transform that was taken for the probe's: "ProbeToPatient"
  std::map<double, std::string> actions{};  ///< actions by frame time, for frames that have some; see SequenceFrame
  bool of_sensor = false;  ///< true: the poses are a sensor's in its tracker's frame, not the probe's in the patient
  RecordingRepairs repairs{};
  /// Rate in Hz from which frames without times got their times. Empty if the frames have times of their own.
  std::optional<double> assumed_rate_hz{};
};

}  // namespace insonate
