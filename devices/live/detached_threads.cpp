#include "devices/live/detached_threads.h"

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

namespace insonate {
namespace {

struct Left {
  std::mutex mutex;
  std::vector<std::jthread> threads;  // their destructors join them
  std::atomic<int> waiting{0};
};

Left& left() {
  static Left all;
  return all;
}

}  // namespace

void detach_thread(std::jthread thread) {
  const std::lock_guard lock(left().mutex);
  left().threads.push_back(std::move(thread));
}

void join_detached_threads(const std::stop_token& stop) {
  std::vector<std::jthread> threads;
  {
    const std::lock_guard lock(left().mutex);
    // Checked under the lock: a thread is asked to end before it is put into the list.
    if (!stop.stop_requested()) threads.swap(left().threads);
  }
  if (threads.empty()) return;
  ++left().waiting;
  threads.clear();
  --left().waiting;
}

int waiting_for_detached_threads() {
  return left().waiting;
}

}  // namespace insonate
