#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "devices/sequence/probe_samples.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tools/bench/commands.h"
#include "tools/bench/tables/statistics.h"

namespace fs = std::filesystem;

namespace insonate::bench {
namespace {

/// Measured from this long after the first picture on, when shaders are compiled and the quality has settled.
constexpr double kSettle_s = 3;
/// The scan has ended this long after its own duration, on a machine that takes long to load the patient.
constexpr double kLoad_s = 15;
constexpr double kRest_s = 5;

/// Returns the trainer beside this program.
std::string trainer() {
  const fs::path file = fs::read_symlink("/proc/self/exe").parent_path() / "insonate";
  if (!fs::exists(file))
    throw InputError(file.string(), "", "the trainer is not there", "build it, or install the whole package");
  return file.string();
}

/// The trainer as a process of its own. The destructor waits for its end.
class RunningTrainer {
public:
  explicit RunningTrainer(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), trainer());
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const int failure = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) throw InputError(arguments[0], "", "cannot be started", "check its permissions");
  }
  ~RunningTrainer() { wait(); }
  RunningTrainer(const RunningTrainer&) = delete;
  RunningTrainer& operator=(const RunningTrainer&) = delete;

  void wait() {
    if (pid_ == 0) return;
    int status = 0;
    waitpid(std::exchange(pid_, 0), &status, 0);
    ended_well_ = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
  bool ended_well() const { return ended_well_; }
  /// Returns the processor time of all its threads so far, s.
  double processor_s() const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/stat");
    std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::istringstream fields(text.substr(std::min(text.size(), text.rfind(')') + 1)));  // behind the program's name
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double user = 0, system = 0;  // fields 14 and 15 of proc(5)
    fields >> user >> system;
    return (user + system) / double(sysconf(_SC_CLK_TCK));
  }

private:
  pid_t pid_ = 0;
  bool ended_well_ = false;
};

/// What the trainer writes of its frames (FrameTimes).
struct Frames {
  Table table;
  std::string file;

  double number(std::size_t row, std::string_view column) const { return table.number(file, row, column); }
  /// Returns when the first frame whose flag is set was over, in seconds since the trainer's start; the end of its run
  /// if there is none.
  double first_s(std::string_view flag) const {
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      if (number(row, flag) != 0) return number(row, "end_s");
    return number(table.rows.size() - 1, "end_s");
  }
};

class FramesFile {
public:
  FramesFile() : folder_(fs::temp_directory_path() / ("insonate-bench-" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~FramesFile() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  FramesFile(const FramesFile&) = delete;
  FramesFile& operator=(const FramesFile&) = delete;

  std::string out() const { return folder_.string(); }
  std::string file() const { return (folder_ / "frames.csv").string(); }

private:
  fs::path folder_;
};

/// The bundled scan, whose probe moves all the time.
fs::path scan() {
  return assets_folder() / "logs" / "ruq_good.igs.mha";
}

double scan_s() {
  const RecordedScan recorded = read_recorded_scan(scan());
  return recorded.samples.back().time_s - recorded.samples.front().time_s;
}

/// What the trainer showed of a scan, and the share of a core that it takes afterwards, while nothing changes.
struct WindowRun {
  Frames frames;
  double rest_core = 0, rest_from_s = 0;
};

WindowRun run_trainer(const WindowSize& size, double seconds, bool parts) {
  const FramesFile files;
  std::vector<std::string> arguments{"--width",       std::to_string(size.width),
                                     "--height",      std::to_string(size.height),
                                     "--seconds",     cell_of(seconds, 1),
                                     "--frame-times", files.file(),
                                     "--out",         files.out(),
                                     "--tracker",     "replay:" + scan().string()};
  if (parts) arguments.push_back("--frame-parts");
  WindowRun run;
  RunningTrainer trainer(arguments);
  if (!parts) {
    const auto sleep = [](double s) { std::this_thread::sleep_for(std::chrono::duration<double>(s)); };
    run.rest_from_s = seconds - 1 - kRest_s;
    sleep(run.rest_from_s);
    const double before_s = trainer.processor_s();
    sleep(kRest_s);
    run.rest_core = (trainer.processor_s() - before_s) / kRest_s;
  }
  trainer.wait();
  if (!trainer.ended_well())
    throw InputError("window", "", "the trainer ended with an error, which is printed above", "correct it first");
  run.frames = {Table::parse(files.file(), read_file(files.file())), files.file()};
  return run;
}

/// Returns the rows of new pictures that were shown once the rate had settled.
std::vector<std::size_t> settled_pictures(const Frames& frames) {
  const double from_s = frames.first_s("new_picture") + kSettle_s;
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < frames.table.rows.size(); ++row)
    if (frames.number(row, "begin_s") >= from_s && frames.number(row, "new_picture") != 0 &&
        frames.number(row, "shown") != 0)
      rows.push_back(row);
  return rows;
}

double shown_per_s_at_rest(const WindowRun& run) {
  int shown = 0;
  for (std::size_t row = 0; row < run.frames.table.rows.size(); ++row) {
    const double end_s = run.frames.number(row, "end_s");
    if (end_s >= run.rest_from_s && end_s < run.rest_from_s + kRest_s)
      shown += run.frames.number(row, "shown") != 0 ? 1 : 0;
  }
  return shown / kRest_s;
}

}  // namespace

Table measure_window(const std::vector<WindowSize>& sizes) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY"))
    throw InputError("window", "", "there is no display to open windows on",
                     "start it on one, as in xvfb-run -s '-screen 0 2560x1440x24' insonate-bench window");
  constexpr std::array kParts{"session", "ultrasound", "slices", "volume", "layout", "window", "present"};
  Table table{{"size", "window_s", "first_picture_s", "pictures_per_s", "first_quartile_ms", "median_ms",
               "third_quartile_ms", "quality", "volumes_per_s", "rest_core_percent", "rest_frames_per_s"},
              {}};
  for (const char* part : kParts) table.columns.push_back(std::string(part) + "_ms");
  std::printf("%-10s %8s %9s %10s %22s %7s %10s %7s %8s   mean ms of", "window", "window s", "picture s", "pictures/s",
              "between pictures, ms", "quality", "volumes/s", "rest, %", "frames/s");
  for (const char* part : kParts) std::printf(" %10s", part);
  std::printf("\n");
  const double duration_s = scan_s();
  for (const WindowSize& size : sizes) {
    const WindowRun run = run_trainer(size, duration_s + kLoad_s + kRest_s + 1, false);
    std::vector<double> ends_s, intervals_ms, quality;
    const std::vector<std::size_t> shown = settled_pictures(run.frames);
    const auto volumes_until = [&](std::size_t row) { return run.frames.number(row, "volumes"); };
    const double volumes = shown.empty() ? 0 : volumes_until(shown.back()) - volumes_until(shown.front());
    for (const std::size_t row : shown) {
      ends_s.push_back(run.frames.number(row, "end_s"));
      quality.push_back(run.frames.number(row, "quality"));
      if (ends_s.size() > 1) intervals_ms.push_back(1e3 * (ends_s.back() - ends_s[ends_s.size() - 2]));
    }
    const Spread interval = spread_of(intervals_ms);
    const auto rate_of = [&](double pictures) {
      return ends_s.size() < 2 ? 0 : pictures / (ends_s.back() - ends_s.front());
    };
    const double rate = rate_of(double(ends_s.size()) - 1);
    std::vector<std::string> row{std::to_string(size.width) + "x" + std::to_string(size.height),
                                 cell_of(run.frames.first_s("shown"), 2),
                                 cell_of(run.frames.first_s("new_picture"), 2),
                                 cell_of(rate, 1),
                                 cell_of(interval.first_quartile, 1),
                                 cell_of(interval.median, 1),
                                 cell_of(interval.third_quartile, 1),
                                 cell_of(spread_of(quality).median, 2),
                                 cell_of(rate_of(volumes), 1),
                                 cell_of(100 * run.rest_core, 1),
                                 cell_of(shown_per_s_at_rest(run), 1)};
    std::printf("%-10s %8s %9s %10s %6s (%5s to %5s) %7s %10s %7s %8s             ", row[0].c_str(), row[1].c_str(),
                row[2].c_str(), row[3].c_str(), row[5].c_str(), row[4].c_str(), row[6].c_str(), row[7].c_str(),
                row[8].c_str(), row[9].c_str(), row[10].c_str());
    std::fflush(stdout);
    const Frames in_parts = run_trainer(size, duration_s, true).frames;
    const std::vector<std::size_t> pictures = settled_pictures(in_parts);
    for (const char* part : kParts) {
      double sum_ms = 0;
      for (const std::size_t picture : pictures) sum_ms += in_parts.number(picture, std::string(part) + "_ms");
      row.push_back(cell_of(pictures.empty() ? 0 : sum_ms / double(pictures.size()), 1));
      std::printf(" %10s", row.back().c_str());
    }
    std::printf("\n");
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace insonate::bench
