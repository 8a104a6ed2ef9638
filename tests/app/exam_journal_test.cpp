#include "app/exam_journal.h"

#include <catch2/catch.hpp>

#include "app/results.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/sequence.h"
#include "scenarios/results/results_database.h"
#include "tests/app/tiny_session.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

/// An exam that counts, fed by hand.
struct Exam {
  std::vector<PoseSample> coming;
  Session session{tiny_study(), [this] { return std::make_unique<HandFed>(coming); }, 0, ExamRules::strict};
  std::vector<PoseSample> scan = searching_scan();
  std::size_t next = 0;

  /// Takes the scan on to that sample, no faster than the disk.
  void run_to(ExamJournal& journal, std::size_t end) {
    while (next < end) {
      coming = {scan[next]};
      session.advance(scan[next++].time_s);
      journal.finish();
      journal.take(session);
    }
  }

  Sitting sitting() const {
    StudySource source;
    source.case_folder = "/cases/7";
    return sitting_of(session, source, "L-07");
  }
};

}  // namespace

TEST_CASE("of an exam that counts the database has all but its last second while it lasts, and may be scored from it") {
  const ResultsFolder folder;
  Exam exam;
  ExamJournal journal(folder / "lab.db", exam.sitting());
  CHECK(journal.finish() == 0);
  exam.run_to(journal, 100);
  exam.session.console().gain_db = 3;
  exam.run_to(journal, 150);
  REQUIRE_FALSE(exam.session.result());
  const std::int64_t number = journal.finish();

  ResultsDatabase database = ResultsDatabase::open(folder / "lab.db");
  const std::vector<Sitting> sittings = database.sittings();
  REQUIRE(sittings.size() == 1);
  const Sitting& kept = sittings[0];
  CHECK(kept.number == number);
  CHECK(kept.learner == "L-07");
  CHECK(kept.title == exam.session.runner()->scenario().title);
  CHECK(kept.scenario_text == exam.session.runner()->scenario().text);
  CHECK(kept.scenario_file == "exam.toml");
  CHECK(kept.patient == "/cases/7");
  CHECK(kept.kept_ms >= kept.began_ms);
  CHECK(now_since_1970_ms() - kept.kept_ms < 60'000);

  std::vector<PoseSample> samples;
  std::map<double, std::string> actions;
  for (const std::string& part : database.parts(number)) {
    const Sequence log = parse_sequence(part, "a part");
    for (const PoseSample& sample : probe_samples(log)) samples.push_back(sample);
    actions.merge(recorded_actions(log));
  }
  const std::vector<PoseSample>& taken = exam.session.exam_samples();
  REQUIRE(samples.size() <= taken.size());
  CHECK(taken.back().time_s - samples.back().time_s < 1.1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CHECK(samples[i].time_s == taken[i].time_s);
    CHECK(samples[i].status == taken[i].status);
    if (samples[i].status == PoseStatus::ok)
      CHECK(samples[i].patient_from_probe.matrix() == taken[i].patient_from_probe.matrix());
  }
  CHECK(actions == to_texts(exam.session.actions()));
  CHECK(actions.size() == 1);
}

TEST_CASE("an exam that cannot be kept while it lasts is told of once, and goes on") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "lab.db");
  Exam exam;
  Sitting elsewhere = exam.sitting();
  database.begin(elsewhere, "log");
  ExamJournal journal(folder / "lab.db", exam.sitting());
  CHECK_THROWS_WITH(exam.run_to(journal, 150), Catch::Contains("at another station"));
  exam.run_to(journal, 150);
  CHECK(exam.session.exam_samples().size() == 150);
  CHECK(journal.finish() == 0);
  CHECK(database.sittings().size() == 1);
}
