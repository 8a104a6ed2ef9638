#include "app/trainer/learners_page.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <utility>

#include "scenarios/result_json.h"
#include "scenarios/results/export/report_files.h"
#include "scenarios/results/export/results_export.h"
#include "scenarios/results/learner_id.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

/// An attempt without a recorded mode may have been an exam, and is treated as one (is_of).
AttemptMode mode_of(const AttemptSummary& attempt) {
  return attempt.mode.value_or(AttemptMode::exam);
}

void add(LearnerLine& line, const AttemptSummary& attempt) {
  double& best = line.best_percent.try_emplace(mode_of(attempt), attempt.percent).first->second;
  best = std::max(best, attempt.percent);
  ++line.attempts;
  if (is_of(attempt.mode, AttemptMode::exam)) {
    ++line.exams;
    line.passed_exams += attempt.passed ? 1 : 0;
  }
  line.last_ms = std::max(line.last_ms, attempt.finished_ms);
}

/// Returns a score without the texts that the page does not show. Thousands are in memory at once.
ExamResult without_texts(ExamResult result) {
  result.briefing.clear();
  result.reasons.clear();
  const auto forget_reasons = [](std::vector<CriterionScore>& criteria) {
    for (CriterionScore& score : criteria) score.why = std::string();
  };
  for (StepResult& step : result.steps) {
    step.values.clear();
    step.facts.clear();
    forget_reasons(step.criteria);
  }
  forget_reasons(result.criteria);
  return result;
}

}  // namespace

LearnersPage::LearnersPage(const fs::path& database, LearnersChoice choice)
    : database_(ResultsDatabase::open(database)), choice_(std::move(choice)), all_(database_.attempts()) {
  // By time, because databases can be merged, and an exam that was handed in later ended earlier.
  std::stable_sort(all_.begin(), all_.end(),
                   [](const AttemptSummary& a, const AttemptSummary& b) { return a.finished_ms < b.finished_ms; });
  for (const Comment& comment : database_.comments()) ++commented_[comment.attempt];
  list_learners();
  const auto known = [&](const LearnerLine& line) { return line.id == choice_.learner; };
  if (std::none_of(learners_.begin(), learners_.end(), known)) choice_.learner.clear();
  list_attempts();
}

void LearnersPage::list_learners() {
  std::map<std::string, LearnerLine> by_id;
  LearnerLine everybody;
  for (const AttemptSummary& attempt : all_) {
    LearnerLine& line = by_id[attempt.learner];
    line.id = attempt.learner;
    add(line, attempt);
    add(everybody, attempt);
  }
  learners_ = {everybody};
  for (auto& [id, line] : by_id) learners_.push_back(std::move(line));
}

bool LearnersPage::is_chosen(const AttemptSummary& attempt) const {
  return (choice_.learner.empty() || attempt.learner == choice_.learner) &&
         (!choice_.mode || is_of(attempt.mode, *choice_.mode));
}

/// Lists what belongs to the chosen learner and mode, and keeps the chosen scenario and attempt if they belong to it.
void LearnersPage::list_attempts() {
  std::set<AttemptMode> modes;
  for (const AttemptSummary& attempt : all_)
    if (choice_.learner.empty() || attempt.learner == choice_.learner) modes.insert(mode_of(attempt));
  modes_.assign(modes.begin(), modes.end());
  if (choice_.mode && !modes.contains(*choice_.mode)) choice_.mode.reset();

  attempts_.clear();
  scenarios_.clear();
  for (auto attempt = all_.rbegin(); attempt != all_.rend(); ++attempt) {
    if (!is_chosen(*attempt)) continue;
    attempts_.push_back(*attempt);
    const auto of = std::find_if(scenarios_.begin(), scenarios_.end(),
                                 [&](const AttemptedScenario& s) { return s.digest == attempt->scenario_digest; });
    if (of == scenarios_.end())
      scenarios_.push_back({attempt->scenario_digest, attempt->title, 1});
    else
      ++of->attempts;
  }
  // Another text is another exam. Two of one title differ in the digest that the lists of attempts have.
  std::map<std::string, int> titles;
  for (const AttemptedScenario& scenario : scenarios_) ++titles[scenario.title];
  for (AttemptedScenario& scenario : scenarios_)
    if (titles[scenario.title] > 1) scenario.title += " (" + scenario.digest.substr(0, 6) + ")";
  choose_scenario(choice_.scenario);
}

void LearnersPage::choose_scenario(const std::string& digest) {
  const auto known = [&](const AttemptedScenario& scenario) { return scenario.digest == digest; };
  choice_.scenario = std::any_of(scenarios_.begin(), scenarios_.end(), known) ? digest
                     : scenarios_.empty()                                     ? std::string()
                                                                              : scenarios_.front().digest;
  if (const AttemptSummary* chosen = attempt(); !chosen || chosen->scenario_digest != choice_.scenario) {
    const auto newest = std::find_if(attempts_.begin(), attempts_.end(), [&](const AttemptSummary& attempt) {
      return attempt.scenario_digest == choice_.scenario;
    });
    choice_.attempt = newest == attempts_.end() ? 0 : newest->number;
  }
  read_comments();
  begin_trend();
}

void LearnersPage::begin_trend() {
  trend_ = {};
  unread_.clear();
  std::map<std::string, std::size_t> taken;
  std::vector<std::int64_t> of_trend;
  std::set<AttemptMode> modes;
  for (const AttemptSummary& attempt : all_) {
    if (!is_chosen(attempt) || attempt.scenario_digest != choice_.scenario) continue;
    TrendPoint& point = trend_.points.emplace_back();
    point.attempt = attempt.number;
    point.ordinal = taken[attempt.learner]++;
    point.percent = attempt.percent;
    point.mode = mode_of(attempt);
    point.passed = attempt.passed;
    trend_.attempts = std::max(trend_.attempts, point.ordinal + 1);
    modes.insert(point.mode);
    if (!results_.contains(attempt.number)) of_trend.push_back(attempt.number);
  }
  for (const AttemptedScenario& scenario : scenarios_)
    if (scenario.digest == choice_.scenario) trend_.title = scenario.title;
  trend_.mixes_modes = modes.size() > 1;
  if (choice_.learner.empty() && !trend_.mixes_modes) {
    std::vector<std::vector<double>> percents(trend_.attempts);
    for (const TrendPoint& point : trend_.points) percents[point.ordinal].push_back(point.percent);
    for (std::size_t i = 0; i < percents.size(); ++i)
      if (percents[i].size() >= ScoreTrend::kHandful)
        trend_.spreads.push_back({i, percents[i].size(), spread_of(percents[i])});
  }
  // The trend's criteria first, then the times of the others in the list, the newest first.
  for (auto attempt = attempts_.rbegin(); attempt != attempts_.rend(); ++attempt)
    if (attempt->scenario_digest != choice_.scenario && !results_.contains(attempt->number))
      unread_.push_back(attempt->number);
  trend_.unread = of_trend.size();
  unread_.insert(unread_.end(), of_trend.begin(), of_trend.end());
  if (trend_.unread == 0) finish_trend();
}

void LearnersPage::finish_trend() {
  std::vector<PlacedResult> placed;
  for (const TrendPoint& point : trend_.points)
    if (const auto result = results_.find(point.attempt); result != results_.end() && result->second) {
      placed.push_back({point.ordinal, &*result->second});
      trend_.pass_mark_percent = result->second->pass_mark_percent;
    }
  trend_.criteria = criterion_trends(placed);
  trend_.lost_to_hints = mean_lost_to_hints(placed);
}

void LearnersPage::update(double budget_ms) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double, std::milli>(budget_ms);
  while (!unread_.empty() && std::chrono::steady_clock::now() < end) {
    read_score(unread_.back());
    unread_.pop_back();
    if (trend_.unread > 0 && --trend_.unread == 0) finish_trend();
  }
}

void LearnersPage::read_score(std::int64_t attempt) {
  std::optional<ExamResult>& result = results_[attempt];
  try {
    const std::string name = database().string() + ": attempt " + std::to_string(attempt);
    result = without_texts(result_from_json(database_.read_score(attempt).score_json, name));
  } catch (const InputError& error) {
    if (problem_.empty()) problem_ = error.what();
  }
}

std::optional<double> LearnersPage::time_s(std::int64_t attempt) const {
  const auto result = results_.find(attempt);
  if (result == results_.end() || !result->second) return std::nullopt;
  return result->second->motion.time_s;
}

const AttemptSummary* LearnersPage::attempt() const {
  const auto chosen = std::find_if(attempts_.begin(), attempts_.end(),
                                   [&](const AttemptSummary& attempt) { return attempt.number == choice_.attempt; });
  return chosen == attempts_.end() ? nullptr : &*chosen;
}

std::size_t LearnersPage::comments_on(std::int64_t attempt) const {
  const auto found = commented_.find(attempt);
  return found == commented_.end() ? 0 : found->second;
}

void LearnersPage::choose_learner(const std::string& id) {
  choice_.learner = id;
  list_attempts();
}

void LearnersPage::move_choice(int lines) {
  int chosen = 0;
  for (int i = 0; i < int(learners_.size()); ++i)
    if (learners_[std::size_t(i)].id == choice_.learner) chosen = i;
  chosen = std::clamp(chosen + lines, 0, int(learners_.size()) - 1);
  choose_learner(learners_[std::size_t(chosen)].id);
}

void LearnersPage::choose_mode(std::optional<AttemptMode> mode) {
  choice_.mode = mode;
  list_attempts();
}

void LearnersPage::choose_attempt(std::int64_t number) {
  choice_.attempt = number;
  if (const AttemptSummary* chosen = attempt(); chosen && chosen->scenario_digest != choice_.scenario)
    choose_scenario(chosen->scenario_digest);
  read_comments();
}

void LearnersPage::choose_author(const std::string& id) {
  if (!id.empty()) check_learner_id(id, "your id", "");
  choice_.author = id;
}

/// A database that cannot be read is a problem that the page shows.
void LearnersPage::read_comments() {
  comments_.clear();
  try {
    if (choice_.attempt != 0) comments_ = database_.comments(choice_.attempt);
  } catch (const InputError& error) {
    problem_ = error.what();
  }
  commented_[choice_.attempt] = comments_.size();
}

void LearnersPage::add_comment(const std::string& text) {
  Comment comment;
  comment.attempt = choice_.attempt;
  comment.author = choice_.author;
  comment.written_ms = now_since_1970_ms();
  comment.text = text;
  database_.add(comment);
  read_comments();
}

void LearnersPage::remove_comment(std::int64_t number) {
  try {
    database_.remove_comment(number);
  } catch (...) {
    read_comments();  // another program may have removed it
    throw;
  }
  read_comments();
}

fs::path LearnersPage::write_report(const fs::path& out) {
  const Attempt written = database_.read(choice_.attempt);
  return write_report_files(attempt_folder(out, written), written).report;
}

fs::path LearnersPage::export_tables(const fs::path& out) {
  const fs::path folder = free_path(out / "tables" / file_time(now_since_1970_ms()), "");
  const ExportedResults exported = export_results(database_, folder);
  if (!exported.problems.empty())
    throw InputError(
        folder.string(), "",
        (exported.problems.size() == 1 ? std::string("an attempt lacks its criteria")
                                       : std::to_string(exported.problems.size()) + " attempts lack their criteria") +
            " (" + exported.problems.front() + ")",
        "go back to a copy of the database from before");
  return folder;
}

}  // namespace insonate
