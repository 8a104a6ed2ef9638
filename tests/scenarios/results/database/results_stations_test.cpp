#include <catch2/catch.hpp>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <random>
#include <thread>

#include "scenarios/results/database/results_database.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

/// Runs `work` as a process of its own that never returns here. Its exit code is 0 when nothing was thrown.
pid_t start(const std::function<void()>& work) {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child > 0) return child;
  int code = 0;
  try {
    work();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 1;
  }
  _exit(code);
}

/// Bytes that do not pack, so that an attempt takes many pages and time to write.
std::string noise(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::string bytes(100'000, '\0');
  for (char& byte : bytes) byte = char(random());
  return bytes;
}

}  // namespace

TEST_CASE("whenever a program is killed, the database opens, is whole, and has what was said to be in it") {
  const ResultsFolder folder;
  const TinyExam exam = tiny_exam(0);
  std::mt19937 random(7);
  int in_the_middle = 0;
  for (int kill_number = 0; kill_number < 40; ++kill_number) {
    // Half of them die while the database is being made, or soon after; the others after their first attempt.
    const bool fresh = kill_number % 2 == 0;
    if (fresh) folder.clear();
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = start([&] {
      ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
      for (std::uint32_t i = 0;; ++i) {
        Attempt attempt = made_attempt("L-" + std::to_string(i), exam, noise(i));
        database.add(attempt);
        if (write(ends[1], "!", 1) != 1) return;
      }
    });
    close(ends[1]);
    int promised = 0;
    char byte = 0;
    if (!fresh) {
      REQUIRE(read(ends[0], &byte, 1) == 1);
      ++promised;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 30'000));
    kill(child, SIGKILL);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    if (std::filesystem::exists(folder / "results.db-wal")) ++in_the_middle;
    while (read(ends[0], &byte, 1) == 1) ++promised;
    close(ends[0]);
    const bool made = std::filesystem::exists(folder / "results.db");
    if (!made) CHECK(promised == 0);
    ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
    database.check();
    const auto attempts = database.attempts();
    CHECK(int(attempts.size()) >= promised);
    std::uint32_t expected = 0;
    for (const AttemptSummary& attempt : attempts) {
      if (attempt.learner == "L-0") expected = 0;
      CHECK(attempt.learner == "L-" + std::to_string(expected));
      const Attempt kept = database.read(attempt.number);
      CHECK(kept.log == noise(expected));
      REQUIRE(kept.pictures.size() == 3);
      CHECK(kept.pictures[0].png == "best" + kept.log);
      ++expected;
    }
    CHECK(database.learners().size() <= attempts.size());
    CHECK(int(expected) >= (attempts.empty() ? 0 : promised));
  }
  // Those that had written before are killed with the database open, however slow the machine is.
  CHECK(in_the_middle >= 20);
}

TEST_CASE("whenever a program is killed, what was said to be kept of an exam under way is there") {
  const ResultsFolder folder;
  std::mt19937 random(11);
  for (int kill_number = 0; kill_number < 10; ++kill_number) {
    folder.clear();
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    const pid_t child = start([&] {
      ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
      Sitting sitting;
      sitting.learner = "L-07";
      database.begin(sitting, noise(0));
      for (std::uint32_t i = 1; write(ends[1], "!", 1) == 1; ++i) database.add_part(sitting.number, noise(i));
    });
    close(ends[1]);
    char byte = 0;
    REQUIRE(read(ends[0], &byte, 1) == 1);
    std::uint32_t promised = 1;
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 30'000));
    kill(child, SIGKILL);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    while (read(ends[0], &byte, 1) == 1) ++promised;
    close(ends[0]);
    ResultsDatabase database = ResultsDatabase::open(folder / "results.db");
    database.check();
    REQUIRE(database.sittings().size() == 1);
    const std::vector<std::string> parts = database.parts(database.sittings()[0].number);
    CHECK(parts.size() >= promised);
    for (std::uint32_t i = 0; i < parts.size(); ++i) CHECK(parts[i] == noise(i));
  }
}

TEST_CASE("stations that write at once, and make the database at once, lose nothing") {
  const ResultsFolder folder;
  const TinyExam exam = tiny_exam(0);
  constexpr int kStations = 3, kEach = 12;
  for (int round = 0; round < 3; ++round) {
    folder.clear();
    pid_t stations[kStations];
    for (int s = 0; s < kStations; ++s)
      stations[s] = start([&] {
        for (int i = 0; i < kEach; ++i) {
          Attempt attempt = made_attempt("S-" + std::to_string(s), exam, noise(std::uint32_t(100 * s + i)));
          ResultsDatabase::open_or_make(folder / "results.db").add(attempt);
        }
      });
    for (const pid_t station : stations) {
      int status = 0;
      REQUIRE(waitpid(station, &status, 0) == station);
      CHECK(WIFEXITED(status));
      CHECK(WEXITSTATUS(status) == 0);
    }
    ResultsDatabase database = ResultsDatabase::open(folder / "results.db");
    database.check();
    CHECK(database.attempts().size() == kStations * kEach);
    const auto learners = database.learners();
    REQUIRE(learners.size() == kStations);
    for (const LearnerSummary& learner : learners) CHECK(learner.attempts == kEach);
  }
}
