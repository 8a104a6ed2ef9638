#include "tools/python/graphics_thread.h"

#include <unistd.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <future>
#include <mutex>
#include <optional>
#include <thread>

#include "sim/core/input_error.h"
#include "sim/gl/headless_context.h"

namespace insonate::python {
namespace {

/// The thread lives as long as the process: a context may not be closed while Python still destroys simulators.
class GraphicsThread {
public:
  GraphicsThread() {
    std::thread([this] { run(); }).detach();
  }

  void put(std::function<void()> task) {
    {
      const std::lock_guard lock(mutex_);
      tasks_.push_back(std::move(task));
    }
    changed_.notify_one();
  }
  pid_t process() const { return process_; }
  /// Opens the context if it is not open. For the thread itself.
  void need_context() {
    if (!context_) context_.emplace();
  }

private:
  void run() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return !tasks_.empty(); });
      const std::function<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
    }
  }

  const pid_t process_ = getpid();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::optional<gl::HeadlessContext> context_;
};

GraphicsThread& graphics_thread() {
  static GraphicsThread* const thread = new GraphicsThread;
  return *thread;
}

}  // namespace

void on_graphics_thread(const std::function<void()>& work) {
  GraphicsThread& thread = graphics_thread();
  if (thread.process() != getpid())
    throw InputError("insonate", "", "this process was forked from one that has used OpenGL, which cannot be shared",
                     "start processes by spawn, as multiprocessing.set_start_method(\"spawn\") does");
  std::promise<void> done;
  std::future<void> result = done.get_future();
  const pybind11::gil_scoped_release without_lock;
  thread.put([&] {
    try {
      thread.need_context();
      work();
      done.set_value();
    } catch (...) {
      done.set_exception(std::current_exception());
    }
  });
  result.get();
}

void destroy_on_graphics_thread(std::shared_ptr<void> object) {
  GraphicsThread& thread = graphics_thread();
  if (thread.process() != getpid()) {
    new std::shared_ptr<void>(std::move(object));  // its context is the parent's
    return;
  }
  thread.put([held = std::move(object)]() mutable { held.reset(); });
}

}  // namespace insonate::python
