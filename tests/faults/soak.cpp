// Hours of a trainer's work with everything going wrong beside it:
//   soak SECONDS SEED
// A trainer without a window scans with a Hydra of umockdev's, which is pulled out and plugged in again some 250 times
// an hour, and is a server for OpenIGTLink that 200 clients flood. Beside it other trainers take one exam after the
// other with a second Hydra that is pulled out as well, and are flooded too. Looked for:
//   memory     the first trainer's private memory grows by less than 2 MiB an hour once it is warm
//   scores     each exam gets the score, to the bit, that insonate-score computes in peace from the bytes that came
//   samples    what the first trainer recorded are the samples that its device's bytes give again, to the bit
//   errors     no program crashes, ends early, or writes to standard error
// Prints a table. Exits with 1 when anything did not hold.

#include <arpa/inet.h>
#include <sys/socket.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "devices/crc16.h"
#include "devices/live/steady_clock.h"
#include "devices/replay/read_log.h"
#include "sim/files/files.h"
#include "sim/volume/case.h"
#include "tests/devices/mocked/mocked_hid.h"
#include "tests/devices/mocked/testbed.h"
#include "tests/devices/numbered_reports.h"
#include "tests/devices/test_samples.h"
#include "tests/scenarios/tiny_case.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

constexpr double kReports_Hz = 60;
constexpr double kMemoryEvery_s = 2;
constexpr double kMaxGrowth_kib_h = 2048;

/// A Hydra that is pulled out and plugged in again at random.
class Plug {
public:
  Plug(Testbed& testbed, std::string serial, std::uint32_t seed)
      : testbed_(testbed), serial_(std::move(serial)), random_(seed) {}

  void turn(double now_s, int& next_number) {
    if (now_s >= change_s_) change(now_s, next_number);
    if (device_ && !pulled_ && now_s >= report_s_) {
      report_s_ = now_s + 1 / kReports_Hz;
      std::deque<Report> reports{report(now_s)};
      device_->send(reports);
      sent_ += reports.empty() ? 1 : 0;
    }
  }

  int unplugged() const { return unplugged_; }
  long sent() const { return sent_; }

private:
  void change(double now_s, int& next_number) {
    const auto between = [&](double a, double b) { return std::uniform_real_distribution(a, b)(random_); };
    if (!device_) {
      device_ = std::make_unique<MockedHid>(testbed_, MockedHid::Identity{0x1532, 0x0300, "Razer Hydra", serial_},
                                            next_number++);
      change_s_ = now_s + between(2, 20);
    } else if (!pulled_) {
      device_->pull();
      pulled_ = true;
      ++unplugged_;
      change_s_ = now_s + 0.3;  // until it is gone from the lists as well
    } else {
      device_.reset();
      pulled_ = false;
      change_s_ = now_s + between(0, 6);
    }
  }

  /// A hand that sways, with the device's own number.
  Report report(double now_s) {
    Report made = hydra_report(int(std::lround(30 * std::sin(now_s))));
    made[7] = std::uint8_t(++number_);
    const std::uint16_t crc = crc16_1021(Bytes(made).first(50), 0x1d0f);
    made[50] = std::uint8_t(crc);
    made[51] = std::uint8_t(crc >> 8);
    return made;
  }

  Testbed& testbed_;
  const std::string serial_;
  std::mt19937 random_;
  std::unique_ptr<MockedHid> device_;
  bool pulled_ = false;
  double change_s_ = 0, report_s_ = 0;
  int unplugged_ = 0;
  unsigned number_ = 0;
  long sent_ = 0;
};

/// Of the process, in KiB.
double private_memory(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/smaps_rollup");
  double total = 0;
  for (std::string word; file >> word;)
    if (double kib = 0; (word == "Private_Dirty:" || word == "Private_Clean:") && file >> kib) total += kib;
  return total;
}

struct Memory {
  double at_s, kib;
};

/// Between the medians of the first and the last quarter, KiB an hour. What a trainer has ready for its clients comes
/// and goes with them, by more than an hour's growth may be.
double growth(const std::vector<Memory>& samples) {
  const auto median = [&](std::size_t from, std::size_t to) {
    std::vector<double> some;
    for (std::size_t i = from; i < to; ++i) some.push_back(samples[i].kib);
    std::nth_element(some.begin(), some.begin() + std::ptrdiff_t(some.size() / 2), some.end());
    return some[some.size() / 2];
  };
  const std::size_t count = samples.size(), quarter = count / 4;
  if (quarter == 0) return 0;
  const double hours = (samples[count - 1 - quarter / 2].at_s - samples[quarter / 2].at_s) / 3600;
  return (median(count - quarter, count) - median(0, quarter)) / hours;
}

int free_port() {
  const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (bind(descriptor, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0)
    throw std::runtime_error("no port is free");
  close(descriptor);
  return ntohs(address.sin_port);
}

/// The lines of a score that do not name the log or say where its samples came from.
std::string comparable(const std::string& score) {
  std::istringstream lines(score);
  std::string all;
  for (std::string line; std::getline(lines, line);)
    if (line.find("\"log") == std::string::npos && line.find("\"mode\"") == std::string::npos) all += line + "\n";
  return all;
}

class Soak {
public:
  Soak(fs::path root, double seconds, std::uint32_t seed)
      : root_(std::move(root)),
        seconds_(seconds),
        seed_(seed),
        trainers_plug_(testbed_, "A1", seed),
        exams_plug_(testbed_, "B2", seed + 1) {
    write_case(root_ / "tiny", tiny_case());
    write_file(root_ / "exam.toml", kTinyScenario);
  }

  int run() {
    const std::string port = std::to_string(free_port());
    exam_port_ = std::to_string(free_port());
    begin_s_ = steady_now_s();
    trainer_ = std::make_unique<Child>(std::vector<std::string>{
        INSONATE_PROGRAM, "--headless", "--case", (root_ / "tiny").string(), "--tracker", "hydra:A1", "--igtl-server",
        port, "--record", (root_ / "run.igs.mha").string(), "--record-raw", (root_ / "run.raw").string(), "--seconds",
        std::to_string(seconds_), "--out", (root_ / "out").string(), "--quality", "fast"});
    ChildProcess flood({INSONATE_FLOOD_PROGRAM, port, "200", std::to_string(seconds_), std::to_string(seed_)});
    ChildProcess exams_flood(
        {INSONATE_FLOOD_PROGRAM, exam_port_, "20", std::to_string(seconds_), std::to_string(seed_ + 1)});
    while (!trainer_->ended() && now_s() < seconds_ + 300) {
      turn();
      trainer_->listen();
      for (ChildProcess* one : {&flood, &exams_flood}) one->listen();
      look_at_exam(now_s() < seconds_ - 30);
      look_at_memory();
    }
    for (double limit_s = now_s() + 120; exam_ && now_s() < limit_s;) {
      turn();
      look_at_exam(false);
    }
    for (double limit_s = now_s() + 60; !flood.ended() && now_s() < limit_s;) turn();
    flood.listen();
    trainer_->listen();
    expect(trainer_->pid() < 0, "the trainer did not end");
    expect(trainer_->exit_code() == 0, "the trainer ended with " + std::to_string(trainer_->exit_code()));
    expect(trainer_->err.empty(), "the trainer said: " + trainer_->err);
    expect(flood.pid() < 0 && flood.exit_code() == 0, "the flood was not answered: " + flood.out + flood.err);
    expect(!exam_, "an exam did not end");
    flooded_ = flood.out;
    compare_samples();
    return report();
  }

private:
  double now_s() const { return steady_now_s() - begin_s_; }

  void expect(bool holds, const std::string& what) {
    if (!holds) problems_.push_back(what);
  }

  void turn() {
    bool worked = false;
    while (g_main_context_iteration(nullptr, FALSE)) worked = true;
    trainers_plug_.turn(now_s(), next_number_);
    exams_plug_.turn(now_s(), next_number_);
    if (!worked) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  fs::path exam_file(const std::string& ending) const { return root_ / ("exam-" + std::to_string(exams_) + ending); }

  void look_at_exam(bool begin_another) {
    if (!exam_) {
      if (!begin_another) return;
      ++exams_;
      unplugged_before_ = exams_plug_.unplugged();
      exam_ = std::make_unique<Child>(std::vector<std::string>{
          INSONATE_PROGRAM, "--headless", "--scenario", (root_ / "exam.toml").string(), "--tracker", "hydra:B2",
          "--igtl-server", exam_port_, "--record-raw", exam_file(".raw").string(), "--out", exam_file("").string(),
          "--seconds", "120", "--quality", "fast"});
    }
    exam_->listen();
    if (!exam_->ended()) return;
    exam_->listen();
    const std::string name = "exam " + std::to_string(exams_);
    expect(exam_->exit_code() == 0, name + " ended with " + std::to_string(exam_->exit_code()));
    expect(exam_->err.empty(), name + " said: " + exam_->err);
    if (exam_->exit_code() == 0) compare_score(name);
    exam_.reset();
    std::error_code ignored;
    fs::remove_all(exam_file(""), ignored);
    fs::remove(exam_file(".raw"), ignored);
  }

  /// The one that was given in all the trouble, and the one of the same bytes in peace.
  void compare_score(const std::string& name) {
    const fs::path live = exam_file("") / "score.json";
    if (!fs::exists(live)) {
      expect(false, name + " has no score");
      return;
    }
    ChildProcess score(
        {INSONATE_SCORE_PROGRAM, "--log", exam_file(".raw").string(), "--scenario", (root_ / "exam.toml").string()});
    while (!score.ended()) {
      score.listen();
      turn();
    }
    score.listen();
    expect(score.exit_code() == 0, name + " cannot be scored again: " + score.err);
    const bool same = comparable(read_file(live)) == comparable(score.out);
    expect(same, name + " has another score than its bytes in peace");
    different_ += same ? 0 : 1;
    ++compared_;
    troubled_ += exams_plug_.unplugged() > unplugged_before_ ? 1 : 0;
  }

  void look_at_memory() {
    if (trainer_->pid() < 0 || now_s() < looked_s_ + kMemoryEvery_s) return;
    looked_s_ = now_s();
    if (const double kib = private_memory(trainer_->pid()); kib > 0) memory_.push_back({looked_s_, kib});
  }

  void compare_samples() {
    try {
      const std::vector<ProbeSample> recorded = read_log(root_ / "run.igs.mha").samples;
      std::vector<ProbeSample> again = read_log(root_ / "run.raw").samples;
      expect(again.size() >= recorded.size(), "the raw recording lacks samples");
      again.resize(std::min(again.size(), recorded.size()));  // what came after the last frame was not recorded
      expect(same_bits(recorded, again), "the recorded samples are others than those of the device's bytes");
      recorded_ = recorded.size();
    } catch (const std::exception& error) {
      expect(false, error.what());
    }
  }

  int report() {
    // Until then a trainer fills its buffers for the first time.
    const double warm_s = std::min(300.0, seconds_ / 4);
    std::vector<Memory> warm;
    std::copy_if(memory_.begin(), memory_.end(), std::back_inserter(warm),
                 [&](const Memory& one) { return one.at_s >= warm_s && one.at_s < seconds_; });
    const double kib_h = growth(warm), hours = (seconds_ - warm_s) / 3600;
    // In less than an hour, less than that in all: a short run shows little about an hour.
    const double most_kib_h = kMaxGrowth_kib_h * std::max(1.0, 1 / hours);
    expect(warm.size() > 10 && kib_h < most_kib_h, "the trainer's memory grows");
    std::printf("%-28s %.0f s, seed %u\n", "ran for", seconds_, seed_);
    std::printf("%-28s %d times the trainer's, %d times the exams'\n", "unplugged", trainers_plug_.unplugged(),
                exams_plug_.unplugged());
    std::printf("%-28s %ld and %ld\n", "reports sent", trainers_plug_.sent(), exams_plug_.sent());
    std::printf("%-28s %zu\n", "samples recorded", recorded_);
    std::printf("%-28s %d, of %d the tracker was unplugged; %d other scores\n", "exams", compared_, troubled_,
                different_);
    std::printf("%-28s %s", "flood", flooded_.c_str());
    if (!warm.empty())
      std::printf("%-28s %.0f KiB at %.0f s, %.0f KiB at %.0f s; %+.0f KiB an hour\n", "private memory",
                  warm.front().kib, warm.front().at_s, warm.back().kib, warm.back().at_s, kib_h);
    for (const std::string& problem : problems_) std::printf("FAILED: %s\n", problem.c_str());
    std::printf("%s\n", problems_.empty() ? "passed" : "not passed");
    return problems_.empty() ? 0 : 1;
  }

  const fs::path root_;
  const double seconds_;
  const std::uint32_t seed_;
  Testbed testbed_;
  Plug trainers_plug_, exams_plug_;
  int next_number_ = 0;
  double begin_s_ = 0, looked_s_ = 0;
  std::unique_ptr<Child> trainer_, exam_;
  std::string exam_port_, flooded_;
  int exams_ = 0, compared_ = 0, troubled_ = 0, different_ = 0, unplugged_before_ = 0;
  std::vector<Memory> memory_;
  std::size_t recorded_ = 0;
  std::vector<std::string> problems_;
};

}  // namespace
}  // namespace insonate

int main(int argc, char** argv) {
  using namespace insonate;
  const double seconds = argc == 3 ? std::atof(argv[1]) : 0;
  if (seconds < 60 || std::atol(argv[2]) < 1) {
    std::fprintf(stderr, "soak SECONDS SEED, from 60 and from 1 on\n");
    return 2;
  }
  const std::filesystem::path root =
      std::filesystem::temp_directory_path() / ("insonate-soak-" + std::to_string(getpid()));
  int code = 1;
  try {
    if (const std::string why_not = Testbed::why_not(); !why_not.empty()) throw std::runtime_error(why_not);
    code = Soak(root, seconds, std::uint32_t(std::atol(argv[2]))).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "soak: %s\n", error.what());
  }
  std::error_code ignored;
  std::filesystem::remove_all(root, ignored);
  return code;
}
