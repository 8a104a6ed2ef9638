#pragma once

#include <glm/mat4x4.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/registration/minimise.h"
#include "sim/registration/motion.h"
#include "sim/registration/similarity.h"
#include "sim/registration/tracked_sweep.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/wein/wein_settings.h"

namespace insonate {

/// Returns model W's settings for registration: its defaults, and patches of 8 x 8 pixels. Attenuation, shadows and the
/// gain change an image's brightness over its depth, so one linear relation does not hold for all of it.
inline WeinSettings registration_settings() {
  WeinSettings settings;
  settings.similarity_patch = 8;
  return settings;
}

/// How a sweep is registered.
struct RegistrationSettings {
  Measure measure = Measure::lc2;
  Freedom freedom = Freedom::rigid;
  WeinSettings wein = registration_settings();  ///< of the finest stage; the image's size is not used

  double search_mm = 30;   ///< how far the start may be off, 0 (search from the start alone) to 200
  double search_deg = 25;  ///< likewise, 0 to 90
  int scattered = 2000;    ///< places at which a round begins, 1 to 100000
  int followed = 16;       ///< the best of them, from which local searches start, 1 to 64
  int rounds = 8;          ///< most repetitions of that with other places, 2 to 100; see SweepRegistrar
  int wide_slices = 12;    ///< images of the widest stage, 1 to 1000; four of them sort the places out
  int slices = 20;         ///< images of the finer stages, 1 to 1000

  int batch = 512;  ///< most places per call of the similarity, 1 to 4096: bounds memory, and how long a call takes
  std::function<void()> between_calls;  ///< called before each; may wait, and ends the search by an exception
};

/// Images that lie closer together than this, by spread_mm(), can be most similar at a wrong place, and no measure of
/// the similarity shows it. So no registration of them counts as converged.
inline constexpr double kMinSpread_mm = 25;
inline constexpr const char* kTooClose =
    "the images lie too close together to tell one place from another";  ///< a doubt
/// With fewer images a wrong place a few mm away can be the most similar, and no measure of the similarity shows it
/// either.
inline constexpr std::size_t kMinImages = 8;
inline constexpr const char* kTooFew = "fewer than 8 images were compared";                ///< a doubt
inline constexpr const char* kNotSearched = "no wide search has looked for other places";  ///< a doubt

/// One evaluation of the similarity.
struct Evaluation {
  int stage = 0;  ///< index into kStages
  Parameters at;  ///< of SweepRegistration::motion, mm
  double similarity = 0;
};

/// The stages of a registration, from coarse to fine, and then what is similar by chance.
inline constexpr std::array<const char*, 6> kStages{"scatter", "wide", "fine", "look", "affine", "elsewhere"};

/// The result of a registration.
struct SweepRegistration {
  Motion motion;                  ///< with the start as its origin
  Parameters at;                  ///< where the search ended
  glm::dmat4 ct_from_sweep{1.0};  ///< the map there
  double similarity_before = 0, similarity_after = 0;
  double runner_up = 0;  ///< highest similarity of the fine stage's ends that are another place, 8 mm or more away;
                         ///< from 0.9 times the best on, none from which the way leads up to it; 0 if there is none
  double elsewhere = 0;  ///< LC2 that one in ten places exceeds, 20 mm and more away from the end; 0 otherwise
  std::vector<std::string> doubts;      ///< why it did not converge, as parts of sentences; empty if it did
  std::vector<double> deviation;        ///< standard deviation of each parameter, mm; see uncertainty.h
  double expected_error_mm = 0;         ///< root mean square over the target points, from the parameters' covariance
  std::vector<Evaluation> evaluations;  ///< all of them, in their order
  double seconds = 0;                   ///< of the search

  bool converged() const { return doubts.empty(); }
};

/// Registers one sweep with one CT, from any number of starts. In the widest stage it evaluates places that are
/// scattered over the search range, with small images in a CT of large voxels, and follows the best by local searches.
/// The finer stages go on from the best ends with the images as they are. That is repeated with other places until two
/// rounds have found the best end, and no other end is nearly as similar. At last the halves of the images look around
/// that end in turn for a higher one: one basin may hold several. With a search range of 0, local searches from the
/// start alone go through the same stages; they never end at a lower similarity than the start's.
///
/// LC2 needs an OpenGL context that is current at every use.
class SweepRegistrar {
public:
  /// Prepares the similarities, which takes longer than one search from the start alone. Throws what they throw.
  /// @param volume  must outlive the registrar
  SweepRegistrar(const AcousticVolume& volume, const TrackedSweep& sweep, const RegistrationSettings& settings);
  SweepRegistrar(const SweepRegistrar&) = delete;  // similarities refer to its members
  SweepRegistrar& operator=(const SweepRegistrar&) = delete;

  /// Replaces the sweep's images, whose probe and depth stay. Images of another size are resampled to that of the
  /// first.
  void set_images(std::span<const SweepImage> images);
  /// Replaces RegistrationSettings::search_mm, search_deg and scattered.
  void set_range(double search_mm, double search_deg, int scattered);

  /// Registers from a start.
  /// @param start  ct_from_sweep
  SweepRegistration from(const glm::dmat4& start);

  double seconds_to_prepare() const { return seconds_to_prepare_; }

private:
  RegistrationSettings settings_;
  std::vector<glm::dvec3> targets_;
  AcousticVolume wide_volume_;  // the CT with fewer voxels, for the widest stage
  TrackedSweep compared_;       // the fine stage's images
  std::unique_ptr<Similarity> scatter_, wide_, fine_;
  double seconds_to_prepare_ = 0;
};

}  // namespace insonate
