#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/session/loaded_case.h"

namespace insonate {

/// Loads a LoadedCase on its own thread. The destructor abandons the loading without waiting: the thread ends at its
/// next progress report and discards what it has loaded so far.
class Loading {
public:
  using Load = std::function<std::shared_ptr<const LoadedCase>(const LoadProgress&)>;
  explicit Loading(Load load);
  ~Loading();
  Loading(const Loading&) = delete;
  Loading& operator=(const Loading&) = delete;

  struct Progress {
    std::string what = "Starting";
    double share = 0;
  };
  Progress progress() const;

  /// Returns whether take() would return at once.
  bool done() const;
  /// Waits for the LoadedCase and returns it; to be called once. Throws what `load` threw.
  std::shared_ptr<const LoadedCase> take();

  /// Returns how many abandoned threads still run. Static objects must not be destroyed while they do. A program that
  /// cannot wait for 0 ends through leave_program().
  static int given_up();

private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// Ends the program with `exit_code`. Skips static destructors while abandoned threads still run.
int leave_program(int exit_code);

}  // namespace insonate
