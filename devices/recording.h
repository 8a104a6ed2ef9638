#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace insonate {

/// What the reader mended in a recording that another program wrote.
struct RecordingRepairs {
  std::size_t rounded_rotations = 0;    ///< frames whose rotation was replaced by the nearest one
  double worst_rotation_error = 0;      ///< of those, orthonormal_error()
  std::size_t frames_out_of_order = 0;  ///< frames that stood behind a later one and were sorted in
  double worst_disorder_s = 0;          ///< of those, how far behind

  bool any() const { return rounded_rotations > 0 || frames_out_of_order > 0; }
};

/// What a recorded scan's samples were made from, so that a score can name it.
struct Recording {
  std::string file;                         ///< name without the folder
  std::string digest;                       ///< of the very bytes that were parsed (sim/core/digest.h)
  std::string transform;                    ///< the one that was taken for the probe's: "ProbeToPatient"
  std::map<double, std::string> actions{};  ///< of the frames that have some, by their time; see SequenceFrame
  bool of_sensor = false;  ///< the samples are a sensor's poses in its tracker's frame, not the probe's in the patient
  RecordingRepairs repairs{};
  /// Hz, by which frames without times were given some; empty where the frames have times of their own.
  std::optional<double> assumed_rate_hz{};
};

}  // namespace insonate
