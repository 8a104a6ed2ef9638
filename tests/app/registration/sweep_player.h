#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "devices/igtl/igtl_server.h"
#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/reconstruction/tracked_picture.h"
#include "sim/registration/motion.h"
#include "sim/registration/synthetic_sweep.h"
#include "sim/registration/tracked_sweep.h"

namespace insonate::test {

/// What a tracked scanner sends: images of a probe that is tilted and slid to and fro, in the frame of a tracker.
struct Scan {
  std::vector<Image<std::uint8_t>> images;
  std::vector<Pose> tracker_from_probe;
  glm::dmat4 probe_from_pixel{1.0};
  glm::dmat4 ct_from_tracker{1.0};  ///< the truth
  TrackedSweep sweep;               ///< the same in the CT's frame
};

/// Returns a scan that model S makes. Needs an OpenGL context.
inline Scan make_scan(const AcousticVolume& volume, const TissueTable& table, const Probe& probe, double depth_mm,
                      const std::vector<Pose>& ct_from_probe, int width, int height) {
  Scan scan;
  scan.sweep = synthetic_sweep(volume, table, probe, depth_mm, trainer_settings(probe.frequency_mhz, depth_mm),
                               ct_from_probe, width, height);
  const Pose truth{glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(25.0), glm::dvec3(0.6, 0.8, 0))),
                   glm::dvec3(120, -40, 60)};
  scan.ct_from_tracker = truth.matrix();
  scan.probe_from_pixel = patient_from_pixel(Pose{}, image_geometry(probe, depth_mm, width, height));
  for (const SweepImage& image : scan.sweep.images) {
    Image<std::uint8_t>& picture = scan.images.emplace_back(width, height);
    std::ranges::transform(image.grey.pixels, picture.pixels.begin(),
                           [](float grey) { return std::uint8_t(std::isnan(grey) ? 0 : std::lround(grey)); });
    scan.tracker_from_probe.push_back(truth.inverse() * image.sweep_from_probe);
  }
  return scan;
}

/// Returns a start that is off by some mm and degrees about the middle of what the scan shows.
inline glm::dmat4 start_off_by(const Scan& scan, const glm::dvec3& mm, double degrees) {
  const glm::dvec3 middle = motion_about(target_points(scan.sweep), glm::dmat4(1.0)).centre_in_ct;
  return glm::translate(glm::dmat4(1.0), middle + mm) *
         glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::normalize(glm::dvec3(1, 2, -1))) *
         glm::translate(glm::dmat4(1.0), -middle) * scan.ct_from_tracker;
}

/// Returns the target registration error of a map, mm.
inline double error_of(const Scan& scan, const glm::dmat4& ct_from_tracker) {
  return target_error_mm(target_points(scan.sweep), ct_from_tracker * glm::inverse(scan.ct_from_tracker),
                         glm::dmat4(1.0));
}

/// Sends a scan to OpenIGTLink clients on a thread, 25 images a second, each with a TRANSFORM of the same stamp.
class SweepPlayer {
public:
  struct What {
    bool images = true, transforms = true;
    bool in_place = false;  ///< each image carries its place in the tracker's frame
  };

  explicit SweepPlayer(const Scan& scan) : SweepPlayer(scan, What()) {}
  SweepPlayer(const Scan& scan, const What& what, std::uint16_t port = 0)
      : server_(igtl::numeric_address("127.0.0.1", port), "PORT"),
        thread_([&scan, what, this](const std::stop_token& stop) { play(scan, what, stop); }) {}

  std::uint16_t port() const { return server_.address().port(); }
  std::string uri() const { return "igtl://127.0.0.1:" + std::to_string(port()); }

private:
  void play(const Scan& scan, const What& what, const std::stop_token& stop) {
    const std::size_t last = scan.images.size() - 1;
    auto due = std::chrono::steady_clock::now();
    const double first_s = 1700000000;
    for (std::size_t i = 0; !stop.stop_requested(); ++i) {
      const std::size_t turn = i % (2 * last), n = turn <= last ? turn : 2 * last - turn;
      const Pose& pose = scan.tracker_from_probe[n];
      const Image<std::uint8_t>& image = scan.images[n];
      const std::uint64_t stamp = igtl::stamp_of(first_s + 0.04 * double(i));
      if (what.transforms)
        server_.publish(igtl::Server::Stream::pose, igtl::make_transform("ProbeToTracker", stamp, pose));
      if (what.images) {
        const double mm = glm::length(glm::dvec3(scan.probe_from_pixel[0]));
        const glm::dvec4 middle =
            scan.probe_from_pixel * glm::dvec4((image.width - 1) / 2.0, (image.height - 1) / 2.0, 0, 1);
        const Pose centre{glm::dmat3(1.0), glm::dvec3(middle)};
        server_.publish(igtl::Server::Stream::image,
                        igtl::make_image("Image", stamp, image, what.in_place ? pose * centre : centre, mm));
      }
      due += std::chrono::milliseconds(40);
      std::this_thread::sleep_until(due);
    }
  }

  igtl::Server server_;
  std::jthread thread_;
};

}  // namespace insonate::test
