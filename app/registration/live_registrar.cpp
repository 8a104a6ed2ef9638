#include "app/registration/live_registrar.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/gl/headless_context.h"

namespace insonate {
namespace {

constexpr int kPlaces = 16;                    // per call: 0.6 s of two cores without a graphics card
constexpr std::size_t kImagesToSearch = 20;    // of a wide search that nobody has asked for, if it takes as many
constexpr double kSamePlace_mm = 8;            // as SweepRegistrar counts ends as one
constexpr double kNear_mm = 6, kNear_deg = 6;  // how far a round looks around the estimate before it is confirmed
constexpr int kNearScattered = 64;
constexpr int kNiceness = 10;  // a tenth of the processor beside a program that takes all of it
constexpr auto kGlance = std::chrono::milliseconds(2);
constexpr auto kLongestHold = std::chrono::milliseconds(200);

/// A round that is not worth going on with.
struct Abandoned : std::exception {};

}  // namespace

std::string_view to_string(LiveRegistrar::Work work) {
  switch (work) {
    case LiveRegistrar::Work::waiting:
      return "waiting";
    case LiveRegistrar::Work::preparing:
      return "preparing";
    case LiveRegistrar::Work::refining:
      return "refining";
    case LiveRegistrar::Work::searching:
      return "searching";
    case LiveRegistrar::Work::resting:
      return "resting";
    case LiveRegistrar::Work::failed:
      break;
  }
  return "failed";
}

std::string to_string(const LiveRegistrar::Needs& needs) {
  return std::to_string(needs.images) + ", of which two lie " + formatted("%.0f", needs.spread_mm) + " mm apart";
}

LiveRegistrar::LiveRegistrar(const AcousticVolume& volume, const Probe& probe, double depth_mm, const glm::dmat4& start,
                             const LiveRegistrarSettings& settings, Prepare prepare)
    : volume_(volume), start_(start), settings_(settings), prepare_(std::move(prepare)), window_(probe, depth_mm) {
  settings_.search.batch = kPlaces;
  state_.ct_from_sweep = start;
  thread_ = std::thread([this] { run(); });
}

LiveRegistrar::~LiveRegistrar() {
  end();
  thread_.join();
}

void LiveRegistrar::end() {
  ending_ = true;
  changed_.notify_all();
}

void LiveRegistrar::add(SweepImage image) {
  {
    const std::lock_guard lock(mutex_);
    window_.add(std::move(image));
    state_.kept = window_.size();
  }
  changed_.notify_all();
}

void LiveRegistrar::refine(bool on) {
  {
    const std::lock_guard lock(mutex_);
    refines_ = on;
  }
  changed_.notify_all();
}

bool LiveRegistrar::refines() const {
  const std::lock_guard lock(mutex_);
  return refines_;
}

void LiveRegistrar::search_widely() {
  {
    const std::lock_guard lock(mutex_);
    wants_wide_ = true;
    refused_ = false;
  }
  changed_.notify_all();
}

void LiveRegistrar::reset() {
  {
    const std::lock_guard lock(mutex_);
    ++epoch_;
    wants_wide_ = has_wide_ = is_settled_ = refused_ = false;
    done_window_ = 0;
    state_.ct_from_sweep = start_;
    state_.last.reset();
    state_.rounds = 0;
  }
  changed_.notify_all();
}

LiveRegistrar::State LiveRegistrar::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

bool LiveRegistrar::is_outdated(const Task& task) const {
  const std::lock_guard lock(mutex_);
  return task.epoch != epoch_ || (!task.wide && (wants_wide_ || !refines_));
}

void LiveRegistrar::give_way(const Task& task) {
  // A caller that draws without end must not stop the registration for good.
  const auto until = std::chrono::steady_clock::now() + kLongestHold;
  while (held_.load(std::memory_order_relaxed) && !ending_ && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(kGlance);
  if (ending_ || is_outdated(task)) throw Abandoned();
}

LiveRegistrar::Needs LiveRegistrar::needs(bool is_wide, bool is_asked_for) const {
  Needs needs;
  if (is_wide) needs = {insonate::kMinImages, kMinSpread_mm};
  // A search that nobody has asked for takes its time, and few images may be most similar at a wrong place.
  if (is_wide && !is_asked_for) needs.images = std::min(std::size_t(settings_.search.slices), kImagesToSearch);
  return needs;
}

/// Waits until a round is due and fills in its task. Returns false when the thread has to end.
bool LiveRegistrar::begin_round(Task& task) {
  std::unique_lock lock(mutex_);
  for (; !ending_; changed_.wait_for(lock, std::chrono::milliseconds(100))) {
    const bool is_new = window_.version() != done_window_;
    const bool is_due = wants_wide_ ? is_new || !refused_ : is_new && refines_;
    if (!is_due) {
      if (!wants_wide_ && (!refines_ || state_.work != Work::waiting)) state_.work = Work::resting;
      continue;
    }
    task.sweep = window_.chosen(std::size_t(settings_.search.slices));
    state_.in_use = task.sweep.images.size();
    state_.spread_mm = spread_mm(task.sweep);
    const bool searches = settings_.searches && !has_wide_;
    state_.needs = needs(wants_wide_ || searches, wants_wide_);
    if (state_.in_use < state_.needs.images || state_.spread_mm < state_.needs.spread_mm) {
      state_.work = Work::waiting;
      continue;
    }
    task.wide = std::exchange(wants_wide_, false) || searches;
    task.looks_around = !has_wide_ && state_.in_use == std::size_t(settings_.search.slices);
    task.from = (task.wide || is_settled_) && !searches ? state_.ct_from_sweep : start_;
    task.window = done_window_ = window_.version();
    task.epoch = epoch_;
    const double least_spread_mm = state_.needs.spread_mm;
    lock.unlock();
    std::string problem;
    try {
      task.share_left_out = prepare_(task.sweep, task.from);
    } catch (const InputError& error) {
      problem = error.what();
    }
    if (problem.empty() && (task.sweep.images.size() < kMinImages || spread_mm(task.sweep) < least_spread_mm))
      problem = "Too few of the images show what lies in the CT; move the probe.";
    lock.lock();
    if (task.epoch != epoch_) continue;
    state_.problem = problem;
    refused_ = !problem.empty();
    if (!refused_) {
      state_.in_use = task.sweep.images.size();
      state_.work = task.wide ? Work::searching : Work::refining;
      return true;
    }
    wants_wide_ |= task.wide && !searches;  // which somebody has asked for
    state_.work = Work::waiting;
  }
  return false;
}

void LiveRegistrar::end_round(const Task& task, const RegistrationSettings& settings, SweepRegistration found) {
  const std::lock_guard lock(mutex_);
  if (task.epoch != epoch_) return;
  const std::vector<glm::dvec3> targets = target_points(task.sweep);
  if (task.wide) {
    has_wide_ = found.converged();
  } else {
    std::erase(found.doubts, kNotSearched);
    if (!has_wide_)
      found.doubts.emplace_back(kNotSearched);
    else if (target_error_mm(targets, found.ct_from_sweep, confirmed_) > kSamePlace_mm)
      found.doubts.emplace_back("it has left the place that the wide search found");
    else
      std::erase(found.doubts, kTooClose);  // the wide search has told the place from others
  }
  if (task.wide && found.converged()) confirmed_ = found.ct_from_sweep;
  is_settled_ |= task.wide || task.looks_around;
  state_.ct_from_sweep = found.ct_from_sweep;
  ++state_.rounds;
  state_.last = std::make_shared<const LiveRound>(
      LiveRound{TrackedSweep(task.sweep), task.share_left_out, settings, std::move(found), gl::device_description()});
}

void LiveRegistrar::run() {
  // Of this thread, whose priority those that it makes inherit, and with them those with which llvmpipe computes.
  if (settings_.gives_way) setpriority(PRIO_PROCESS, id_t(gettid()), kNiceness);
  try {
    std::optional<gl::HeadlessContext> context;
    std::unique_ptr<SweepRegistrar> registrar;
    Task task;
    settings_.search.between_calls = [this, &task] { give_way(task); };
    while (begin_round(task)) {
      try {
        if (!registrar) {
          {
            const std::lock_guard lock(mutex_);
            state_.work = Work::preparing;
          }
          context.emplace();
          registrar = std::make_unique<SweepRegistrar>(volume_, task.sweep, settings_.search);
          const std::lock_guard lock(mutex_);
          state_.work = task.wide ? Work::searching : Work::refining;
        } else {
          registrar->set_images(task.sweep.images);
        }
        RegistrationSettings settings = settings_.search;
        if (!task.wide) {
          settings.search_mm = task.looks_around ? kNear_mm : 0;
          settings.search_deg = task.looks_around ? kNear_deg : 0;
          settings.scattered = task.looks_around ? kNearScattered : 1;
        }
        registrar->set_range(settings.search_mm, settings.search_deg, settings.scattered);
        end_round(task, settings, registrar->from(task.from));
      } catch (const Abandoned&) {
        const std::lock_guard lock(mutex_);
        done_window_ = 0;
      }
    }
    registrar.reset();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    state_.work = Work::failed;
    state_.problem = std::string("The registration has ended: ") + error.what() + ".";
  }
  has_ended_ = true;
}

}  // namespace insonate
