#include "tools/dataset/truth_writer.h"

#include <utility>

namespace insonate {

TruthWriter::TruthWriter(TruthMaker& truth, ShardWriter& writer, std::uint32_t first_image)
    : truth_(truth), writer_(writer), first_image_(first_image), thread_([this] { run(); }) {}

TruthWriter::~TruthWriter() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = dropped_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void TruthWriter::put(Shot&& shot, Image<std::uint8_t>&& grey) {
  std::unique_lock lock(mutex_);
  const std::size_t bytes = grey.pixels.size();
  changed_.wait(lock, [&] { return waiting_.empty() || waiting_bytes_ + bytes <= kMaxWaiting || failure_; });
  rethrow();
  waiting_bytes_ += bytes;
  waiting_.push_back({std::move(shot), std::move(grey)});
  lock.unlock();
  changed_.notify_all();
}

void TruthWriter::finish() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
  rethrow();
}

void TruthWriter::rethrow() {
  if (failure_) std::rethrow_exception(failure_);
}

void TruthWriter::run() {
  try {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return !waiting_.empty() || closed_; });
      if (waiting_.empty() || dropped_) return;
      Picture picture = std::move(waiting_.front());
      waiting_.pop_front();
      waiting_bytes_ -= picture.grey.pixels.size();
      lock.unlock();
      changed_.notify_all();
      const std::uint32_t row = picture.shot.index - first_image_;
      writer_.put(row, with_truth(std::move(picture.shot), picture.grey, truth_));
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
  changed_.notify_all();
}

}  // namespace insonate
