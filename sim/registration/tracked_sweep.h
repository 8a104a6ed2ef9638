#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"

namespace insonate {

/// One image of a tracked sweep.
struct SweepImage {
  Pose sweep_from_probe;  ///< where the tracker saw the probe, in the frame of the recording
  Image<float> grey;      ///< on image_geometry() of the sweep's probe and depth; NaN where nothing is known
};

/// A tracked ultrasound sweep: images of one probe, and where they lie to each other. The frame of the sweep is that in
/// which the recording gives the probe's poses. Registration finds where that frame lies in a CT.
struct TrackedSweep {
  Probe probe;
  double depth_mm = 160;
  std::vector<SweepImage> images;  ///< at least one; all of one size
};

/// Returns points that cover what the sweep's fans show, in the sweep's frame, mm: 5 x 5 points per image, from face to
/// depth and from edge to edge.
std::vector<glm::dvec3> target_points(const TrackedSweep& sweep);

/// Returns how far apart the images of a sweep lie at most: the largest root mean square distance of two fans, mm.
double spread_mm(const TrackedSweep& sweep);

/// Returns the root mean square distance, mm, between what two maps make of points: the target registration error if
/// one of them is the truth and the points are target_points().
double target_error_mm(const std::vector<glm::dvec3>& points, const glm::dmat4& one, const glm::dmat4& other);

/// Returns the mean of p p^T over points p = (x, y, z, 1), mm: all that their root mean square distance depends on.
glm::dmat4 moments_of(const std::vector<glm::dvec3>& points);
/// Returns the same from moments_of() the points, however many they are.
double target_error_mm(const glm::dmat4& moments, const glm::dmat4& one, const glm::dmat4& other);

/// Returns an image on another geometry: the mean of the known pixels around each place, weighted by a Gaussian as wide
/// as the coarser of both pixels. NaN where fewer than half of the weights lie on known pixels.
/// @param pixel_from_plane  maps (x, y, 1) of the probe's plane, mm, to a column and a row of `image`
/// @param geometry          of the result
Image<float> resampled(const Image<float>& image, const glm::dmat3& pixel_from_plane, const ImageGeometry& geometry);

/// Returns the sum of squares by which an image's known pixels differ from their mean, between a fifth and three fifths
/// of its rows. A probe in the air shows nothing there: its own ringing lies above, its noise below.
double variation_in_depth(const Image<float>& grey);

/// Returns a sweep with fewer and smaller images: `count` of them, evenly spread, or all if there are not more.
/// @param width, height  pixels, 8 or more
TrackedSweep reduced(const TrackedSweep& sweep, int count, int width, int height);

}  // namespace insonate
