#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/cases/import_case.h"
#include "sim/volume/case.h"

namespace insonate {

/// The commands of insonate-case, one function each. All throw InputError.

/// Prints the content of a case, CT file or DICOM folder, as text or as JSON.
void inspect(const std::filesystem::path& path, bool json);

/// Builds a phantom and writes it as a case.
/// @param recipe   the recipe of the built-in abdomen if empty
/// @param replace  write over a case that is there already
void make_and_write(std::filesystem::path recipe, const std::vector<std::string>& settings,
                    const std::filesystem::path& folder, bool replace);

/// Imports a patient and writes the case.
/// @param replace  overwrites an existing case in the folder, including an expert's additions
void import_and_write(ImportRequest request, const std::filesystem::path& folder, bool replace);

/// A time in a recorded log.
struct RecordedMoment {
  std::filesystem::path log;  ///< a PLUS/IGSIO sequence file
  double at_s = 0;            ///< seconds after the log's first frame
  std::string transform;      ///< name of the transform, as for probe_samples()
};

/// Adds a view whose pose comes from either a pose file or a log; see add_view().
void add_recorded_view(const std::filesystem::path& folder, ReferenceView view, const std::string& pose_file,
                       const RecordedMoment& moment);

/// The names of the sides, in the order of view::Side.
inline constexpr std::array<const char*, 6> kSideNames{"front", "back", "right", "left", "head", "feet"};

/// A picture of a patient in 3D.
struct PatientPicture {
  std::string subject;        ///< as open_subject() takes it
  std::string look = "Skin";  ///< view::kSurfaces, the name of a bundled transfer function, or a file of one (.toml)
  std::vector<std::string> structures;  ///< labels of the case whose surfaces are drawn within the CT
  std::string view;  ///< a reference view of the case, whose ultrasound is shown in its place; empty: none
  std::string from;  ///< one of kSideNames; empty: towards the view's plane, else obliquely from the front
  double turn_deg = 0, tilt_deg = 0;  ///< turn the patient from there: about the long axis, and the head to the viewer
  bool cut = false;                   ///< removes what lies between the camera and the plane
  int width = 800, height = 600;
  std::string out;  ///< PNG
};
/// Draws the patient by direct volume rendering. Throws InputError.
void draw_patient(const PatientPicture& picture);

/// A scattering volume (sim/acoustics/speckle_volume.h) of a case, from one of its views.
struct SpeckleRequest {
  std::string subject;     ///< as open_subject() takes it
  std::string view;        ///< empty: the first
  std::string transducer;  ///< a file as in assets/transducers; empty: the one that stands for the view's probe
  std::uint32_t seed = 1;
  double voxel_mm = 0.25, thickness_mm = 20;
  std::string out;  ///< NRRD
};
/// Computes it by all processors, and writes it atomically. Shows progress and the time left. A run that was killed
/// goes on where it was, if it is asked for the same again. Throws InputError.
void compute_speckle(const SpeckleRequest& request);

}  // namespace insonate
