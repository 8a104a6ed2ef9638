#pragma once

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <string>

#include "sim/core/image.h"
#include "sim/truth/picture_truth.h"
#include "tools/dataset/shots.h"

namespace insonate {

/// An image of a dataset with its truth. Images are as clinics show them: the probe's marker on the left.
struct DatasetImage {
  Shot shot;
  Image<std::uint8_t> grey;
  PictureTruth truth;
  glm::dmat4 patient_from_pixel{1.0};  ///< from (column, row, 0, 1) to patient mm
  std::string settings;                ///< all fields of Settings as one JSON object
  std::string digest;                  ///< of all of the above (sim/files/digest.h)
};

/// Adds the truth to a picture and turns both as they are shown.
/// @param grey  columns towards the marker
DatasetImage with_truth(Shot&& shot, const Image<std::uint8_t>& grey, TruthMaker& truth);

}  // namespace insonate
