#include "sim/acoustics/transducer.h"

#include <glm/trigonometric.hpp>

#include <cmath>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/files/toml_table.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestTransducerFile = 1u << 16;
constexpr int kMaxElements = 1024;

// In the order of ProbeKind.
const std::vector<std::string> kKinds{"linear", "curvilinear", "phased"};

ElementPlace place_on_face(const Transducer& transducer, double along_mm) {
  if (transducer.kind != ProbeKind::curvilinear) return {glm::dvec3(along_mm, 0, 0), glm::dvec3(1, 0, 0)};
  const double angle = along_mm / transducer.radius_mm;
  return {transducer.radius_mm * glm::dvec3(std::sin(angle), std::cos(angle) - 1, 0),
          glm::dvec3(std::cos(angle), -std::sin(angle), 0)};
}

}  // namespace

Transducer read_transducer(const std::filesystem::path& toml_file) {
  const TomlDocument document(toml_file.string(), read_file(toml_file, kLargestTransducerFile), OnMistake::collect);
  const TomlTable root = document.root();
  Transducer transducer;
  transducer.name = root.text("name");
  transducer.title = root.text("title");
  transducer.kind = ProbeKind(root.choice("kind", kKinds));

  const TomlTable array = root.table("array");
  transducer.elements = int(array.whole_number("elements", 1, kMaxElements));
  transducer.pitch_mm = array.number("pitch_mm", {0.02, 5});
  transducer.kerf_mm = array.number("kerf_mm", {0, 5});
  if (transducer.kerf_mm >= transducer.pitch_mm)
    array.report("kerf_mm", "'kerf_mm' is " + number_text(transducer.kerf_mm) + ", so that no element has a width",
                 "give less than the pitch, " + number_text(transducer.pitch_mm));
  if (transducer.kind == ProbeKind::curvilinear) {
    transducer.radius_mm = array.number("radius_mm", {5, 200});
    if (transducer.face_mm() >= glm::radians(180.0) * transducer.radius_mm)
      array.report("radius_mm", "the face of " + number_text(transducer.face_mm()) + " mm covers half a circle or more",
                   "give a larger radius or fewer elements");
  } else if (array.has("radius_mm")) {
    array.report("radius_mm", "'radius_mm' stands in a flat array", "remove it, or write kind = \"curvilinear\"");
  }

  const TomlTable elevation = root.table("elevation");
  transducer.height_mm = elevation.number("height_mm", {0.1, 50});
  transducer.elevation_focus_mm =
      elevation.kind("focus_mm") == TomlKind::missing ? 0 : elevation.number("focus_mm", {1, 1000});

  const TomlTable pulse = root.table("pulse");
  transducer.frequency_mhz = pulse.number("frequency_mhz", {0.5, 30});
  transducer.bandwidth_percent = pulse.number("bandwidth_percent", {5, 120});
  transducer.excitation_cycles = pulse.number("excitation_cycles", {0, 50});

  root.refuse_unknown_keys();
  document.throw_mistakes();
  return transducer;
}

Transducer bundled_transducer(std::string_view probe) {
  if (!find_probe(probe))
    throw InputError("transducer", "", "'" + std::string(probe) + "' is not a probe", suggest(probe, probe_names()));
  return read_transducer(assets_folder() / "transducers" / (std::string(probe) + ".toml"));
}

std::vector<ElementPlace> element_places(const Transducer& transducer) {
  std::vector<ElementPlace> places;
  for (int i = 0; i < transducer.elements; ++i)
    places.push_back(place_on_face(transducer, (i - (transducer.elements - 1) / 2.0) * transducer.pitch_mm));
  return places;
}

ScanLine line_at(const Transducer& transducer, double position) {
  if (transducer.kind == ProbeKind::phased) {
    const double angle = glm::radians(position);
    return {glm::dvec3(0.0), glm::dvec3(std::sin(angle), std::cos(angle), 0)};
  }
  const ElementPlace place = place_on_face(transducer, position);
  return {place.centre, glm::dvec3(-place.lateral.y, place.lateral.x, 0)};
}

}  // namespace insonate
