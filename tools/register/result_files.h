#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/registration/free_form.h"
#include "sim/registration/registration.h"
#include "tools/register/comparison_pictures.h"
#include "tools/register/read_sweep.h"

namespace insonate {

/// Everything that the files about a registration describe.
struct RegistrationReport {
  std::string ct, recording;  ///< as the user named them
  const ReadSweep& input;
  const RegistrationSettings& settings;
  const SweepRegistration& found;
  std::vector<ComparisonPictures> pictures;
  const FreeFormRegistration* free_form = nullptr;  ///< of the sweep, before found.ct_from_sweep; null: not asked for
  const FreeFormSettings* free_form_settings = nullptr;  ///< of free_form
  std::string command{};                                 ///< the arguments that asked for it; empty for a live one
  std::optional<double> landmark_error_mm{};             ///< of the start, if landmarks gave it
  std::string device{};                                  ///< OpenGL's, that computed it

  /// Returns the deformation that belongs to the result; null if there is none.
  const FreeFormField* deformation() const {
    return free_form && free_form->is_improved() ? &free_form->field : nullptr;
  }
};

/// Returns the verdict in one sentence: "Converged: ..." or "Not converged: ...".
std::string verdict(const SweepRegistration& found);

/// Returns the verdict, and how the deformation ended if one was asked for.
std::string verdict(const RegistrationReport& report);

/// Returns the transforms in both directions, the verdict, the uncertainty, the settings and the similarities as JSON;
/// and what it takes to repeat the registration: the arguments, this build, and the digests of the files that the
/// recording and the CT are named by, which are not those of a folder.
std::string registration_json(const RegistrationReport& report);

/// Returns every evaluation as CSV: number, stage, similarity and the parameters in mm. Those of a deformation have the
/// stages "free-form vary" and "free-form step", the bending energy in mm^-2, and no parameters.
std::string evaluations_csv(const RegistrationReport& report);

/// Returns the page about a registration. Its pictures lie beside it.
std::string registration_page(const RegistrationReport& report);

/// Returns a scene of 3D Slicer: ct.nrrd, and sweep.nrrd behind the transform of sweep_from_ct.tfm, or of
/// sweep_from_ct.nrrd if it is deformed. Slicer reads an ITK transform as the map from the parent's points, which here
/// are the CT's.
std::string slicer_scene(const std::string& verdict, bool is_deformed);

/// Writes everything about a registration into a new folder, whole or not at all: registration.json, the transforms,
/// evaluations.csv, index.html with its pictures, and the scene with its volumes. With a deformation the .tfm files
/// hold the affine part alone and the .h5 files the whole maps, as do ct_from_sweep.nrrd and sweep_from_ct.nrrd, which
/// are then written too. Throws InputError if it cannot be written or exists, and std::bad_alloc.
void write_registration(const std::filesystem::path& folder, RegistrationReport report, const Volume<std::int16_t>& ct);

/// Returns the sweep as a volume of grey levels in its own frame.
Volume<std::uint8_t> volume_of(const TrackedSweep& sweep);

}  // namespace insonate
