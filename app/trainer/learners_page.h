#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/results/database/results_database.h"
#include "scenarios/results/trends.h"
#include "sim/core/spread.h"

namespace insonate {

/// What an instructor has chosen on the page of learners. It outlives the page, so that a review leads back to it.
struct LearnersChoice {
  std::string learner;              ///< id; empty: all learners
  std::string scenario;             ///< digest of the scenario whose trend is shown; empty: of the newest attempt
  std::optional<AttemptMode> mode;  ///< empty: all
  std::int64_t attempt = 0;         ///< number; 0: none
  std::string author;               ///< id of who writes comments; empty if they do not name themselves
};

/// A line of the list of learners.
struct LearnerLine {
  std::string id;  ///< empty: all learners
  int attempts = 0, exams = 0, passed_exams = 0;
  std::map<AttemptMode, double> best_percent;  ///< modes without an attempt are left out
  std::int64_t last_ms = 0;                    ///< end of the last attempt
};

/// A scenario that the chosen learner has attempted.
struct AttemptedScenario {
  std::string digest, title;
  std::size_t attempts = 0;
};

/// An attempt as a point of a trend.
struct TrendPoint {
  std::int64_t attempt = 0;
  std::size_t ordinal = 0;  ///< from 0: the learner's first attempt at the scenario
  double percent = 0;
  AttemptMode mode{};
  bool passed = false;
};

/// The scores of a group at their n-th attempts.
struct TrendSpread {
  std::size_t ordinal = 0, learners = 0;
  Spread percent;
};

/// How the attempts at one scenario went, in the order of time.
struct ScoreTrend {
  /// Fewer scores have no quartiles worth drawing.
  static constexpr std::size_t kHandful = 5;

  std::string title;         ///< of the scenario; empty if there is no attempt
  std::size_t attempts = 0;  ///< the largest number of attempts of one learner
  std::vector<TrendPoint> points;
  std::vector<TrendSpread> spreads;  ///< of a group, where at least kHandful learners have a score; else empty
  bool mixes_modes = false;          ///< scores of different modes are not compared: no spreads
  std::optional<double> pass_mark_percent;
  std::vector<CriterionTrend> criteria;
  double lost_to_hints = 0;  ///< points per attempt
  std::size_t unread = 0;    ///< attempts whose criteria are still to be read; criteria is empty until 0
};

/// What an instructor sees of the learners in a database of results: who they are, how their attempts went, and what
/// was written about them. It does not know a screen. The scores are read bit by bit by update(), because a lab's
/// database has thousands.
///
///     LearnersPage page("lab.db");
///     page.choose_learner("L-07");
///     while (page.reading() > 0) page.update();
///     draw(page.trend());
class LearnersPage {
public:
  /// Throws InputError if the database cannot be read.
  explicit LearnersPage(const std::filesystem::path& database, LearnersChoice choice = {});

  const std::filesystem::path& database() const { return database_.file(); }
  const LearnersChoice& choice() const { return choice_; }

  /// Returns the learners in the order of their ids, after a line for all of them.
  const std::vector<LearnerLine>& learners() const { return learners_; }
  /// Returns the modes of the chosen learner's attempts.
  const std::vector<AttemptMode>& modes() const { return modes_; }
  /// Returns the attempts of the chosen learner and mode, newest first.
  const std::vector<AttemptSummary>& attempts() const { return attempts_; }
  /// Returns their scenarios, that of the newest attempt first.
  const std::vector<AttemptedScenario>& scenarios() const { return scenarios_; }
  /// Returns the trend of the chosen scenario.
  const ScoreTrend& trend() const { return trend_; }
  /// Returns the time that an attempt took (s); nothing if its score has not been read or cannot be.
  std::optional<double> time_s(std::int64_t attempt) const;
  /// Returns the chosen attempt; nullptr if none is chosen.
  const AttemptSummary* attempt() const;
  /// Returns the comments on the chosen attempt, in the order in which they were written.
  const std::vector<Comment>& comments() const { return comments_; }
  /// Returns the number of comments on an attempt.
  std::size_t comments_on(std::int64_t attempt) const;
  /// Returns which score could not be read, a sentence; empty if all could.
  const std::string& problem() const { return problem_; }

  /// Reads some of the scores that are still to be read, for about `budget_ms`.
  void update(double budget_ms = 10);
  /// Returns how many scores of the chosen learner are still to be read.
  std::size_t reading() const { return unread_.size(); }

  void choose_learner(const std::string& id);
  /// Chooses the learner that many lines below the chosen one, or above it if negative.
  void move_choice(int lines);
  void choose_mode(std::optional<AttemptMode> mode);
  /// Chooses a scenario, and its newest attempt unless one of its attempts is chosen.
  void choose_scenario(const std::string& digest);
  /// Chooses an attempt, and its scenario.
  void choose_attempt(std::int64_t number);
  /// Sets who writes comments; nobody named for an empty id. Throws InputError if the id is not valid.
  void choose_author(const std::string& id);

  /// Stores a comment on the chosen attempt, written now. Throws InputError if the text is not valid.
  void add_comment(const std::string& text);
  void remove_comment(std::int64_t number);

  /// Writes the report of the chosen attempt to a folder of its own in `out` (attempt_folder()). Returns the page.
  std::filesystem::path write_report(const std::filesystem::path& out);
  /// Writes all results as CSV files to a new folder in `out` (export_results()), whose name is the time in UTC.
  /// Returns the folder. Throws InputError, also if the files are there but lack what could not be read.
  std::filesystem::path export_tables(const std::filesystem::path& out);

private:
  bool is_chosen(const AttemptSummary& attempt) const;
  void list_learners();
  void list_attempts();
  void begin_trend();
  void finish_trend();
  void read_score(std::int64_t attempt);
  void read_comments();

  ResultsDatabase database_;
  LearnersChoice choice_;
  std::vector<AttemptSummary> all_;  ///< oldest first
  std::vector<LearnerLine> learners_;
  std::vector<AttemptMode> modes_;
  std::vector<AttemptSummary> attempts_;
  std::vector<AttemptedScenario> scenarios_;
  ScoreTrend trend_;
  std::vector<std::int64_t> unread_;  ///< the next one last
  /// By number, without their texts; of those read so far. Empty ones cannot be read.
  std::map<std::int64_t, std::optional<ExamResult>> results_;
  std::map<std::int64_t, std::size_t> commented_;  ///< number of comments, by attempt
  std::vector<Comment> comments_;
  std::string problem_;
};

}  // namespace insonate
