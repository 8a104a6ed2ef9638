#include "app/session/loading.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace insonate {
namespace {

/// Thrown from a progress report to end an abandoned loading.
struct GivenUp {};

std::atomic<int> threads_given_up = 0;

}  // namespace

struct Loading::Shared {
  std::mutex mutex;
  std::condition_variable ended;
  Progress progress;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now(), reported = began;  // progress.what
  double first_share = 0;
  std::shared_ptr<const LoadedCase> loaded_case;
  std::exception_ptr error;
  bool done = false, given_up = false;

  void report(const std::string& what, double share) {
    const std::lock_guard lock(mutex);
    if (given_up) throw GivenUp();
    reported = std::chrono::steady_clock::now();
    if (what != progress.what) {
      began = reported;
      first_share = share;
    }
    progress = {what, share, std::nullopt};
  }

  void run(const Load& load) {
    std::shared_ptr<const LoadedCase> loaded;
    std::exception_ptr thrown;
    try {
      loaded = load([this](const std::string& what, double share) { report(what, share); });
    } catch (...) {
      thrown = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    if (given_up) return;
    loaded_case = std::move(loaded);
    error = std::move(thrown);
    ended.notify_all();
  }
};

Loading::Loading(Load load) : shared_(std::make_shared<Shared>()) {
  std::thread([shared = shared_, load = std::move(load)]() mutable {
    shared->run(load);
    load = nullptr;
    const bool was_given_up = [&] {
      const std::lock_guard lock(shared->mutex);
      return shared->given_up;
    }();
    shared.reset();
    if (was_given_up) --threads_given_up;
  }).detach();
}

Loading::~Loading() {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->done) return;
  shared_->given_up = true;
  ++threads_given_up;
}

Loading::Progress Loading::progress() const {
  const std::lock_guard lock(shared_->mutex);
  const std::chrono::duration<double> until_report = shared_->reported - shared_->began,
                                      since_report = std::chrono::steady_clock::now() - shared_->reported;
  Progress progress = shared_->progress;
  progress.left_s = time_left_s(until_report.count(), shared_->first_share, progress.share);
  if (progress.left_s) progress.left_s = std::max(0.0, *progress.left_s - since_report.count());
  return progress;
}

bool Loading::done() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->done;
}

std::shared_ptr<const LoadedCase> Loading::take() {
  std::unique_lock lock(shared_->mutex);
  shared_->ended.wait(lock, [this] { return shared_->done; });
  if (shared_->error) std::rethrow_exception(shared_->error);
  return shared_->loaded_case;
}

std::optional<double> time_left_s(double elapsed_s, double first_share, double share) {
  constexpr double kMin_s = 1, kMinShare = 0.03;
  const double done = share - first_share;
  if (elapsed_s < kMin_s || done < kMinShare) return std::nullopt;
  return elapsed_s * (1 - share) / done;
}

int Loading::given_up() {
  return threads_given_up;
}

int leave_program(int exit_code) {
  if (Loading::given_up() == 0) return exit_code;
  std::fflush(stdout);
  std::fflush(stderr);
  std::_Exit(exit_code);
}

}  // namespace insonate
