#pragma once

#include <functional>
#include <memory>
#include <string>

#include "app/session/loaded_case.h"

namespace insonate {

/// A loaded_case being loaded on a thread of its own. Destroying it gives the loading up without waiting: the thread
/// ends at the next progress it reports, and what it had so far goes with it.
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

  /// Whether take() would not wait.
  bool done() const;
  /// Waits for the loaded_case, once. Throws what `load` threw.
  std::shared_ptr<const LoadedCase> take();

  /// How many threads still work on what was given up. Static objects must not be destroyed beneath them: a program
  /// that cannot wait for 0 ends by leave_program().
  static int given_up();

private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// Ends the program with `exit_code`; not by way of static destructors while threads still work on what was given up.
int leave_program(int exit_code);

}  // namespace insonate
