#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/session.h"

namespace insonate {

/// What a teacher beside the bed would say now.
struct Guiding {
  const ReferenceView* view = nullptr;  ///< that is looked for; of the session's case, or the guide's own
  std::vector<std::string> advice;      ///< what to do next, in its order; empty when the view is there, or no probe
  double plane_distance_mm = 0;         ///< between the middles of the two pictures, along the reference's normal
  double plane_angle_deg = 0;
  bool there = false;
};

/// Help for practice, off until it is asked for: the way to one of the patient's reference views. While a scenario runs
/// it leads to the view that the step asks for. There is none of it under strict rules.
class Guide {
public:
  /// While a scenario runs: turns it on or off. Else turns to the next of the patient's views, those of the scenario's
  /// steps first and those that were made since last, and off behind the last one.
  void next(const Session& session);

  /// Empty under strict rules, while it is off, when the step asks for no view, and before the first pose.
  std::optional<Guiding> now(const Session& session) const;

  /// A view that was made of the patient after the case was read.
  void add(const ReferenceView& made) { made_.push_back(made); }
  /// Another patient is there, or the same one read again.
  void forget_made() { made_.clear(); }

private:
  const ReferenceView* find_view(const LoadedCase& loaded_case, const std::string& name) const;
  std::vector<std::string> names(const LoadedCase& loaded_case) const;
  static const std::string* view_of_step(const Session& session);

  bool in_run_ = false;              ///< on while a scenario runs
  std::string view_;                 ///< without one; empty: off
  std::vector<ReferenceView> made_;  ///< the case has none of their names
};

}  // namespace insonate
