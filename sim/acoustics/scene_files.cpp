#include "sim/acoustics/scene_files.h"

#include <cmath>
#include <complex>
#include <initializer_list>
#include <string>
#include <vector>

#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/files/new_folder.h"

namespace insonate {
namespace {

constexpr double kMetres = 1e-3, kSeconds = 1e-6, kHertz = 1e6;

// Nine digits are a tenth of a nanometre of a position.
std::string nine_digits(double number) {
  return formatted("%.9g", number);
}

void append_line(std::string& text, std::initializer_list<double> numbers) {
  const char* before = "";
  for (const double number : numbers) {
    text += before + nine_digits(number);
    before = ",";
  }
  text += '\n';
}

// Returns a position of the probe's frame in the frame of the files, metres. Adding 0 makes minus zero a zero.
glm::dvec3 in_file(const glm::dvec3& mm) {
  return kMetres * glm::dvec3(mm.x, -mm.z, mm.y) + 0.0;
}

const char* name_of(Apodization apodization) {
  return apodization == Apodization::hann ? "hann" : "uniform";
}

}  // namespace

std::string scatterers_csv(const std::vector<PointScatterer>& scatterers) {
  std::string text = "x_m,y_m,z_m,amplitude\n";
  text.reserve(48 * (scatterers.size() + 1));
  for (const PointScatterer& scatterer : scatterers) {
    const glm::dvec3 at = in_file(scatterer.position_mm);
    append_line(text, {at.x, at.y, at.z, scatterer.amplitude});
  }
  return text;
}

std::string transducer_csv(const Transducer& transducer, const Beamforming& beamforming) {
  const char* kinds[] = {"linear", "curvilinear", "phased"};
  std::string text = "quantity,value,unit\n";
  const auto word = [&](const char* quantity, const std::string& value) {
    text += std::string(quantity) + "," + value + ",\n";
  };
  const auto number = [&](const char* quantity, double value, const char* unit) {
    text += std::string(quantity) + "," + nine_digits(value) + "," + unit + "\n";
  };
  word("name", transducer.title);
  word("kind", kinds[int(transducer.kind)]);
  number("elements", transducer.elements, "");
  number("pitch", transducer.pitch_mm * kMetres, "m");
  number("kerf", transducer.kerf_mm * kMetres, "m");
  number("width", transducer.element_width_mm() * kMetres, "m");
  number("height", transducer.height_mm * kMetres, "m");
  if (transducer.kind == ProbeKind::curvilinear) number("radius", transducer.radius_mm * kMetres, "m");
  if (transducer.elevation_focus_mm > 0) number("elevation_focus", transducer.elevation_focus_mm * kMetres, "m");
  number("frequency", transducer.frequency_mhz * kHertz, "Hz");
  number("bandwidth", transducer.bandwidth_percent, "%");
  number("excitation", transducer.excitation_cycles, "cycles");
  number("sound_speed", beamforming.sampling.speed_mm_us * kMetres / kSeconds, "m/s");
  number("sampling_frequency", beamforming.sampling.per_us * kHertz, "Hz");
  number("attenuation", beamforming.attenuation_db_cm_mhz, "dB/(cm MHz)");
  number("transmit_focus", beamforming.transmit_focus_mm * kMetres, "m");
  number("transmit_f_number", beamforming.transmit_f_number, "");
  number("receive_f_number", beamforming.receive_f_number, "");
  word("receive_focus", beamforming.dynamic_receive ? "dynamic" : "as transmitted");
  word("transmit_apodization", name_of(beamforming.transmit_apodization));
  word("receive_apodization", name_of(beamforming.receive_apodization));
  return text;
}

std::string elements_csv(const Transducer& transducer) {
  std::string text = "x_m,y_m,z_m,angle_rad\n";
  for (const ElementPlace& place : element_places(transducer)) {
    const glm::dvec3 at = in_file(place.centre);
    append_line(text, {at.x, at.y, at.z, std::atan2(-place.lateral.y, place.lateral.x) + 0.0});
  }
  return text;
}

std::string samples_csv(const std::string& title, double first_us, double per_us, const std::vector<double>& samples) {
  std::string text = "time_s," + title + "\n";
  for (std::size_t k = 0; k < samples.size(); ++k)
    append_line(text, {(first_us + double(k) / per_us) * kSeconds, samples[k]});
  return text;
}

void write_scene(const std::filesystem::path& folder, const Transducer& transducer, const Beamforming& beamforming,
                 const std::vector<PointScatterer>& scatterers, double to_mm) {
  const Pulse pulse(transducer);
  const double per_us = beamforming.sampling.per_us;
  const std::vector<double> element = pulse.element_response(per_us);
  const EchoLine line =
      echo_line(ScanBeam(transducer, beamforming, line_at(transducer, 0)), pulse, scatterers, 1, to_mm);
  std::vector<double> rf;
  for (const std::complex<double>& sample : line.samples) rf.push_back(sample.real());

  write_folder(folder, [&](const std::filesystem::path& into) {
    write_file(into / "scatterers.csv", scatterers_csv(scatterers));
    write_file(into / "transducer.csv", transducer_csv(transducer, beamforming));
    write_file(into / "elements.csv", elements_csv(transducer));
    write_file(into / "excitation.csv", samples_csv("excitation", 0, per_us, pulse.excitation(per_us)));
    const std::size_t middle = element.size() / 2;
    write_file(into / "element_response.csv", samples_csv("response", -double(middle) / per_us, per_us, element));
    write_file(into / "central_line.csv", samples_csv("rf", line.first_us, per_us, rf));
  });
}

}  // namespace insonate
