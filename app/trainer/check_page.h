#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/session/loading.h"
#include "scenarios/scenario_check.h"

namespace insonate {

/// Shows an author the text of a scenario file with all its problems, and checks it again whenever the file changes.
/// Finds what `insonate-score check` finds, on a thread of its own. It does not know a screen.
///
///     CheckPage page("exam.toml");
///     page.update(now_s);  // per frame
///     draw(page.lines(), page.problems());
class CheckPage {
public:
  /// Begins to check.
  /// @param case_folder  of the patient to check on; empty: the scenario's patients
  explicit CheckPage(std::filesystem::path file, std::filesystem::path case_folder = {});

  /// Looks whether the file has changed, twice a second, and takes over what has been found.
  /// @param now_s  on any monotonic clock
  void update(double now_s);
  /// Checks once more, although the text is the same: what it names may have changed.
  void check_again();

  const std::filesystem::path& file() const { return file_; }
  const std::filesystem::path& case_folder() const { return case_folder_; }
  /// Returns the text, without the ends of its lines. A file that cannot be read has none.
  const std::vector<std::string>& lines() const { return lines_; }

  enum class State { checking, wrong, right };
  State state() const;
  /// Returns what has been found so far, in the order of the file.
  const std::vector<Mistake>& problems() const { return problems_; }
  /// Returns why nothing could be checked, such as a file that is not there; a sentence, empty if it could.
  const std::string& failure() const { return failure_; }
  /// Return the scenario's title and its number of steps, once they are known.
  const std::string& title() const { return title_; }
  std::size_t steps() const { return steps_; }
  /// Returns how far the check is; empty if it is done.
  std::optional<Loading::Progress> progress() const;
  /// Returns how many checks have begun.
  long checks() const { return checks_; }

  /// Chooses a problem by its index; its line is to be seen.
  void choose(std::size_t problem);
  /// Chooses the problem that many places below the chosen one, or above it if negative.
  void move_choice(int places);
  /// Returns the index of the chosen problem; empty if there is none.
  std::optional<std::size_t> chosen() const;

private:
  struct Found;
  void read();
  void begin();
  void take_over();

  std::filesystem::path file_, case_folder_;
  std::string text_;
  bool is_there_ = false;
  std::vector<std::string> lines_;
  std::shared_ptr<Found> found_;       ///< shared with the thread
  std::unique_ptr<Loading> checking_;  ///< nullptr once the check is done
  std::vector<Mistake> problems_;
  std::string failure_, title_;
  std::size_t steps_ = 0, chosen_ = 0;
  long checks_ = 0;
  double looked_s_ = -1;
};

}  // namespace insonate
