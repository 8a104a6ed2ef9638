#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/probe/probe.h"
#include "sim/registration/echo_seen.h"
#include "sim/registration/find_fan.h"
#include "sim/registration/tracked_sweep.h"

namespace insonate {

/// As many images of a recording are searched for a fan; if it has more, they are evenly spread over it.
inline constexpr std::size_t kMaxSearchedForFan = 24;

/// How a recording of tracked ultrasound is read.
struct SweepInput {
  std::string file;
  std::string transform;                       ///< RecordingOptions::transform
  std::optional<glm::dmat4> probe_from_pixel;  ///< in place of the recording's own ImageToProbe
  std::optional<glm::dvec2> face_pixel;        ///< where the middle of the probe's face lies in the images
  std::optional<std::array<int, 4>> clip;      ///< x, y, width, height of the part that is used, pixels
  std::optional<Image<std::uint8_t>> mask;     ///< of the images' size: pixels of 0 are not used
  std::string mask_file;                       ///< that of the mask, for error messages
  std::optional<Probe> probe;                  ///< whose fan the images show; empty: found from the images
  std::optional<double> depth_mm;              ///< empty: that of the probe
  std::optional<std::vector<Pose>> poses;      ///< one per image, of a file that has none: sweep_from_probe
  int slices = 20;                             ///< images that are used, evenly spread over the recording
  int width = 128, height = 96;
};

/// A recording, as it is registered.
struct ReadSweep {
  TrackedSweep sweep;
  std::optional<FoundFan> fan;  ///< where the probe was found from the images
  std::string found_in_volume;  ///< probe and planes as read_volume_sweep() found them, for the user; else empty
  std::string transform;        ///< that gave the probe's poses: "ProbeToPatient"; empty where no transform did
  std::size_t frames = 0;       ///< of the recording
  std::size_t left_out = 0;     ///< frames without a usable pose
  double share_at_ends = 0;     ///< of the pixels, left out by leave_out_ends()
};

/// Returns whether read_sweep() reads a file by read_dicom_sweep(). Throws InputError for a file whose name ends in
/// .dcm and that is not DICOM.
bool is_dicom_sweep(const std::string& file);

/// Reads images and poses, of a DICOM file by read_dicom_sweep(). The frame of each pose is that of the fan: its origin
/// is the middle of the probe's face, x runs along the rows of the images, and y along their columns. Without
/// `face_pixel` it is where the found fan has its face, or, with a given probe, where the probe's frame has its origin,
/// as in recordings of Insonate. Throws InputError if the recording has no images or fewer than two with a pose, if its
/// images are not placed, if there is no fan in them, or if they are of one grey level.
ReadSweep read_sweep(const SweepInput& input);

/// Adds what is found from images to an input without a probe: probe, depth, and where they are not given the face's
/// pixel and the clip. Throws InputError, which names `input.file`, if the images show no fan.
FoundFan find_probe_in(const EchoSeen& seen, const glm::dmat4& probe_from_pixel, SweepInput& input);

/// How an image lies to the fan that it shows.
struct ImagePlacement {
  Pose probe_from_fan;
  glm::dmat3 pixel_from_plane;  ///< maps (x, y, 1) of the fan's plane, mm, to a column and a row
};
/// Returns the size of a pixel along the rows and the columns, mm.
glm::dvec2 pixel_size(const glm::dmat4& probe_from_pixel);

/// Throws InputError if the middle of the probe's face is neither given nor in the image.
ImagePlacement placement_of(const glm::dmat4& probe_from_pixel, const SweepInput& input);

/// Returns an image on the pixels of the fan, with its pose. Throws what placement_of() throws, and InputError if the
/// clip is not within the image.
/// @param input  with a probe
SweepImage place_image(const Image<std::uint8_t>& grey, const Pose& sweep_from_probe,
                       const glm::dmat4& probe_from_pixel, const SweepInput& input);

/// Throws InputError, which names `file`, unless the images show the fan and something in it.
/// @param least_shown  share of the fan whose pixels are known
void check_shows_fan(const std::string& file, const TrackedSweep& sweep, double least_shown = 0.5);

/// Leaves out the pixels whose points have no label: only those inside the labels are compared. Removes images that
/// have no pixel left. Throws InputError, which names `file`, if fewer than two images are left.
/// @param labels  in the sweep's frame
void keep_labelled(TrackedSweep& sweep, const Volume<std::uint8_t>& labels, const std::string& file);

/// Leaves out the pixels that lie where the CT cuts the body at head or feet at the start, or beyond: there is nothing
/// to compare them with. Insonate's own recordings are black there, and the search would match that edge to the CT's
/// end. Images of which nothing is left are left out. Returns the share of the pixels that was left out.
double leave_out_ends(TrackedSweep& sweep, const Volume<std::int16_t>& ct, const glm::dmat4& ct_from_sweep);

/// Reads a probe from a TOML file: kind ("curvilinear", "linear" or "phased"), radius_mm and field_of_view_deg or
/// width_mm as in Probe, and depth_mm. Throws InputError.
Probe read_probe(const std::string& file);

}  // namespace insonate
