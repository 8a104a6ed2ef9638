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

/// Records the samples of a session's sources, and on request the ultrasound pictures, to files (RunFiles). Writes on
/// its own thread, so that drawing never waits for a disk. New files begin when the exam starts over, the probe changes
/// hands or another session begins.
///
/// All samples are recorded, with their actions. Pictures are recorded as far as the disk keeps up. A recording that
/// begins in the middle of a run starts with the current settings of the machine.
class RunRecorder {
public:
  /// @param with_pictures  whether each run is recorded with its pictures
  explicit RunRecorder(bool with_pictures) : with_pictures_(with_pictures) {}
  /// Ends the recording and waits for its files.
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// Starts recording.
  /// @param exactly  whether to use this very file; otherwise the next free name: FILE, FILE-2, FILE-3...
  void start(const std::filesystem::path& file, bool exactly);
  /// Ends the recording. The thread finishes the files in the background.
  void stop();
  bool running() const { return running_; }
  bool wants_pictures() const { return running_ && with_pictures_; }

  /// To be called after each Session::advance().
  void take(const Session& session);
  void take(const DrawnPicture& picture);
  /// To be called when another session begins.
  void begin_anew() { attempt_ = named_in_ = 0; }

  /// Throws, once, the error that occurred since the last call. The recording has ended then.
  void check();
  /// Waits until everything passed to the thread is written.
  void wait();

  /// Returns the files of the last recording, in order, once they are complete; empty until then and afterwards.
  std::vector<std::filesystem::path> take_finished();
  /// Returns the last file that was begun; empty before the first.
  std::filesystem::path file() const;
  /// Returns how long the recording has run on the session's clock (s).
  double duration_s() const { return last_s_ - start_s_; }
  /// Returns the number of pictures skipped since the recording started because the disk was too slow.
  std::size_t left_out() const { return left_out_; }

private:
  struct Start {
    std::filesystem::path file;
    bool exactly;
  };
  struct Stop {};
  struct Next {};
  struct Samples {
    std::vector<ProbeSample> samples;
    ActionLog actions;
  };
  using Job = std::variant<Start, Stop, Next, Samples, DrawnPicture>;
  class Writer;

  void enqueue(Job job);
  void run();

  const bool with_pictures_;
  bool running_ = false;
  int attempt_ = 0;   ///< attempt of the session that the current file records; 0: none yet
  int named_in_ = 0;  ///< the attempt whose file names its patient
  bool begun_ = false, has_samples_ = false;
  double start_s_ = 0, last_s_ = 0;
  std::size_t left_out_ = 0;

  mutable std::mutex mutex_;  ///< held to move pointers, never during file access
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::size_t waiting_bytes_ = 0;  ///< size of the pictures in jobs_
  bool busy_ = false, ending_ = false;
  std::exception_ptr problem_;
  std::filesystem::path file_;
  std::vector<std::filesystem::path> finished_;
  std::jthread thread_;
};

}  // namespace insonate
