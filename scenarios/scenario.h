#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/action.h"
#include "scenarios/metrics/metric.h"
#include "sim/files/mistake.h"
#include "sim/phantom/phantom.h"
#include "sim/volume/case.h"

namespace insonate {

/// A scenario is a TOML text that an instructor can read, copy and change; it runs no code. The types below are its
/// tables. Each field gives the file's key, its range and an example. The reader refuses every other key. A SourcePlace
/// has line 0 if the value was left to its default.

/// A criterion: `[[step.criterion]]` for a step, `[[criterion]]` for the whole exam. Economy metrics (time, path,
/// movements) earn points only if the task was done: the step was completed, or for the whole exam every step.
struct Criterion {
  Metric metric{};        ///< metric = "plane_distance_mm"; the whole exam takes motion metrics only
  double full = 0;        ///< full = 5: this value or a better one earns the whole weight
  double zero = 0;        ///< zero = 20: this value or a worse one earns nothing; linear between them
  double weight = 1;      ///< weight = 2: the points available, above 0 to 1000; default 1
  bool critical = false;  ///< critical = true: earning nothing here fails the exam, whatever the total; default false
  SourcePlace place;
  bool sound = true;  ///< the metric exists
};

class StepTask;

/// `[step.tolerance]`: a picture metric and its limit while the view is held. plane_distance_mm = 5 requires 5 mm or
/// less, target_in_view_percent = 60 requires 60 % or more.
struct Tolerance {
  Metric metric{};
  double limit = 0;
  SourcePlace place;
};

/// `[[step.hint]]`: help that the learner may request at a cost, one hint after another.
struct Hint {
  std::string text;  ///< text = "Look along the twelfth rib."
  /// cost = 1, or cost = [0, 1, 2] for the difficulties easy, medium and hard: subtracted from the step's points, 0 to
  /// 1000.
  double cost = 0;
};

/// `[[step]]`: one task for the learner; the steps follow the order of the file. These keys are common to all kinds of
/// steps. The kinds and their own keys are in scenarios/steps.
struct Step {
  std::string kind;         ///< kind = "find_view": one of step_kinds()
  std::string name;         ///< name = "recess": identifies the step in `[step.next]` and go_to; optional
  std::string title;        ///< title = "Hepatorenal recess"
  std::string instruction;  ///< instruction = "Show the recess between liver and right kidney and hold it."
  std::string view;         ///< view = "hepatorenal": one of the case's reference views; not for all kinds
  SourcePlace view_place;
  double time_limit_s = 0;  ///< time_limit_s = 60: 1 to 3600; the step ends then, done or not
  /// counts = false: a warm-up. It is scored and shown but earns no points, and the exam excludes its time and motion.
  /// Warm-ups come first. Default true.
  bool counts = true;
  std::vector<Hint> hints;  ///< up to 10
  /// `[step.next]` good = "diameter", poor = "end": the name of a later step, or "end". The exam goes to `good` if the
  /// step earned at least half of its points (without criteria: if it was done), and otherwise to `poor`. The steps
  /// between are skipped and do not count. Default: the next step.
  std::string if_good, if_poor;
  std::vector<Criterion> criteria;       ///< may be empty: the step then earns no points
  std::shared_ptr<const StepTask> task;  ///< the keys of this kind; null only if `sound` is false
  bool sound = true;                     ///< its kind and the keys of that kind are valid
};

/// The whole exam: the top-level keys of the file.
struct Scenario {
  /// format = 2: the version of these rules that the file is written for. Format 2 allows everything that format 1
  /// allows.
  static constexpr int kFormat = 2;

  enum class Order { fixed, free };
  enum class Difficulty { easy, medium, hard };

  std::string title;      ///< title = "FAST: right upper quadrant"
  std::string case_name;  ///< case = "abdomen", the built-in phantom, or a case folder relative to the file
  std::string briefing;   ///< briefing = """...""": what the learner reads before the start; optional, unwrapped
  double pass_mark_percent = 80;  ///< pass_mark_percent = 80: 0 to 100
  double time_limit_s = 0;        ///< time_limit_s = 180: of the whole exam, 1 to 36000
  /// order = "fixed" (default), or "free": the learner may switch to any step that has not ended, by its name. A step
  /// that they leave begins anew when they return, with the remaining time of its limit.
  Order order = Order::fixed;
  Difficulty difficulty = Difficulty::medium;  ///< difficulty = "easy", "medium" (default) or "hard": sets hint costs
  /// locked = ["probe", "depth"]: machine settings among "probe", "depth", "frequency" and "gain". In a graded exam
  /// they stay at their initial values (starting_machine), and no step asks for them. In practice mode all settings are
  /// free.
  std::set<ActionKind> locked;
  /// `[phantom]`: options of the built-in phantom's recipe, by name (free_fluid = true); only with case = "abdomen".
  std::vector<std::pair<std::string, std::string>> phantom_options;
  std::map<std::string, SourcePlace> option_places;  ///< by option
  SourcePlace case_place;                            ///< of the key that names the case
  std::vector<Step> steps;                           ///< 1 to 100
  std::vector<Criterion> criteria;                   ///< of the whole exam; may be empty

  std::uint32_t seed = 0;      ///< selects one of the file's [[variant]] tables (variants.h)
  std::string variant;         ///< name of the selected variant; empty if the file has none
  std::size_t variants = 0;    ///< number of variants in the file
  std::filesystem::path file;  ///< where it was read from, for messages and for relative case folders
  std::string text;            ///< the file's bytes
  std::string digest;          ///< digest of `text` (sim/files/digest.h)
};

/// Reports all problems of a scenario, in the order of the file (input_error()).
class ScenarioError : public InputError {
public:
  ScenarioError(const std::string& file, const std::vector<Mistake>& problems)
      : InputError(input_error(file, problems)), problems_(in_order_of_file(problems)) {}
  const std::vector<Mistake>& problems() const { return problems_; }

private:
  std::vector<Mistake> problems_;
};

/// The readable part of a scenario's text.
struct ReadScenario {
  /// Holds one scenario if the file has no [[variant]]. It is empty if the file is not TOML or does not name a known
  /// format.
  std::vector<Scenario> variants;
  std::vector<Mistake> problems;  ///< of all variants, found without the case
};

/// Reads each variant and collects the problems. Throws InputError if the file cannot be read.
ReadScenario read_every_variant(const std::filesystem::path& file);

/// Reads the variant that the seed selects. Checks all variants as far as possible without the case. Throws
/// ScenarioError if there is a problem, and InputError if the file cannot be read.
Scenario read_scenario(const std::filesystem::path& file, std::uint32_t seed = 0);

/// Parses a text as read_scenario() does; `name` replaces the file in messages.
Scenario parse_scenario(std::string_view text, const std::filesystem::path& name, std::uint32_t seed = 0);

/// Returns the scenario's problems with the case: missing views, and targets or landmarks that a metric needs and the
/// view lacks. For a step that is not sound, only the view's name and the criteria are checked.
std::vector<Mistake> problems_with_case(const Scenario& scenario, const Case& subject);

/// Throws ScenarioError if problems_with_case() finds a problem.
void check_against_case(const Scenario& scenario, const Case& subject);

/// Adds a problem if the step's view lacks the targets or landmarks that `metric` needs. `place` is where the step asks
/// for the metric.
void check_metric(Metric metric, const SourcePlace& place, const Step& step, const Case& subject,
                  const std::string& where, std::vector<Mistake>& problems);

/// Returns a problem for each option that the built-in phantom in `assets` refuses.
std::vector<Mistake> problems_with_phantom(const Scenario& scenario, const std::filesystem::path& assets);

/// Returns the problems that are visible before the case is loaded: options that the phantom refuses, or a missing case
/// folder.
std::vector<Mistake> problems_before_case(const Scenario& scenario, const std::filesystem::path& assets);

/// Loads the scenario's case: the built-in phantom from `assets`, cached in `cache`, or a case folder. Throws
/// ScenarioError for options that the phantom refuses or a missing folder, and InputError if the case cannot be read.
Case load_case(const Scenario& scenario, const std::filesystem::path& assets, const std::filesystem::path& cache,
               const Progress& progress = {});

}  // namespace insonate
