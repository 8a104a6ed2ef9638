#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/session/session.h"

namespace insonate {

/// Guidance towards a reference view, as a teacher at the bedside would give it.
struct Guiding {
  const ReferenceView* view = nullptr;  ///< the view to find; belongs to the session's case or to the guide
  std::vector<std::string> advice;      ///< next movements, in order; empty if the reference is reached
  std::vector<std::string> keys;        ///< of each advice, such as "D"; empty unless the learner's hand has the probe
  bool slides = false;                  ///< whether the first advice is to slide
  /// Between the centres of the two pictures, along the reference's normal; in a step, as the step measures it.
  double plane_distance_mm = 0;
  double plane_angle_deg = 0;
  bool there = false;  ///< the step's tolerances are met, or without a step the view is reached
};

/// Guides the learner to one of the patient's reference views during practice; off by default. While a scenario runs,
/// it leads to the view that the step asks for. Strict rules disable it.
class Guide {
public:
  /// While a scenario runs: turns the guide on or off. Otherwise: selects the patient's next view, first those of the
  /// scenario's steps, then the case's, then those authored since. After the last view the guide is off.
  void next(const Session& session);
  /// Returns whether there is a view to lead to: some steps ask for none.
  bool can_lead(const Session& session) const;

  /// Turns the guide on or off for the scenarios that follow.
  void turn(bool on) {
    in_run_ = on;
    view_.clear();
  }

  /// Returns nothing under strict rules, while the guide is off, if the step asks for no view, and before the first
  /// pose.
  std::optional<Guiding> now(const Session& session) const;

  /// Adds an action to the session's exam, whose result counts it, when the guide goes on or off. Call it before each
  /// Session::advance().
  void report_use(Session& session);

  /// Adds a view that was authored after the case was read.
  void add(const ReferenceView& made) { made_.push_back(made); }
  /// Drops the added views: another patient is loaded, or the same one was read again.
  void forget_made() { made_.clear(); }

private:
  const ReferenceView* find_view(const LoadedCase& loaded_case, const std::string& name) const;
  std::vector<std::string> names(const LoadedCase& loaded_case) const;
  static const std::string* view_of_step(const Session& session);

  bool in_run_ = false;              ///< on or off while a scenario runs
  int reported_attempt_ = 0;         ///< the attempt that knows of reported_on_
  bool reported_on_ = false;         ///< what it knows
  std::string view_;                 ///< the view selected when no scenario runs; empty: off
  std::vector<ReferenceView> made_;  ///< their names do not occur in the case
};

}  // namespace insonate
