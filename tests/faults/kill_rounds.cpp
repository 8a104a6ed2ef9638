// Kills writing programs at random moments, and looks after each kill whether what was committed is there, whether
// anything half written looks whole, and whether the next start works:
//   kill_rounds [--rounds N] [--seed S] [--limits]
// Half of the kills come after a random time, half at a random call of the system. With --limits nobody is killed:
// writers run out of room or of files at a random moment (Fault), and have to say so in a sentence. Prints a table.
// Exits with 1 when anything did not hold.

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "tests/faults/kill_checks.h"
#include "tests/faults/kill_kinds.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr int kRoundsInAFolder = 8;
/// One round in so many is a program's: each of these takes a second.
constexpr int kProgramEvery = 25;

struct Bench {
  Kind* kind = nullptr;
  fs::path folder;
  long duration_us = 0, calls = 0, bytes = 0;  ///< of a writer that nothing happens to, and of its largest file
  Promises promises = {};
  int rounds = 0, by_time = 0, by_call = 0, by_limit = 0, left_behind = 0, failures = 0;
  std::size_t committed = 0;
};

bool any_left_behind(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name.front() == '.' || name.ends_with("-wal") || name.find(".recording") != std::string::npos) return true;
  }
  return false;
}

long largest_file(const fs::path& folder) {
  std::uintmax_t largest = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) largest = std::max(largest, entry.file_size());
  return long(largest);
}

class Rounds {
public:
  Rounds(fs::path root, std::uint32_t seed) : root_(std::move(root)), random_(seed), counts_(can_count_calls()) {
    if (!counts_) std::printf("this system does not let calls be counted: all kills come by time\n");
    fs::create_directories(root_ / "made");
    library_ = library_kinds();
    programs_ = program_kinds(root_ / "made");
    for (const auto* kinds : {&library_, &programs_})
      for (const auto& kind : *kinds) benches_.push_back({kind.get(), root_ / std::to_string(benches_.size())});
  }

  /// @param limits  instead of being killed, writers may write no more than so many bytes to a file, or have no more
  ///                than so many open
  void run(int rounds, bool limits) {
    int library = 0, program = 0;
    for (int round = 0; round < rounds; ++round) {
      const bool is_program = !limits && round % kProgramEvery == kProgramEvery - 1;
      const std::size_t index = is_program ? library_.size() + std::size_t(program++) % programs_.size()
                                           : std::size_t(library++) % library_.size();
      one(benches_[index], is_program, limits);
    }
  }

  int report() const {
    std::printf("%-40s %6s %8s %8s %8s %10s %12s %8s\n", "what was written", "rounds", "by time", "by call", "limited",
                "committed", "left traces", "failures");
    int rounds = 0, failures = 0;
    for (const Bench& bench : benches_) {
      if (bench.rounds == 0) continue;
      std::printf("%-40s %6d %8d %8d %8d %10zu %12d %8d\n", bench.kind->what.c_str(), bench.rounds, bench.by_time,
                  bench.by_call, bench.by_limit, bench.committed, bench.left_behind, bench.failures);
      rounds += bench.rounds;
      failures += bench.failures;
    }
    std::printf("%d rounds, %d failures\n", rounds, failures);
    return failures == 0 ? 0 : 1;
  }

private:
  void begin_anew(Bench& bench) {
    fs::remove_all(bench.folder);
    fs::create_directories(bench.folder);
    bench.promises.clear();
  }

  RunOutcome start(Bench& bench, bool is_program, Fault fault, int round) {
    if (is_program) return run_program_under(fault, bench.kind->command(bench.folder, round), root_ / "output");
    return run_under(fault, [&](const Commit& commit) { bench.kind->write(bench.folder, bench.promises, commit); });
  }

  /// Lets a writer run to its end, so that faults can be spread over all it does.
  void measure(Bench& bench, bool is_program) {
    begin_anew(bench);
    const RunOutcome outcome = start(bench, is_program, {}, 0);
    require(!outcome.killed && outcome.exit_code == 0, bench.kind->what + " does not work at all: " + outcome.said);
    bench.duration_us = outcome.duration_us;
    bench.bytes = largest_file(bench.folder);
    if (!is_program && counts_) {
      bench.promises = outcome.promises;
      bench.calls = start(bench, false, {Fault::Kind::call, 0}, 0).calls;
      require(bench.calls > 0, bench.kind->what + " makes no calls");
    }
  }

  Fault draw(const Bench& bench, bool limits) {
    const auto below = [&](long most) { return std::uniform_int_distribution<long>(1, most)(random_); };
    // A writer needs some for itself, and the two pipes that it speaks through.
    if (limits && bench.rounds % 4 == 3) return {Fault::Kind::open_files, 8 + below(8)};
    if (limits) return {Fault::Kind::file_size, below(bench.bytes)};
    if (bench.calls > 0 && bench.rounds % 2 == 1) return {Fault::Kind::call, below(bench.calls)};
    return {Fault::Kind::time, below(bench.duration_us)};
  }

  void one(Bench& bench, bool is_program, bool limits) {
    if (bench.duration_us == 0) measure(bench, is_program);
    if (bench.rounds % kRoundsInAFolder == 0) begin_anew(bench);
    RunOutcome outcome;
    Fault fault;
    // A writer that has ended before the kill was not killed; it is another start that is.
    bool done = false;
    for (int attempt = 0; attempt < 50 && !done; ++attempt) {
      fault = draw(bench, limits);
      outcome = start(bench, is_program, fault, 100 * bench.rounds + attempt + 1);
      bench.promises.insert(bench.promises.end(), outcome.promises.begin(), outcome.promises.end());
      done = limits || outcome.killed;
      if (outcome.killed || outcome.exit_code == 0 || (limits && outcome.exit_code == 2)) continue;
      if (is_program) outcome.said = read_file(root_ / "output");
      tell(bench, fault, "the start fails with " + std::to_string(outcome.exit_code) + ": " + outcome.said);
    }
    ++bench.rounds;
    ++(limits ? bench.by_limit : fault.kind == Fault::Kind::call ? bench.by_call : bench.by_time);
    bench.committed += bench.promises.size();
    bench.left_behind += any_left_behind(bench.folder) ? 1 : 0;
    const std::string why = run_in_child([&] { bench.kind->check(bench.folder, bench.promises); });
    if (!why.empty()) tell(bench, fault, why);
  }

  void tell(Bench& bench, Fault fault, const std::string& why) {
    static constexpr const char* kKinds[] = {"", "us", "calls", "bytes", "files"};
    ++bench.failures;
    std::printf("%s, at %ld %s: %s\n", bench.kind->what.c_str(), fault.at, kKinds[int(fault.kind)], why.c_str());
    begin_anew(bench);
  }

  fs::path root_;
  std::mt19937 random_;
  bool counts_;
  std::vector<std::unique_ptr<Kind>> library_, programs_;
  std::vector<Bench> benches_;
};

}  // namespace
}  // namespace insonate

int main(int argc, char** argv) {
  using namespace insonate;
  CLI::App arguments("Kills writing programs, and checks what is there afterwards", "kill_rounds");
  int rounds = 50;
  std::uint32_t seed = 1;
  bool limits = false;
  arguments.add_option("--rounds", rounds, "How often")->check(CLI::PositiveNumber)->capture_default_str();
  arguments.add_option("--seed", seed, "Draws the moments")->capture_default_str();
  arguments.add_flag("--limits", limits, "Writers run out of room or files instead of being killed");
  std::filesystem::path made;
  arguments.add_option("--make", made, "Only make the files that the programs take, in this folder");
  CLI11_PARSE(arguments, argc, argv);
  if (!made.empty()) {
    program_kinds(made);
    return 0;
  }
  setvbuf(stdout, nullptr, _IONBF, 0);  // nothing waits in it to be written twice, by processes that are forked
  const std::filesystem::path root =
      std::filesystem::temp_directory_path() / ("insonate-kill-rounds-" + std::to_string(getpid()));
  int code = 1;
  try {
    Rounds all(root, seed);
    all.run(rounds, limits);
    code = all.report();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kill_rounds: %s\n", error.what());
  }
  std::error_code ignored;
  std::filesystem::remove_all(root, ignored);
  return code;
}
