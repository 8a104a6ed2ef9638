#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <thread>

#include "sim/core/image.h"

namespace insonate {

/// Makes a silent WebM clip (VP8) of pictures as they are shown. Encodes on its own thread, so that drawing never
/// waits: pictures that come faster than it encodes are left out. The file appears when the clip is complete; a program
/// that is killed before leaves none.
class ClipRecorder {
public:
  /// A longer clip is ended by itself, because it is kept in memory: at most some 120 MB.
  static constexpr double kLongest_s = 120;

  ClipRecorder() = default;
  /// Drops a clip that is not complete.
  ~ClipRecorder();
  ClipRecorder(const ClipRecorder&) = delete;
  ClipRecorder& operator=(const ClipRecorder&) = delete;

  /// Begins a clip. Waits for the one before.
  /// @param stem  the file's name without ".webm"; if it is taken by then, the first free one of NAME-2, NAME-3...
  void start(const std::filesystem::path& stem);
  /// Ends the clip. The thread writes the file in the background.
  void stop();
  /// Ends the clip at a time until which its last picture was seen.
  void stop(double time_s);
  bool running() const { return running_; }
  /// Returns the time from the clip's first picture to its last (s).
  double duration_s() const { return last_s_ - first_s_; }

  /// Adds a picture. A clip has the size of its first picture; others are cut or get a black edge, and keep their
  /// middle.
  /// @param time_s  on any clock that rises
  /// @return whether it is in the clip: not if it is left out
  bool take(const Image<Rgba8>& picture, double time_s);

  /// Waits until the file of a stopped clip is written.
  void wait();
  /// Returns the file of the last clip, once, when it is complete. Throws, once, what has prevented it.
  std::optional<std::filesystem::path> take_finished();

private:
  struct Picture {
    Image<Rgba8> image;
    double time_s;
  };
  class Encoder;

  void run(const std::filesystem::path& stem);
  bool enqueue(Image<Rgba8> picture, double time_s);

  bool running_ = false, any_ = false;
  Image<Rgba8> last_;  ///< picture that was taken
  double first_s_ = 0, last_s_ = 0;

  std::mutex mutex_;  ///< held to move pictures, never to encode
  std::condition_variable changed_;
  std::deque<Picture> waiting_;
  bool ending_ = false, dropped_ = false;
  std::optional<std::filesystem::path> finished_;
  std::exception_ptr problem_;
  std::jthread thread_;
};

}  // namespace insonate
