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
#include "sim/core/input_error.h"
#include "sim/phantom/phantom.h"
#include "sim/volume/case.h"

namespace insonate {

/// A scenario is a TOML text that an instructor can read, copy and change; no code runs from it. The types below are
/// its tables, with the file's key, its range and an example at each field. Whatever is not listed here is refused.

/// Where in the text something was said; 1-based, 0 when it was left to its default.
struct SourcePlace {
  int line = 0;
  int column = 0;
};

/// A line of the marking scheme: `[[step.criterion]]` for a step, `[[criterion]]` for the whole exam. Economy (time,
/// path, movements) earns points only where the task was done: the step's view held, or for the whole exam every view.
struct Criterion {
  Metric metric{};        ///< metric = "plane_distance_mm"; the whole exam takes motion metrics only
  double full = 0;        ///< full = 5: this value or a better one earns the whole weight
  double zero = 0;        ///< zero = 20: this value or a worse one earns nothing; between them a straight line
  double weight = 1;      ///< weight = 2: the points there are to earn, above 0 to 1000; default 1
  bool critical = false;  ///< critical = true: earning nothing here fails the exam, whatever the total; default false
  SourcePlace place;
  bool sound = true;  ///< there is such a metric
};

class StepTask;

/// `[step.tolerance]`: a picture metric and the limit it has to keep while the view is held.
/// plane_distance_mm = 5 asks for 5 mm or less, target_in_view_percent = 60 for 60 % or more.
struct Tolerance {
  Metric metric{};
  double limit = 0;
  SourcePlace place;
};

/// `[[step.hint]]`: help that the learner may ask for, one after the other, at a cost.
struct Hint {
  std::string text;  ///< text = "Look along the twelfth rib."
  /// cost = 1, or cost = [0, 1, 2] for the difficulties easy, medium and hard: taken from the step's points, 0 to 1000.
  double cost = 0;
};

/// `[[step]]`: what the learner is asked to do, in the order of the file. These are the keys that all kinds of steps
/// have; the kinds and their own keys are in scenarios/steps.
struct Step {
  std::string kind;         ///< kind = "find_view": one of step_kinds()
  std::string name;         ///< name = "recess": what other steps and go_to call it; may be left out
  std::string title;        ///< title = "Hepatorenal recess"
  std::string instruction;  ///< instruction = "Show the recess between liver and right kidney and hold it."
  std::string view;         ///< view = "hepatorenal": one of the case's reference views; not for all kinds
  SourcePlace view_place;
  double time_limit_s = 0;  ///< time_limit_s = 60: 1 to 3600; the step ends there, done or not
  /// counts = false: a warm-up, which is marked and shown but earns nothing; neither its time nor its motion are the
  /// exam's. Warm-ups come first. Default true.
  bool counts = true;
  std::vector<Hint> hints;  ///< up to 10
  /// `[step.next]` good = "diameter", poor = "end": where to go on when the step earned at least half of its points
  /// (without criteria: when it was done), and when not: a later step's name, or "end". What lies between is skipped
  /// and does not count. Default: the next step.
  std::string if_good, if_poor;
  std::vector<Criterion> criteria;       ///< none makes the step a warm-up that does not count
  std::shared_ptr<const StepTask> task;  ///< what this kind asks for; null only where `sound` is false
  bool sound = true;                     ///< nothing is wrong with its kind and with the keys of that
};

struct Scenario {
  /// format = 2: the version of these rules that the file is written for. All that format 1 allows, format 2 does.
  static constexpr int kFormat = 2;

  enum class Order { fixed, free };
  enum class Difficulty { easy, medium, hard };

  std::string title;              ///< title = "FAST: right upper quadrant"
  std::string case_name;          ///< case = "abdomen", the built-in phantom, or a case folder relative to the file
  std::string briefing;           ///< briefing = """...""": what the learner reads before the start; may be left out
  double pass_mark_percent = 80;  ///< pass_mark_percent = 80: 0 to 100
  double time_limit_s = 0;        ///< time_limit_s = 180: of the whole exam, 1 to 36000
  /// order = "fixed" (default), or "free": the learner turns to any step that is not ended, by its name; what he leaves
  /// begins anew when he comes back, with the time that is left of its limit.
  Order order = Order::fixed;
  Difficulty difficulty = Difficulty::medium;  ///< difficulty = "easy", "medium" (default) or "hard": what hints cost
  /// locked = ["probe", "depth"]: settings of the machine, of "probe", "depth", "frequency" and "gain", that stay as
  /// they are at the beginning (starting_machine) when the exam counts; no step asks for them. In practice all are
  /// free.
  std::set<ActionKind> locked;
  /// `[phantom]`: options of the built-in phantom's recipe, by name (free_fluid = true); only with
  /// case = "abdomen".
  std::vector<std::pair<std::string, std::string>> phantom_options;
  std::map<std::string, SourcePlace> option_places;  ///< by option
  SourcePlace case_place;                            ///< of what names the case
  std::vector<Step> steps;                           ///< 1 to 100
  std::vector<Criterion> criteria;                   ///< of the whole exam; may be empty

  std::uint32_t seed = 0;      ///< draws one of the file's [[variant]] tables (variants.h)
  std::string variant;         ///< the name of the one that was drawn; empty when the file has none
  std::size_t variants = 0;    ///< how many there are
  std::filesystem::path file;  ///< where it was read from, for messages and for relative case folders
  std::string text;            ///< the file's bytes
  std::string digest;          ///< of them (sim/core/digest.h)
};

/// Something wrong in a scenario file, in words: "step 2 names the view 'hepatorenl', which the case does not have",
/// "did you mean 'hepatorenal'?".
struct ScenarioProblem {
  SourcePlace place;
  std::string problem;
  std::string remedy;
};

/// Thrown with every problem that a scenario has, in the order of the file; what() lists them all.
class ScenarioError : public InputError {
public:
  ScenarioError(const std::string& file, std::vector<ScenarioProblem> problems);
  const std::vector<ScenarioProblem>& problems() const { return problems_; }

private:
  std::vector<ScenarioProblem> problems_;
};

/// A scenario's text, as far as it can be read.
struct ReadScenario {
  /// One when the file has no [[variant]]; none when it is not TOML or does not name a
  /// format that is known.
  std::vector<Scenario> variants;
  std::vector<ScenarioProblem> problems;  ///< of all variants, without looking at a case
};

/// Reads each variant, whatever is wrong with it. Throws InputError when there is no such file.
ReadScenario read_every_variant(const std::filesystem::path& file);

/// Reads the variant that the seed draws, and checks of all of them what can be checked without the case. Throws
/// ScenarioError, or InputError when there is no such file.
Scenario read_scenario(const std::filesystem::path& file, std::uint32_t seed = 0);

/// The same for a text at hand; `name` stands for the file in messages.
Scenario parse_scenario(std::string_view text, const std::filesystem::path& name, std::uint32_t seed = 0);

/// What is wrong with what the scenario says of the case: views, and that their targets and landmarks are there for the
/// metrics that need them. Of a step that is not sound the view's name and the criteria are looked at.
std::vector<ScenarioProblem> problems_with_case(const Scenario& scenario, const Case& subject);

/// Throws a ScenarioError when there is any.
void check_against_case(const Scenario& scenario, const Case& subject);

/// The same for one metric that a step asks for at `place`.
void check_metric(Metric metric, const SourcePlace& place, const Step& step, const Case& subject,
                  const std::string& where, std::vector<ScenarioProblem>& problems);

/// The options that the built-in phantom out of `assets` does not take.
std::vector<ScenarioProblem> problems_with_phantom(const Scenario& scenario, const std::filesystem::path& assets);

/// What is wrong with how the scenario names its case, before the case is loaded: options that the phantom does not
/// take, or a folder that is missing.
std::vector<ScenarioProblem> problems_before_case(const Scenario& scenario, const std::filesystem::path& assets);

/// The case that the scenario names: the built-in phantom out of `assets`, kept in `cache`, or a case folder. Throws
/// ScenarioError for options that the phantom does not take, and InputError.
Case load_case(const Scenario& scenario, const std::filesystem::path& assets, const std::filesystem::path& cache,
               const Progress& progress = {});

}  // namespace insonate
