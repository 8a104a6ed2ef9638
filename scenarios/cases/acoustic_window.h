#pragma once

#include <optional>
#include <vector>

#include "scenarios/cases/body.h"
#include "sim/model/transmission.h"
#include "sim/volume/case.h"

namespace insonate {

/// A picture to look for: its plane goes through `aim`, within 20 degrees of the central beam.
struct WantedPicture {
  glm::dvec3 aim{0.0};                ///< patient, mm; inside the body
  glm::dvec3 axis{0, 0, 1};           ///< unit
  bool along = true;                  ///< the plane holds the axis, or else is square to it, to within 20 degrees
  std::vector<std::uint8_t> targets;  ///< label values; each of them counts, and the last sets how deep is looked
};

/// A place on the skin from which a picture is had.
struct Window {
  Pose patient_from_probe;
  double depth_mm = 0;       ///< to the deepest that is seen of the last target
  double clear_share = 0;    ///< of the targets' area in the fan, that which sound reaches as through soft tissue
  double section_share = 0;  ///< of the targets' whole section in this plane, that which is in the fan and clear
};

/// Searches the skin of a patient who lies on the back for the place from which a picture shows the most of its
/// targets, by the model's own transmission on the processor. Keeps references.
///
/// Tried are beams through the aim every 5 degrees within the plane's freedom, then finer around the best. For each,
/// the ray from the aim outwards gives the point of the skin, where it first leaves the body; the face is pressed in
/// there by as much as no bone forbids, up to 12 mm. A place is refused where the CT ends before the skin, where the
/// patient lies on it (more than 30 degrees to the back), beyond 50 degrees to head or feet, and where the face has
/// no room in front of the skin.
///
/// A sample of the fan in a target counts by what arrives there against liver of the same thickness: wholly if as
/// much, not at all from 20 dB less. The rating is the area so counted, of the target that shows least, less for what
/// lies off the middle and what lies deep.
class WindowSearch {
public:
  WindowSearch(const Case& subject, const BodyMask& body, const TissueTable& tissues, const Probe& probe);

  /// Empty when no place on the skin shows anything of the targets. The same whatever the number of threads.
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
  double soft_tissue_db_per_mm_;  ///< one way, at the probe's frequency
};

}  // namespace insonate
