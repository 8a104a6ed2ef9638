// insonate-devices calibrate: the set-up, step by step, in a terminal.

#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/calibrated_tracker.h"
#include "devices/calibration/steps/setup_step.h"
#include "devices/live/steady_clock.h"
#include "devices/registry.h"
#include "devices/rehearsal/rehearsal_tracker.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tools/devices/commands.h"

namespace insonate::devices {
namespace {

struct CalibrateRequest {
  std::vector<std::string> steps;
  std::string uri;
  std::filesystem::path out, landmarks, drawing;
  bool moved = false;
};

/// Reads lines from standard input without blocking.
class Lines {
public:
  /// Returns the first character of the next line, '\n' for an empty line, 0 if there is none.
  char next() {
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    while (open_ && ::poll(&ready, 1, 0) > 0) {
      char c = 0;
      open_ = ::read(STDIN_FILENO, &c, 1) == 1;
      if (!open_) break;
      if (first_ == 0) first_ = c;
      if (c == '\n') return std::exchange(first_, 0);
    }
    return 0;
  }

private:
  bool open_ = true;
  char first_ = 0;
};

/// Prints the changes of a step's view. On a terminal the feedback stays on one line.
class Page {
public:
  void show(const SetupView& view) {
    if (view.refusal != shown_.refusal && !view.refusal.empty()) line("  ! " + view.refusal);
    if (view.task != shown_.task && !view.task.empty()) line("  " + view.task);
    if (view.feedback != shown_.feedback && terminal_) {
      std::printf("\r\033[K    %s", view.feedback.c_str());
      open_line_ = true;
    }
    if (view.done && !shown_.done) line("  = " + view.result);
    shown_ = view;
    std::fflush(stdout);
  }

private:
  void line(const std::string& text) {
    std::printf("%s%s\n", std::exchange(open_line_, false) ? "\n" : "", text.c_str());
  }
  bool terminal_ = ::isatty(STDOUT_FILENO), open_line_ = false;
  SetupView shown_;
};

/// Polls the tracker in real time and collects the user's fiducial inputs.
class Bench {
public:
  explicit Bench(const std::string& uri)
      : uri_(uri),
        sensor_(open_tracker(sensor_uri(uri, false))),
        offset_s_(sensor_.tracker().live() ? 0 : steady_now_s()) {}

  /// @param name  of kSetupSteps
  void run(std::string_view name, SetupStep& step) {
    Page page;
    std::string problem;
    page.show(view(step));
    while (!step.view().done) {
      if (RehearsalTracker* hand = sensor_.tracker().rehearsed()) hand->follow(name, step.view());
      if (next_ == samples_.size()) wait(step, problem);
      // Remaining samples belong to the next step.
      while (next_ < samples_.size() && !step.view().done) {
        step.feed(presses_.only_pressed(samples_[next_++]));
        page.show(view(step));
      }
      page.show(view(step));
    }
  }

private:
  /// Returns the step's view, with what the made-up hand of a rehearsal does.
  SetupView view(const SetupStep& step) {
    SetupView shown = step.view();
    if (const RehearsalTracker* hand = sensor_.tracker().rehearsed(); hand && !shown.done)
      shown.feedback = hand->doing() + (shown.feedback.empty() ? "" : " " + shown.feedback);
    return shown;
  }

  void wait(SetupStep& step, std::string& problem) {
    if (sensor_.tracker().state().condition == TrackerCondition::finished)
      throw InputError("tracker '" + uri_ + "'", "", "it ended before the step was done: " + step.view().task,
                       step.view().refusal.empty() ? "record the whole step" : step.view().refusal);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    samples_.clear();
    next_ = 0;
    const double now_s = steady_now_s() - offset_s_;
    sensor_.poll(now_s, samples_);
    if (std::string now = sensor_.tracker().state().problem; now != problem) {
      problem = std::move(now);
      if (!problem.empty()) std::fprintf(stderr, "%s\n", problem.c_str());
    }
    if (const char entered = lines_.next()) entered == 'u' ? step.undo() : step.mark(sensor_.tracker().clock_s(now_s));
  }

  std::string uri_;
  SensorTracker sensor_;
  double offset_s_;
  Lines lines_;
  ButtonPresses presses_{
      0};  ///< shared by all steps: a button that ends one step and is still held does not trigger in the next
  std::vector<SensorSample> samples_;
  std::size_t next_ = 0;
};

SetupInput given_of(const CalibrateRequest& request) {
  SetupInput given;
  given.moved = request.moved;
  if (!request.drawing.empty()) given.drawing = read_probe_drawing(request.drawing);
  given.landmarks = read_landmark_list(request.landmarks.empty() ? assets_folder() / "calibration" / "abdomen.toml"
                                                                 : request.landmarks);
  return given;
}

int calibrate(const CalibrateRequest& request) {
  check_can_be_calibrated(request.uri);
  Calibration calibration = calibration_to_continue(request.out, tracker_identity(request.uri));
  const SetupInput given = given_of(request);
  std::vector<std::string> steps = request.steps;
  if (steps.empty()) steps.assign(kSetupSteps.begin(), kSetupSteps.end());
  Bench bench(request.uri);
  std::printf("Mark: press Enter, or a button of the tracker. u and Enter takes the last mark back.\n");
  for (const std::string& name : steps) {
    if (const std::string why = why_not_yet(name, calibration, given); !why.empty())
      throw InputError(request.out.string(), name, why.substr(0, why.size() - 1),  // without its full stop
                       "make the steps in the order that --help shows");
    const std::unique_ptr<SetupStep> step = begin_setup_step(name, calibration, given);
    std::printf("\n%s\n", step->view().title.c_str());
    if (name == "face" && given.drawing && !step->view().done)
      throw InputError(request.drawing.string(), "", step->view().refusal, "correct the drawing, or leave it out");
    bench.run(name, *step);
    step->store(calibration, std::int64_t(std::time(nullptr)));
    // Written after each step, so that abandoning a later step loses nothing.
    write_calibration(request.out, calibration);
  }
  const std::string missing = why_incomplete(calibration);
  std::printf("\nwrote %s%s\n", request.out.string().c_str(),
              missing.empty() ? "" : ("; the step '" + missing + "' is still to be made").c_str());
  return 0;
}

}  // namespace

Command calibrate_command(CLI::App& program) {
  const auto request = std::make_shared<CalibrateRequest>();
  CLI::App* parser = program.add_subcommand("calibrate",
                                            "Find how tracker, probe and mannequin lie relative to each other, step by "
                                            "step, as docs/calibration.md describes");
  parser->add_option("STEP", request->steps, "Make these steps")
      ->type_name("NAME")
      ->default_str("all of them, in this order")
      ->check(CLI::IsMember(std::vector<std::string>(kSetupSteps.begin(), kSetupSteps.end())));
  parser
      ->add_option("--tracker", request->uri,
                   "Use this tracker, which has the sensor on the probe; 'list' shows the forms of a URI")
      ->required()
      ->type_name("URI");
  parser->add_option("--out", request->out, "Write the calibration to this file, and keep the steps that it has")
      ->required()
      ->type_name("FILE");
  parser->add_option("--landmarks", request->landmarks, "Use these landmarks of the patient")
      ->type_name("FILE")
      ->default_str("those of the built-in patient");
  parser
      ->add_option("--drawing", request->drawing, "Use this drawing of the probe, so that its face need not be touched")
      ->type_name("FILE");
  parser->add_flag(
      "--moved", request->moved,
      "Touch the same places as last time in the step landmarks, because the base or the mannequin was moved");
  return {parser, [request] { return calibrate(*request); }};
}

}  // namespace insonate::devices
