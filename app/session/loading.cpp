#include "app/session/loading.h"

#include <atomic>
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
  std::shared_ptr<const LoadedCase> loaded_case;
  std::exception_ptr error;
  bool done = false, given_up = false;

  void report(const std::string& what, double share) {
    const std::lock_guard lock(mutex);
    if (given_up) throw GivenUp();
    progress = {what, share};
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
  return shared_->progress;
}

bool Loading::done() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->done;
}

std::shared_ptr<const LoadedCase> Loading::take() {
  std::unique_lock lock(shared_->mutex);
  shared_->ended.wait(lock, [this] { return shared_->done; });
  if (shared_->error) std::rethrow_exception(shared_->error);
  return std::move(shared_->loaded_case);
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
