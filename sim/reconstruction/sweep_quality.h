#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "sim/reconstruction/tracked_picture.h"

namespace insonate {

/// What a sweep is measured against.
struct SweepLimits {
  /// The largest distance between neighbouring pictures at which no tissue is missed, mm, above 0: the larger of the
  /// beam's width along the elevation and the voxel size.
  double spacing_mm = 2;
  double hole_radius_mm = 2;  ///< ReconstructionSettings::hole_radius_mm
};

/// The motion from one picture to the next.
struct SweepStep {
  double time_s = 0;      ///< of the later picture, since the first one
  double duration_s = 0;  ///< between the pictures
  double advance_mm = 0;  ///< of the region's middle along the picture's normal; below 0 against the sweep's direction
  /// The largest distance between the pictures, over the outline of the region and along the normal. In a fan that
  /// tilts it is that at the deepest point.
  double spacing_mm = 0;

  double speed_mm_s() const { return duration_s > 0 ? spacing_mm / duration_s : 0; }
};

/// A part of a sweep that is worth a remark.
struct SweepFlaw {
  enum class Kind {
    too_fast,     ///< pictures came at their usual rate, but too far from each other
    gap,          ///< pictures are missing, or are farther from each other than holes are filled
    turned_back,  ///< the hand moved against the sweep's direction
  };
  Kind kind = Kind::gap;
  double begin_s = 0, end_s = 0;  ///< since the first picture
  double at_mm = 0;               ///< where it begins, along the sweep
  double size_mm = 0;             ///< the largest spacing in it; turned back: how far

  /// Returns the flaw in words: "too fast between 3.2 s and 4.0 s", "too fast at 3.2 s", "gap of 6.0 mm at 41 mm",
  /// "turned back by 4 mm between 5.1 s and 5.9 s".
  std::string words() const;
};

/// The quality of a sweep by hand, from its pictures' poses and times.
struct SweepQuality {
  std::size_t pictures = 0;
  double duration_s = 0;
  double length_mm = 0;  ///< of the way of the region's middle along the normals, forwards alone
  /// How far the region's middle came away from its first place within that picture's plane. A change of depth or
  /// probe begins anew.
  double slid_mm = 0;
  double picture_hz = 0;          ///< from the median time between pictures; 0 for fewer than two
  double largest_spacing_mm = 0;  ///< over all steps
  double fastest_mm_s = 0;        ///< at the point where the speed is largest
  std::vector<SweepStep> steps;   ///< pictures - 1
  std::vector<SweepFlaw> flaws;   ///< in the order of time

  bool is_good() const { return pictures > 1 && flaws.empty() && !is_along(); }
  /// Returns whether the pictures moved in their own plane rather than across it: the probe slid along, or rocked.
  bool is_along() const { return slid_mm > 10 && slid_mm > 2 * length_mm; }
  /// Returns a sentence: what was swept, and how evenly. A second one says what to do if it is_along().
  std::string verdict() const;
};

/// Measures a sweep one picture at a time, so that its quality can be shown during it.
class SweepMeter {
public:
  explicit SweepMeter(const SweepLimits& limits) : limits_(limits) {}

  /// Adds the next picture, of which the pixels are not used.
  void add(const TrackedPicture& picture);
  /// Returns the quality of the pictures so far.
  SweepQuality quality() const;

private:
  SweepLimits limits_;
  std::size_t pictures_ = 0;
  double begin_s_ = 0, last_s_ = 0;
  glm::dmat4 first_from_pixel_{1.0}, last_from_pixel_{1.0};  ///< patient from the pixels of the first and last picture
  std::shared_ptr<const PictureRegion> first_region_;
  double slid_mm_ = 0;
  std::vector<SweepStep> steps_;  ///< advance_mm as the picture's normal points
};

/// Returns the quality of a whole sweep.
SweepQuality sweep_quality(std::span<const TrackedPicture> pictures, const SweepLimits& limits);

}  // namespace insonate
