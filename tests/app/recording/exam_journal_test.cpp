#include "app/recording/exam_journal.h"

#include <catch2/catch.hpp>

#include <chrono>
#include <thread>

#include "app/recording/results.h"
#include "devices/live/steady_clock.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "scenarios/results/database/results_database.h"
#include "tests/app/session/tiny_session.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

/// An exam that counts, fed by hand.
struct Exam {
  std::vector<ProbeSample> coming;
  Session session{tiny_loaded_case(), [this] { return std::make_unique<HandFed>(coming); }, 0, ExamRules::strict};
  std::vector<ProbeSample> scan = searching_scan();
  std::size_t next = 0;

  /// Takes the scan on to that sample, as fast as it goes.
  void run_to(ExamJournal& journal, std::size_t end) {
    while (next < end) {
      coming = {scan[next]};
      session.advance(scan[next++].time_s);
      journal.take(session);
    }
  }
  /// Takes it on, no faster than the disk.
  void run_calmly_to(ExamJournal& journal, std::size_t end) {
    while (next < end) {
      run_to(journal, next + 1);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Sitting sitting() const {
    CaseSource source;
    source.case_folder = "/cases/7";
    return sitting_of(session, source, "L-07");
  }
};

/// What the database has of the only sitting.
struct Kept {
  std::vector<ProbeSample> samples;
  std::map<double, std::string> actions;
  explicit Kept(ResultsDatabase& database) {
    REQUIRE(database.sittings().size() == 1);
    for (const std::string& part : database.parts(database.sittings()[0].number)) {
      const Sequence log = parse_sequence(part, "a part");
      for (const ProbeSample& sample : probe_samples(log)) samples.push_back(sample);
      actions.merge(recorded_actions(log));
    }
  }
};

}  // namespace

TEST_CASE("of an exam that counts the database has all but its last second or two while it lasts, and then all") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "lab.db");
  Exam exam;
  ExamJournal journal(folder / "lab.db", exam.sitting());
  exam.run_calmly_to(journal, 100);
  exam.session.set(ActionKind::gain, 3);
  exam.run_calmly_to(journal, 150);
  REQUIRE_FALSE(exam.session.result());

  const std::vector<ProbeSample>& taken = exam.session.exam_samples();
  const auto check_kept = [&](const Kept& kept) {
    REQUIRE(kept.samples.size() <= taken.size());
    for (std::size_t i = 0; i < kept.samples.size(); ++i) {
      CHECK(kept.samples[i].time_s == taken[i].time_s);
      CHECK(kept.samples[i].status == taken[i].status);
      if (taken[i].status == PoseStatus::ok)
        CHECK(kept.samples[i].patient_from_probe.matrix() == taken[i].patient_from_probe.matrix());
    }
  };
  for (const double limit_s = steady_now_s() + 60; database.sittings().empty() && steady_now_s() < limit_s;)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  check_kept(Kept(database));

  const std::int64_t number = journal.finish(exam.session);
  const Kept all(database);
  check_kept(all);
  CHECK(all.samples.size() == taken.size());
  CHECK(all.actions == to_texts(exam.session.actions()));
  CHECK(all.actions.size() == 1);
  CHECK(database.parts(number).size() >= 2);

  const Sitting kept = database.sittings()[0];
  CHECK(kept.number == number);
  CHECK(kept.learner == "L-07");
  CHECK(kept.title == exam.session.runner()->scenario().title);
  CHECK(kept.scenario_text == exam.session.runner()->scenario().text);
  CHECK(kept.scenario_file == std::filesystem::absolute("exam.toml"));
  CHECK(kept.patient == "/cases/7");
}

TEST_CASE("an exam that is being taken elsewhere is not this program's to take") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "lab.db");
  Exam exam;
  Sitting elsewhere = exam.sitting();
  database.begin(elsewhere, "log");
  SECTION("as it turns out soon after it has begun") {
    ExamJournal journal(folder / "lab.db", exam.sitting());
    CHECK_THROWS_AS(exam.run_calmly_to(journal, 150), ExamTaken);
  }
  SECTION("or only when it is handed in") {
    ExamJournal journal(folder / "lab.db", exam.sitting());
    exam.run_to(journal, 1);
    CHECK_THROWS_AS(journal.finish(exam.session), ExamTaken);
  }
  CHECK(database.sittings().size() == 1);
}

TEST_CASE("a database that cannot be written is reported once, and has all again as soon as it can") {
  const ResultsFolder folder;
  Exam exam;
  ExamJournal journal(folder / "lab.db", exam.sitting());
  CHECK_THROWS_WITH(exam.run_calmly_to(journal, 149), Catch::Contains("no such file"));
  CHECK_NOTHROW(exam.run_calmly_to(journal, 149));
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "lab.db");
  exam.run_calmly_to(journal, 180);
  REQUIRE(journal.finish(exam.session) == 1);
  CHECK(Kept(database).samples.size() == exam.session.exam_samples().size());
}
