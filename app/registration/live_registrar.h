#pragma once

#include <glm/mat4x4.hpp>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "sim/registration/registration.h"
#include "sim/registration/sweep_window.h"
#include "sim/registration/tracked_sweep.h"
#include "sim/tissue/acoustic_volume.h"

namespace insonate {

/// A finished round of a live registration, as it is saved.
struct LiveRound {
  TrackedSweep sweep;             ///< the images that it compared
  double share_left_out = 0;      ///< of their pixels, by Prepare
  RegistrationSettings settings;  ///< with the range that it searched
  SweepRegistration found;
  std::string device;  ///< OpenGL's, that computed it
};

/// Readies the images of a round for the estimate (ct_from_sweep), on the registrar's thread. It may leave out pixels
/// and images, and returns the share of the pixels that it left out. An InputError that it throws is the problem: the
/// round waits for other images.
using Prepare = std::function<double(TrackedSweep&, const glm::dmat4&)>;

/// How a live registration searches, and what it gives way to.
struct LiveRegistrarSettings {
  RegistrationSettings search;
  bool gives_way = true;  ///< to a picture that is drawn meanwhile; false: the thread has the caller's priority
  bool searches = false;  ///< widely in each round until one has converged; search_widely() asks for one search
};

/// Refines a registration while images arrive, on a thread of its own with an OpenGL context of its own. Each round
/// takes well-spread images of the newest ones and follows the estimate by local searches. A wide search looks for
/// other places too; only one that converges makes the estimate count as converged. Until there are as many images as a
/// round takes, each round begins at the start: what few images find may be a wrong place that no later round leaves.
/// For the same reason each round with all its images looks around the estimate, until a wide search has confirmed it.
/// Without a person who can ask for a wide search, every round is one, around the start, until one converges; the first
/// begins once two images lie kMinSpread_mm apart.
///
/// The thread gives way to a picture, if there is one: it runs at a low priority, which its context's own threads
/// inherit, it evaluates few places per call, and between calls it waits while the caller draws (hold()). Beside other
/// programs that take all of the processor, what it computes may last minutes.
///
///     LiveRegistrar registrar(volume, probe, depth_mm, start, {}, prepare);
///     registrar.add(image);                      // as they come
///     show(registrar.state().ct_from_sweep);     // each frame
class LiveRegistrar {
public:
  static constexpr std::size_t kMinImages = 6;  ///< of a round

  /// What a round asks of its images.
  struct Needs {
    std::size_t images = kMinImages;
    double spread_mm = 5;  ///< least spread_mm(); of a wide search kMinSpread_mm, because it could not converge
  };

  enum class Work {
    waiting,    ///< for images, or for the probe to move
    preparing,  ///< shaders and volumes, which takes seconds
    refining,
    searching,  ///< widely
    resting,    ///< no new images, or refining is off
    failed,     ///< for good
  };

  struct State {
    Work work = Work::waiting;
    glm::dmat4 ct_from_sweep{1.0};          ///< the estimate
    std::size_t kept = 0;                   ///< images to choose from
    std::size_t in_use = 0;                 ///< images of the last round, or of the next while waiting
    double spread_mm = 0;                   ///< how far apart the images in use lie, by spread_mm()
    Needs needs;                            ///< what the next round asks of its images, while waiting
    std::size_t rounds = 0;                 ///< rounds that have ended since the start or the last reset
    std::shared_ptr<const LiveRound> last;  ///< null before the first round
    std::string problem;  ///< why no round can begin or the thread has failed, as a sentence; usually empty
  };

  /// @param volume  must outlive the registrar
  /// @param start   ct_from_sweep
  LiveRegistrar(const AcousticVolume& volume, const Probe& probe, double depth_mm, const glm::dmat4& start,
                const LiveRegistrarSettings& settings, Prepare prepare);
  /// Ends the thread, and waits for that.
  ~LiveRegistrar();
  LiveRegistrar(const LiveRegistrar&) = delete;
  LiveRegistrar& operator=(const LiveRegistrar&) = delete;

  // The next functions return at once.

  /// Ends the thread after what it computes now: at most one call of the similarity, or all that it prepares.
  void end();
  bool has_ended() const { return has_ended_.load(std::memory_order_relaxed); }
  void add(SweepImage image);
  /// Turns the rounds that follow each other on or off; they are on at first.
  void refine(bool on);
  bool refines() const;
  /// Searches widely with the next round, in place of the one that runs.
  void search_widely();
  /// Goes back to the start, and forgets what was found.
  void reset();
  /// Makes the thread wait while the caller draws.
  void hold(bool on) { held_.store(on, std::memory_order_relaxed); }

  State state() const;

private:
  struct Task {
    TrackedSweep sweep;
    double share_left_out = 0;
    glm::dmat4 from{1.0};
    bool wide = false, looks_around = false;
    std::uint64_t window = 0, epoch = 0;
  };

  void run();
  Needs needs(bool is_wide, bool is_asked_for) const;
  bool begin_round(Task& task);
  void end_round(const Task& task, const RegistrationSettings& settings, SweepRegistration found);
  void give_way(const Task& task);
  bool is_outdated(const Task& task) const;

  const AcousticVolume& volume_;
  const glm::dmat4 start_;
  LiveRegistrarSettings settings_;
  const Prepare prepare_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  SweepWindow window_;
  State state_;
  bool refines_ = true, wants_wide_ = false, has_wide_ = false;
  bool refused_ = false;                       // the images of done_window_, by prepare_
  bool is_settled_ = false;                    // a round with all the images that it may have, or a wide one, has ended
  glm::dmat4 confirmed_{1.0};                  // where the last wide search that converged ended
  std::uint64_t done_window_ = 0, epoch_ = 0;  // the epoch changes with each reset
  std::atomic<bool> held_{false}, ending_{false}, has_ended_{false};
  std::thread thread_;
};

std::string_view to_string(LiveRegistrar::Work work);
/// Returns what is needed, as words that end a sentence: "6, of which two lie 5 mm apart".
std::string to_string(const LiveRegistrar::Needs& needs);

}  // namespace insonate
