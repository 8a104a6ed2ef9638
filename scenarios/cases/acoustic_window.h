#pragma once

#include <optional>
#include <vector>

#include "scenarios/cases/body.h"
#include "sim/tissue/transmission.h"
#include "sim/volume/case.h"

namespace insonate {

/// A picture to search for. Its plane contains `aim`, within 20 degrees of the central beam.
struct WantedPicture {
  glm::dvec3 aim{0.0};       ///< patient, mm; inside the body
  glm::dvec3 axis{0, 0, 1};  ///< unit
  bool along = true;  ///< true: the plane contains the axis; false: it is perpendicular to it, to within 20 degrees
  std::vector<std::uint8_t> targets;  ///< label values; each of them counts, and the last one determines the depth
};

/// A place on the skin that gives a view of the targets.
struct Window {
  Pose patient_from_probe;
  double depth_mm = 0;       ///< to the deepest visible point of the last target
  double clear_share = 0;    ///< share of the targets' area in the fan that sound reaches as through soft tissue
  double section_share = 0;  ///< share of the targets' whole section in this plane that is in the fan and clear
};

/// Searches the skin of a supine patient for the place whose picture shows most of its targets. It computes the model's
/// own transmission on the CPU. Keeps references to the case and the body.
///
/// The search tries beams through the aim every 5 degrees within the plane's freedom, then finer steps around the best
/// ones. For each beam, the ray from the aim outwards gives the point where it first leaves the body. The face is
/// pressed in there as far as no bone prevents it, up to 12 mm. A place is refused in these cases: the CT ends before
/// the skin, the patient lies on it (more than 30 degrees to the back), it is beyond 50 degrees to head or feet, or the
/// face has no room in front of the skin.
///
/// Each sample of the fan in a target is weighted by the arriving intensity relative to the same thickness of liver:
/// fully if equal, not at all from 20 dB less. The rating is the weighted area of the target that shows least. It is
/// reduced for targets off the middle and for deep targets.
class WindowSearch {
public:
  WindowSearch(const Case& subject, const BodyMask& body, const TissueTable& tissues, const Probe& probe);

  /// Returns the best place, or nothing if no place on the skin shows any of the targets. The result does not depend on
  /// the number of threads.
  std::optional<Window> best(const WantedPicture& wanted) const;

private:
  struct Choice;
  struct View;
  std::optional<Pose> place(const WantedPicture& wanted, const Choice& choice) const;
  View look(const WantedPicture& wanted, const Pose& pose) const;
  void rate(const WantedPicture& wanted, std::vector<Choice>& choices) const;
  std::optional<glm::dvec3> skin_from(const glm::dvec3& aim, const glm::dvec3& outwards) const;
  bool face_fits(const Pose& pose, double press_mm) const;
  double section_mm2(const WantedPicture& wanted, const Pose& pose) const;

  const Case* subject_;
  const BodyMask* body_;
  Probe probe_;
  Transmission transmission_;
  double soft_tissue_db_per_mm_;  ///< one-way, at the probe's frequency
};

}  // namespace insonate
