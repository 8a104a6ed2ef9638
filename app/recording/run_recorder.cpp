#include "app/recording/run_recorder.h"

#include <optional>
#include <utility>

#include "app/recording/run_files.h"

namespace insonate {
namespace {

/// Limit of the data that waits to be written: several seconds of pictures, and hours of samples.
constexpr std::size_t kMaxBytes = std::size_t(64) << 20;

std::size_t bytes_of(const DrawnPicture& picture) {
  return picture.grey.pixels.size();
}

}  // namespace

/// Runs the jobs on the writing thread.
class RunRecorder::Writer {
public:
  explicit Writer(bool with_pictures) : with_pictures_(with_pictures) {}

  void operator()(const Start& start) {
    files_.emplace(start.file, start.exactly, with_pictures_);
    written_ = {files_->file()};
  }
  void operator()(const Stop&) {
    if (!files_) return;
    files_->finish();
    files_.reset();
    finished_ = std::exchange(written_, {});
  }
  void operator()(const Next&) {
    if (!files_) return;
    files_->begin_next();
    written_.push_back(files_->file());
  }
  void operator()(const Samples& taken) {
    if (files_) files_->add(taken.samples, taken.actions);
  }
  void operator()(const DrawnPicture& picture) {
    if (files_) files_->add(picture);
  }

  /// Stops writing; what was written until then stays.
  void give_up() { files_.reset(); }
  std::filesystem::path file() const { return files_ ? files_->file() : std::filesystem::path(); }
  /// Returns the files of a recording that has been finished since the last call.
  std::vector<std::filesystem::path> take_finished() { return std::exchange(finished_, {}); }

private:
  bool with_pictures_;
  std::optional<RunFiles> files_;
  std::vector<std::filesystem::path> written_, finished_;
};

RunRecorder::~RunRecorder() {
  stop();
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
}

void RunRecorder::start(const std::filesystem::path& file, bool exactly) {
  if (std::exchange(running_, true)) return;
  attempt_ = named_in_ = 0;
  begun_ = has_samples_ = false;
  start_s_ = last_s_ = 0;
  left_out_ = 0;
  if (!thread_.joinable()) thread_ = std::jthread([this] { run(); });
  enqueue(Start{file, exactly});
}

void RunRecorder::stop() {
  if (std::exchange(running_, false)) enqueue(Stop{});
}

void RunRecorder::take(const Session& session) {
  if (!running_) return;
  if (!std::exchange(begun_, true))
    start_s_ = session.now_s();
  else if (attempt_ != session.attempt())
    enqueue(Next{});
  attempt_ = session.attempt();
  last_s_ = session.now_s();
  const std::vector<ProbeSample>& samples = session.latest_samples();
  if (samples.empty()) return;
  ActionLog actions = session.latest_actions();
  std::vector<Action> about;
  if (std::exchange(named_in_, attempt_) != attempt_ && !session.patient().empty())
    about.push_back({ActionKind::patient, {}, session.patient()});
  if (!std::exchange(has_samples_, true) && !session.latest_begin_attempt()) {
    const std::vector<Action> settings = session.settings();
    about.insert(about.end(), settings.begin(), settings.end());
  }
  if (!about.empty()) {
    std::vector<Action>& first = actions[samples.front().time_s];
    first.insert(first.begin(), about.begin(), about.end());
  }
  enqueue(Samples{samples, std::move(actions)});
}

void RunRecorder::take(const DrawnPicture& picture) {
  if (!wants_pictures() || picture.attempt != attempt_) return;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_bytes_ + bytes_of(picture) > kMaxBytes) {
      ++left_out_;
      return;
    }
    waiting_bytes_ += bytes_of(picture);
  }
  enqueue(picture);
}

void RunRecorder::check() {
  std::exception_ptr problem;
  {
    const std::lock_guard lock(mutex_);
    problem = std::exchange(problem_, nullptr);
  }
  if (!problem) return;
  running_ = false;
  std::rethrow_exception(problem);
}

void RunRecorder::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty() && !busy_; });
}

std::vector<std::filesystem::path> RunRecorder::take_finished() {
  const std::lock_guard lock(mutex_);
  return std::exchange(finished_, {});
}

std::filesystem::path RunRecorder::file() const {
  const std::lock_guard lock(mutex_);
  return file_;
}

void RunRecorder::enqueue(Job job) {
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  changed_.notify_all();
}

void RunRecorder::run() {
  Writer write(with_pictures_);
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return !jobs_.empty() || ending_; });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    lock.unlock();
    std::exception_ptr problem;
    try {
      std::visit(write, job);
    } catch (...) {
      problem = std::current_exception();
      write.give_up();
    }
    const std::filesystem::path file = write.file();
    std::vector<std::filesystem::path> finished = write.take_finished();
    lock.lock();
    busy_ = false;
    if (const auto* picture = std::get_if<DrawnPicture>(&job)) waiting_bytes_ -= bytes_of(*picture);
    if (problem) problem_ = problem;
    if (!file.empty()) file_ = file;
    if (!finished.empty()) finished_ = std::move(finished);
    changed_.notify_all();
  }
}

}  // namespace insonate
