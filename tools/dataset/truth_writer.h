#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "sim/core/image.h"
#include "tools/dataset/shard_file.h"
#include "tools/dataset/shots.h"

namespace insonate {

/// Computes the truth of pictures, and encodes and writes them, on a thread of its own. So drawing goes on meanwhile.
class TruthWriter {
public:
  /// Most bytes of pictures that wait: 128 pictures of 512 x 512. Drawing waits only if this thread is behind by as
  /// many, and always lets one wait.
  static constexpr std::size_t kMaxWaiting = std::size_t(1) << 25;

  /// Keeps references to both. The thread alone uses them until finish() returns.
  /// @param first_image  of the shard
  TruthWriter(TruthMaker& truth, ShardWriter& writer, std::uint32_t first_image);
  /// Drops what waits.
  ~TruthWriter();

  /// Hands a picture over. Throws what the thread has thrown.
  void put(Shot&& shot, Image<std::uint8_t>&& grey);
  /// Waits until everything is written. Throws what the thread has thrown.
  void finish();

private:
  struct Picture {
    Shot shot;
    Image<std::uint8_t> grey;
  };
  void run();
  void rethrow();

  TruthMaker& truth_;
  ShardWriter& writer_;
  std::uint32_t first_image_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Picture> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool closed_ = false, dropped_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace insonate
