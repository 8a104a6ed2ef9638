#pragma once

#include <glm/mat4x4.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/registration/live_registrar.h"
#include "devices/igtl/tracked_images.h"
#include "sim/registration/echo_seen.h"
#include "sim/registration/find_fan.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/volume/case.h"
#include "tools/register/read_sweep.h"
#include "tools/register/start_transform.h"

namespace insonate {

/// What a live registration is begun with.
struct LiveRequest {
  std::string tracker;  ///< URI of an OpenIGTLink server
  std::string subject;  ///< as the user named the CT or case; empty: the built-in patient
  SweepInput input;     ///< `file` is the tracker's URI; with a matrix, TRANSFORM messages place the images
  StartTransform start;
  RegistrationSettings settings;
  bool refines = true;    ///< at once, when there are images enough
  bool gives_way = true;  ///< the registration, to the pictures; false where there are none
  bool searches = false;  ///< widely, by itself, until it has found the place
};

/// Registers real ultrasound that arrives over OpenIGTLink with a CT, without a screen: receives images, finds the
/// probe in them if it is not named, and lets a LiveRegistrar refine the start. It looks for the probe again when twice
/// as many images have come, and begins anew if they show another fan. Needs no context of the caller.
class LiveSession {
public:
  static constexpr double kTakenEvery_s = 0.2;  ///< images that are registered; all are shown

  /// Does not connect yet. Throws InputError if the request cannot be used.
  /// @param subject, volume  must outlive the session
  LiveSession(LiveRequest request, const Case& subject, const AcousticVolume& volume);

  /// Takes what has arrived.
  /// @param now_s  of steady_now_s(), not falling
  void update(double now_s);

  /// The newest image, and where its fan lies in the frame of the transforms. Null before the probe is known.
  struct Shown {
    igtl::TrackedImage image;
    Pose sweep_from_fan;
    glm::dmat3 pixel_from_plane;
  };
  const Shown* newest() const { return newest_ ? &*newest_ : nullptr; }
  /// Returns how many images have been shown.
  long shown() const { return shown_count_; }

  /// Returns the probe as it was named or found; null before.
  const Probe* probe() const { return input_.probe ? &*input_.probe : nullptr; }
  double depth_mm() const { return input_.depth_mm.value_or(input_.probe ? input_.probe->depth_mm : 0); }
  const std::optional<FoundFan>& fan() const { return fan_; }
  const igtl::TrackedImages& stream() const { return stream_; }

  LiveRegistrar::State state() const;
  bool refines() const { return registrar_ ? registrar_->refines() : request_.refines; }
  void refine(bool on);
  void search_widely();
  void reset();
  void hold(bool on) {
    if (registrar_) registrar_->hold(on);
  }

  /// Returns what hinders the registration now and what to do, as a sentence; empty if nothing does.
  std::string problem() const;
  /// Returns the verdict on the estimate, as insonate-register words it; empty before the first round.
  std::string verdict() const;

  /// Writes the last round as insonate-register does, into a folder of this name or the next that is free: NAME-2.
  /// Returns it. Throws InputError if there is no round yet, or if it cannot be written.
  std::filesystem::path save(const std::filesystem::path& folder) const;
  /// The same for a round of state().last.
  std::filesystem::path save(const std::filesystem::path& folder, const LiveRound& round) const;

private:
  void look_for_fan(const igtl::TrackedImage& image);
  void show(igtl::TrackedImage image, double now_s);
  double keep_what_compares(TrackedSweep& sweep, const glm::dmat4& ct_from_sweep) const;

  LiveRequest request_;
  SweepInput input_;  // with the probe, once it is known
  const Case& subject_;
  const AcousticVolume& volume_;
  igtl::TrackedImages stream_;
  EchoSeen seen_;
  std::size_t next_look_;  // for the fan, at so many images
  std::optional<FoundFan> fan_;
  std::unique_ptr<LiveRegistrar> registrar_;
  std::vector<std::unique_ptr<LiveRegistrar>> ending_;  // of fans that were not the probe's
  std::optional<Shown> newest_;
  std::vector<igtl::TrackedImage> arrived_;
  int width_ = 0, height_ = 0;          // of the first image
  std::optional<glm::dvec2> pixel_mm_;  // likewise, where images place themselves
  long shown_count_ = 0;
  double taken_s_ = -1e300;
  std::string problem_;  // of the images
};

}  // namespace insonate
