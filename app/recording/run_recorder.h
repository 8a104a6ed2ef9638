#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <variant>
#include <vector>

#include "app/pictures/picture_reader.h"
#include "app/session/session.h"

namespace insonate {

/// Records what a session's sources say, and on request the ultrasound that was drawn of it, to files (RunFiles) that a
/// thread of its own writes: whoever draws never waits for a disk. When the exam starts over, the probe changes hands
/// or another session begins, other files follow.
///
/// Samples are handed over all, with the actions that go with them; of pictures those that the disk keeps up with. A
/// recording that begins in the middle of a run begins with how the machine is set then.
class RunRecorder {
public:
  /// @param with_pictures  each run is recorded with its pictures
  explicit RunRecorder(bool with_pictures) : with_pictures_(with_pictures) {}
  /// Ends the recording and waits for its files.
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// Starts recording. @param exactly  to this very file, else to the next free name: FILE, FILE-2, FILE-3...
  void start(const std::filesystem::path& file, bool exactly);
  /// Ends it; its files are made meanwhile.
  void stop();
  bool running() const { return running_; }
  bool wants_pictures() const { return running_ && with_pictures_; }

  /// To be called after each Session::advance().
  void take(const Session& session);
  void take(const DrawnPicture& picture);
  /// To be called when another session begins.
  void begin_anew() { attempt_ = 0; }

  /// Throws, once, what went wrong since the last call; nothing is recorded any more then.
  void check();
  /// Waits until everything is written that was handed over.
  void wait();

  /// The last file that was begun; empty before the first.
  std::filesystem::path file() const;
  /// How long the recording has run on the session's clock (s).
  double duration_s() const { return last_s_ - start_s_; }
  /// Pictures that were left out since the recording started, as the disk was too slow.
  std::size_t left_out() const { return left_out_; }

private:
  struct Start {
    std::filesystem::path file;
    bool exactly;
  };
  struct Stop {};
  struct Next {};
  struct Samples {
    std::vector<PoseSample> samples;
    ActionLog actions;
  };
  using Job = std::variant<Start, Stop, Next, Samples, DrawnPicture>;
  class Writer;

  void conditioner(Job job);
  void run();

  const bool with_pictures_;
  bool running_ = false;
  int attempt_ = 0;  ///< of the session, that the current file is of; 0: of none yet
  bool begun_ = false, has_samples_ = false;
  double start_s_ = 0, last_s_ = 0;
  std::size_t left_out_ = 0;

  mutable std::mutex mutex_;  ///< held to move pointers, never while a file is touched
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::size_t waiting_bytes_ = 0;  ///< of the pictures among them
  bool busy_ = false, ending_ = false;
  std::exception_ptr problem_;
  std::filesystem::path file_;
  std::jthread thread_;
};

}  // namespace insonate
