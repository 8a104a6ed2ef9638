#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"
#include "sim/tissue/tissue.h"
#include "sim/tissue/transmission.h"
#include "sim/volume/case.h"

namespace insonate {

/// Whether sound reaches a pixel.
enum class Reach : std::uint8_t {
  outside = 0,   ///< the pixel is outside the fan
  shadowed = 1,  ///< in the fan, but too little sound arrives
  arrives = 2    ///< its one-way transmission is at least kArrivingShare of that through soft tissue alone
};

/// What is known of a picture besides its grey. The images have the picture's size and order of columns, which run
/// towards the probe's marker.
struct PictureTruth {
  Image<std::uint8_t> label;          ///< the value of the voxel nearest to the pixel; 0: no structure, outside the fan
  Image<std::uint8_t> visible_label;  ///< the same where the sound arrives, else 0
  Image<std::uint8_t> reach;          ///< Reach
  /// Per scan line, the distance from the face along the line to the skin, mm. Negative where the face is pressed in:
  /// then it is the distance back to the skin. NaN where the line does not meet the skin within the imaging depth.
  std::vector<float> skin_mm;
};

/// Computes PictureTruth on the CPU in double precision, so that it does not depend on a graphics card. Sound is
/// traversed on the probe's own lines, every kSampleDistance_mm, through the CT alone (Transmission).
///
///     TruthMaker truth(subject, tissues);
///     truth.set_view(probe, depth_mm, settings);
///     const PictureTruth known = truth.at(patient_from_probe);
class TruthMaker {
public:
  static constexpr double kSampleDistance_mm = 0.6;  ///< model S's default reflection length

  /// Keeps references to both. A case without labels has label 0 everywhere.
  TruthMaker(const Case& subject, const TissueTable& tissues);

  /// Sets the probe of the following pictures. It uses three settings: the picture's size, the frequency and the gel.
  /// Does nothing if none of these changes.
  /// @param depth_mm  0.1 to 1000
  void set_view(const Probe& probe, double depth_mm, const Settings& settings);

  /// Call set_view() before it.
  PictureTruth at(const Pose& patient_from_probe) const;

private:
  struct View {
    Probe probe;
    double depth_mm = 0, frequency_mhz = 0, gel_mm = 0;
    int width = 0, height = 0;
    bool operator==(const View&) const = default;
  };
  /// A pixel inside the fan, and the place in a table of lines by samples that is nearest to it.
  struct Pixel {
    std::int32_t x, y;
    std::uint32_t place;
  };
  std::vector<float> skin_along_lines(const Pose& patient_from_probe) const;

  const Case* case_;
  const TissueTable* tissues_;
  View view_;
  ImageGeometry geometry_;
  ScanLines lines_;
  std::vector<Pixel> pixels_;
  std::vector<double> least_intensity_;  ///< per sample
  std::optional<Transmission> transmission_;
};

/// Returns the affine map from (column, row, 0, 1) of a picture, whose columns run towards the marker, to patient mm.
glm::dmat4 patient_from_pixel(const ImageGeometry& geometry, const Pose& patient_from_probe);

}  // namespace insonate
