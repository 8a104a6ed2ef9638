#include "devices/live/paced_source.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "devices/live/steady_clock.h"

namespace insonate {

PacedSource::PacedSource(std::string name, std::function<ProbeSample(std::uint64_t)> sample, double rate_hz)
    : name_(std::move(name)), sample_(std::move(sample)), rate_hz_(rate_hz) {}

void PacedSource::read(std::chrono::milliseconds timeout, LiveBatch& batch) {
  if (!start_s_) start_s_ = steady_now_s();
  const double next_s = *start_s_ + double(given()) / rate_hz_;
  const double wait_s = std::min(next_s - steady_now_s(), std::chrono::duration<double>(timeout).count());
  if (wait_s > 0) std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
  while (*start_s_ + double(given()) / rate_hz_ <= steady_now_s()) {
    ProbeSample sample = sample_(given());
    sample.time_s = steady_now_s();
    batch.samples.push_back(sample);
    given_.fetch_add(1, std::memory_order_relaxed);
  }
}

}  // namespace insonate
