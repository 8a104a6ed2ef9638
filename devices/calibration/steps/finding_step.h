#pragma once

#include <string>
#include <utility>

#include "devices/calibration/outcome.h"
#include "devices/calibration/steps/setup_step.h"

namespace insonate {

/// A step that ends when it has found one result: the common behaviour of such steps. The derived step stores the
/// result.
class FindingStep : public SetupStep {
public:
  void mark(double time_s) final;
  void undo() final;
  SetupView view() const final;

protected:
  FindingStep(const Calibration& base, std::string title) : SetupStep(base), title_(std::move(title)) {}

  /// Called by mark() while nothing is found.
  virtual void marked(double time_s) = 0;
  /// Removes the last mark, or all marks.
  virtual void taken_back(bool all) = 0;
  /// Fills in the task and the feedback while nothing is found.
  virtual void ask(SetupView& view) const = 0;
  /// Returns SetupView::part, also when done.
  virtual std::size_t part() const { return 0; }
  /// Returns what was found, in words.
  virtual std::string result() const = 0;

  bool done() const { return done_; }
  /// Stores the outcome's value in `found` and ends the step, or stores the refusal. Returns whether the step is done.
  template <typename T>
  bool settle(const Outcome<T>& outcome, T& found) {
    if (outcome) found = *outcome;
    done_ = bool(outcome);
    refusal_ = outcome.refusal();
    return done_;
  }
  /// Sets why the last attempt does not count; empty if it does.
  void refuse(std::string sentence) { refusal_ = std::move(sentence); }

private:
  const std::string title_;
  std::string refusal_;
  bool done_ = false;
};

}  // namespace insonate
