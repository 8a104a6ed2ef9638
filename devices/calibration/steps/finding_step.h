#pragma once

#include <string>
#include <utility>

#include "devices/calibration/outcome.h"
#include "devices/calibration/steps/setup_step.h"

namespace insonate {

/// A step that is done when it has found one thing: what all such steps do and show alike. What was found is the
/// derived step's to keep.
class FindingStep : public SetupStep {
public:
  void mark(double time_s) final;
  void undo() final;
  SetupView view() const final;

protected:
  FindingStep(const Calibration& base, std::string title) : SetupStep(base), title_(std::move(title)) {}

  /// "Now", while nothing is found.
  virtual void marked(double time_s) = 0;
  /// Takes the last mark back, or all of them.
  virtual void taken_back(bool all) = 0;
  /// Fills in what is asked for and what comes of it, while nothing is found.
  virtual void ask(SetupView& view) const = 0;
  /// SetupView::part, also when done.
  virtual std::size_t part() const { return 0; }
  /// What was found, in words.
  virtual std::string result() const = 0;

  bool done() const { return done_; }
  /// Keeps what was found in `found` and is done, or refuses; whether it is done.
  template <typename T>
  bool settle(const Outcome<T>& outcome, T& found) {
    if (outcome) found = *outcome;
    done_ = bool(outcome);
    refusal_ = outcome.refusal();
    return done_;
  }
  /// Why the last try does not count; empty when it does.
  void refuse(std::string sentence) { refusal_ = std::move(sentence); }

private:
  const std::string title_;
  std::string refusal_;
  bool done_ = false;
};

}  // namespace insonate
