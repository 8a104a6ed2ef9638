#pragma once

#include <functional>
#include <memory>
#include <optional>
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
    double share = 0;              ///< of `what`, 0 to 1
    std::optional<double> left_s;  ///< estimate for `what`; empty while too little is known
  };
  Progress progress() const;

  /// Returns whether take() would return at once.
  bool done() const;
  /// Waits for the LoadedCase and returns it. Throws what `load` threw.
  std::shared_ptr<const LoadedCase> take();

  /// Returns how many abandoned threads still run. Static objects must not be destroyed while they do. A program that
  /// cannot wait for 0 ends through leave_program().
  static int given_up();

private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

/// Returns how much longer work takes, s, if it goes on as it has since it was first reported. Empty during the first
/// second and before 3 % are done: an estimate would jump.
/// @param elapsed_s    from the first report to the last, s
/// @param first_share  of the first report, 0 to 1
/// @param share        of the last report, 0 to 1
std::optional<double> time_left_s(double elapsed_s, double first_share, double share);

/// Ends the program with `exit_code`. Skips static destructors while abandoned threads still run.
int leave_program(int exit_code);

}  // namespace insonate
