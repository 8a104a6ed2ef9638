#include "app/headless.h"

#include <imgui.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include "app/panels/screen.h"
#include "app/recording/run_files.h"
#include "app/trainer/trainer.h"
#include "devices/live/steady_clock.h"
#include "scenarios/words.h"
#include "sim/files/new_folder.h"
#include "sim/files/png.h"
#include "sim/gl/headless_context.h"

namespace insonate {
namespace {

/// Step of the session's clock, that of a typical screen; scores do not depend on it. The loop does not wait for real
/// time, unless the tracker is live or an OpenIGTLink server was requested.
constexpr double kStep_s = 1.0 / 30;
/// Duration of a session without an exam if none is given.
constexpr double kFreeScan_s = 10;

/// The screen without a window.
class OffScreen {
public:
  OffScreen(int width, int height) : width_(width), height_(height) {}

  /// Draws the ultrasound alone, as the probe's movement shows it.
  void draw_ultrasound(Trainer& trainer) {
    PictureSizes sizes = picture_sizes(trainer);
    sizes.volume_width = sizes.slice_width = sizes.blend_width = 0;
    sizes.axis_slices = {};
    trainer.draw(sizes);
  }

  /// Draws the whole screen, with the pictures of a probe at rest.
  Image<Rgba8> draw(Trainer& trainer) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(float(width_), float(height_));
    io.DeltaTime = float(kStep_s);
    Effort effort;
    effort.at_rest = true;
    // ImGui lays out a new window in its first frame but does not show it.
    for (int frame = 0; frame < 3; ++frame) {
      trainer.draw(picture_sizes(trainer), effort);
      screen_.render(trainer);
    }
    return screen_.read();
  }

private:
  PictureSizes picture_sizes(const Trainer& trainer) {
    return screen_.picture_sizes(trainer, float(width_), float(height_));
  }

  int width_, height_;
  ui::Screen screen_;
};

void sleep_until(double then_s) {
  const double left_s = then_s - steady_now_s();
  if (left_s > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left_s));
}

void print_result(const ExamResult& result) {
  std::printf("%s: %s, %s %% (%.2f of %.2f points, %s %% are needed)\n", result.title.c_str(),
              result.passed ? "passed" : "not passed", percentage(result).c_str(), result.points,
              result.points_possible, short_number(result.pass_mark_percent).c_str());
  for (const std::string& reason : result.reasons) std::printf("  %s\n", reason.c_str());
}

void print_file(const std::filesystem::path& file) {
  std::printf("wrote %s\n", file.string().c_str());
}

/// Leaves the screen at the requested time of the run, or at its end.
int show_replay(Trainer& trainer, OffScreen& screen, const Options& options) {
  Replay& replay = *trainer.replay();
  replay.seek(options.seconds > 0 ? options.seconds : replay.run().duration_s());
  const std::filesystem::path file = options.screenshot.empty() ? options.out / "trainer.png" : options.screenshot;
  write_png(file, screen.draw(trainer));
  print_file(file);
  return 0;
}

}  // namespace

int run_headless(const Options& options) {
  const gl::HeadlessContext context;
  Trainer trainer(options);
  trainer.open_from_options();
  trainer.finish_loading();
  OffScreen screen(options.width, options.height);
  if (trainer.replay()) return show_replay(trainer, screen, options);
  refuse_unwritable(options.out / "pictures");  // which come at the end

  const Session& session = *trainer.session();
  const double end_s = options.seconds > 0 ? options.seconds : session.runner() ? 0 : kFreeScan_s;
  std::optional<Image<Rgba8>> held_screen;
  const bool live = session.source().live(), watched = !options.igtl_server.empty(),
             seen = watched || options.record_images || !options.latency.empty();
  if (watched) {
    const igtl::Address address = trainer.feed()->server().address();
    std::printf("Sends poses and pictures by OpenIGTLink at %s, port %d.\n", address.text().c_str(),
                int(address.port()));
    std::fflush(stdout);
  }
  const double start_s = steady_now_s();
  for (long step = 0;; ++step) {
    const double now_s = double(step) * kStep_s;
    if (live || watched) sleep_until(start_s + now_s);
    trainer.update(live ? steady_now_s() : now_s);
    if (seen) screen.draw_ultrasound(trainer);
    if (trainer.best_frame_due()) {
      const Image<Rgba8> now = screen.draw(trainer);
      if (!session.result()) held_screen = now;  // once there is a result, the score sheet covers the screen
      trainer.keep_best_frame();
    }
    if (session.result() || (end_s > 0 && now_s >= end_s)) break;
  }
  trainer.hand_in_exam();

  const Image<Rgba8> last_screen = screen.draw(trainer);
  if (trainer.recorder().running()) {
    trainer.finish_recording();
    const std::filesystem::path recording = trainer.recorder().file();
    print_file(recording);
    std::error_code error;
    if (options.record_images && std::filesystem::exists(images_of(recording), error)) print_file(images_of(recording));
  }
  if (!trainer.raw_file().empty()) print_file(trainer.raw_file());
  if (!options.latency.empty()) {
    trainer.latency().write(options.latency);
    std::printf("%s", trainer.latency().text().c_str());
    print_file(options.latency);
  }
  const std::filesystem::path trainer_png = options.out / "trainer.png", sheet_png = options.out / "score_sheet.png",
                              picture_png = options.out / "ultrasound.png";
  if (session.result()) {
    trainer.write_results_if_due();
    print_result(*session.result());
    for (const std::filesystem::path& file : trainer.result_files()->all()) print_file(file);
    write_png(sheet_png, screen.draw(trainer));
    print_file(sheet_png);
  } else {
    std::printf("ended after %.1f s, before there was anything to score\n", end_s);
  }
  std::optional<Image<Rgba8>> picture;
  if (const Image<Rgba8>* best = trainer.best_frame()) picture = *best;
  if (!picture && trainer.pictures().ultrasound()) picture = mirrored(read_back(*trainer.pictures().ultrasound()));
  if (picture) {
    write_png(picture_png, *picture);
    print_file(picture_png);
  }
  write_png(trainer_png, held_screen.value_or(last_screen));
  print_file(trainer_png);
  if (!options.screenshot.empty()) {
    write_png(options.screenshot, session.result() ? screen.draw(trainer) : last_screen);
    print_file(options.screenshot);
  }
  return 0;
}

}  // namespace insonate
