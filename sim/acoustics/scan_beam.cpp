#include "sim/acoustics/scan_beam.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace insonate {
namespace {

double weight_at(Apodization apodization, double across) {  // 0 in the middle of the aperture, 1 at its edge
  return apodization == Apodization::uniform ? 1 : 0.5 + 0.5 * std::cos(glm::pi<double>() * across);
}

// Returns the rectangles of an element: the same number of each, so that rectangle k of element e is at e * number + k.
Aperture divided(const ElementPlace& place, const Transducer& transducer, double largest_mm, double speed) {
  const int columns = std::max(1, int(std::ceil(transducer.element_width_mm() / largest_mm)));
  const int rows = std::max(1, int(std::ceil(transducer.height_mm / largest_mm)));
  const double width = transducer.element_width_mm() / columns, height = transducer.height_mm / rows;
  const double focus = transducer.elevation_focus_mm;
  Aperture parts;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = (column - (columns - 1) / 2.0) * width, z = (row - (rows - 1) / 2.0) * height;
      Rectangle part;
      part.centre = place.centre + x * place.lateral + glm::dvec3(0, 0, z);
      part.lateral = place.lateral;
      part.width_mm = width;
      part.height_mm = height;
      if (focus > 0) {
        const double path = std::hypot(focus, z);
        // The mean over the rectangle: the second derivative of the path along z adds a 24th of it times height^2.
        const double longer = height * height * focus * focus / (24 * path * path * path);
        part.delay_us = (focus - path - longer) / speed;
        part.slope = -z / path / speed;
      }
      parts.push_back(part);
    }
  return parts;
}

}  // namespace

double largest_rectangle_mm(const Transducer& transducer, double nearest_mm) {
  // The edge of a side a at the distance z lies a^2 / (8 z) behind its middle's front: a 16th of a wavelength.
  return std::sqrt(transducer.wavelength_mm() * nearest_mm / 2);
}

ScanBeam::ScanBeam(const Transducer& transducer, const Beamforming& beamforming, const ScanLine& line)
    : line_(line), beamforming_(beamforming) {
  const double largest = largest_rectangle_mm(transducer, beamforming.nearest_mm);
  for (const ElementPlace& place : element_places(transducer)) {
    const Aperture parts = divided(place, transducer, largest, beamforming.sampling.speed_mm_us);
    per_element_ = parts.size();
    rectangles_.insert(rectangles_.end(), parts.begin(), parts.end());
    centres_.push_back(place.centre);
  }
  transmit_ = steered(beamforming.transmit_focus_mm, beamforming.transmit_focus_mm / beamforming.transmit_f_number,
                      beamforming.transmit_apodization);
}

ScanBeam::Steering ScanBeam::steered(double focus_mm, double width_mm, Apodization apodization) const {
  const auto off = [&](const glm::dvec3& centre) { return glm::distance(centre, line_.start); };
  double nearest = off(centres_.front());
  for (const glm::dvec3& centre : centres_) nearest = std::min(nearest, off(centre));
  // At least one element; and one at the very edge counts, however the numbers are rounded.
  constexpr double kRounding_mm = 1e-6;
  const double half = std::max(width_mm / 2, nearest) + kRounding_mm;

  const glm::dvec3 focus = line_.start + focus_mm * line_.direction;
  Steering steering;
  for (std::size_t i = 0; i < centres_.size(); ++i) {
    if (off(centres_[i]) > half) continue;
    if (steering.delays_us.empty()) steering.first = i;
    steering.delays_us.push_back((focus_mm - glm::distance(focus, centres_[i])) / beamforming_.sampling.speed_mm_us);
    steering.weights.push_back(weight_at(apodization, off(centres_[i]) / half));
  }
  return steering;
}

ScanBeam::Steering ScanBeam::receive_steering(double distance_mm) const {
  const double focus = beamforming_.dynamic_receive ? distance_mm : beamforming_.transmit_focus_mm;
  return steered(focus, focus / beamforming_.receive_f_number, beamforming_.receive_apodization);
}

Aperture ScanBeam::aperture_of(const Steering& steering) const {
  Aperture aperture;
  for (std::size_t e = steering.first; e < steering.end(); ++e)
    for (std::size_t k = 0; k < per_element_; ++k) {
      Rectangle part = rectangles_[e * per_element_ + k];
      part.delay_us += steering.delays_us[e - steering.first];
      part.weight = steering.weights[e - steering.first];
      aperture.push_back(part);
    }
  return aperture;
}

Aperture ScanBeam::transmit_aperture() const {
  return aperture_of(transmit_);
}

Aperture ScanBeam::receive_aperture(double distance_mm) const {
  return aperture_of(receive_steering(distance_mm));
}

SampledResponse ScanBeam::transmitted(const glm::dvec3& point_mm) const {
  return spatial_response(transmit_aperture(), point_mm, beamforming_.sampling, RectangleMethod::far_field);
}

SampledResponse ScanBeam::received(const glm::dvec3& point_mm) const {
  return spatial_response(receive_aperture(glm::distance(point_mm, line_.start)), point_mm, beamforming_.sampling,
                          RectangleMethod::far_field);
}

void ScanBeam::add(std::vector<Trapezoid>& to, const Trapezoid& base, const Steering& steering,
                   std::size_t element) const {
  if (element < steering.first || element >= steering.end()) return;
  Trapezoid steered = base;
  steered.time_us += steering.delays_us[element - steering.first];
  steered.area_mm *= steering.weights[element - steering.first];
  to.push_back(steered);
}

SampledResponse ScanBeam::both_ways(const glm::dvec3& point_mm) const {
  const Steering receive = receive_steering(glm::distance(point_mm, line_.start));
  std::vector<Trapezoid> sent, heard;
  sent.reserve(transmit_.delays_us.size() * per_element_);
  heard.reserve(receive.delays_us.size() * per_element_);
  // Most elements do both, and a rectangle's trapezoid differs only in delay and weight.
  for (std::size_t e = std::min(transmit_.first, receive.first); e < std::max(transmit_.end(), receive.end()); ++e)
    for (std::size_t k = 0; k < per_element_; ++k) {
      const Trapezoid base =
          trapezoid_of(rectangles_[e * per_element_ + k], point_mm, beamforming_.sampling.speed_mm_us);
      add(sent, base, transmit_, e);
      add(heard, base, receive, e);
    }
  const Sampling& sampling = beamforming_.sampling;
  return convolved(sum_of(sent, sampling), sum_of(heard, sampling), sampling);
}

}  // namespace insonate
