// A hand-over from thread to thread as in sample_ring.h, but with relaxed orders: a data race, put here on purpose.

#include <atomic>
#include <cstdio>
#include <thread>

int main() {
  int item = 0;
  std::atomic<bool> written{false};
  std::thread writer([&] {
    item = 7;
    written.store(true, std::memory_order_relaxed);
  });
  while (!written.load(std::memory_order_relaxed)) std::this_thread::yield();
  std::printf("%d\n", item);
  writer.join();
}
