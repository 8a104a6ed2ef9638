#pragma once

#include <map>
#include <string>

namespace insonate {

/// What a recorded scan's samples were made from, so that a score can name it.
struct Recording {
  std::string file;                         ///< name without the folder
  std::string digest;                       ///< of the very bytes that were parsed (sim/core/digest.h)
  std::string transform;                    ///< the one that was taken for the probe's: "ProbeToPatient"
  std::map<double, std::string> actions{};  ///< of the frames that have some, by their time; see SequenceFrame
  bool of_sensor = false;  ///< the samples are a sensor's poses in its tracker's frame, not the probe's in the patient
};

}  // namespace insonate
