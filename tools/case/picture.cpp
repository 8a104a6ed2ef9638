#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/files/files.h"
#include "sim/files/png.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "sim/model/quality.h"
#include "sim/view/body/tissue_classes.h"
#include "sim/view/body/transfer_function_file.h"
#include "sim/view/body/volume_view.h"
#include "tools/case/commands.h"
#include "tools/cli/subject.h"

namespace insonate {
namespace {

/// The opacity of the skin if a picture shows surfaces.
constexpr double kSkin = 0.14;

/// Returns the function of a bundled name or of a file; none for the surfaces.
std::optional<view::TransferFunction> look_named(const std::string& named) {
  if (named == view::kSurfaces) return std::nullopt;
  if (std::filesystem::path(named).extension() == ".toml") return view::read_transfer_function(named);
  std::vector<std::string> names{view::kSurfaces};
  for (const view::TransferFunction& function : view::bundled_transfer_functions()) {
    if (function.name == named) return function;
    names.push_back(function.name);
  }
  throw InputError("--look", "", "there is no look named '" + named + "'", suggest(named, names));
}

/// Returns the values of labels by their names. Throws InputError for a name that the patient lacks.
std::vector<std::uint8_t> structures_named(const std::vector<std::string>& names, const Case& subject) {
  std::vector<std::uint8_t> values;
  for (const std::string& name : names) {
    if (const Label* label = subject.find_label(name)) {
      values.push_back(label->value);
      continue;
    }
    std::vector<std::string> known;
    for (const Label& label : subject.label_table) known.push_back(label.name);
    throw InputError("--structure", "", "the patient has no structure named '" + name + "'", suggest(name, known));
  }
  return values;
}

view::Side side_named(const std::string& name) {
  const auto found = std::find(kSideNames.begin(), kSideNames.end(), name);
  return view::Side(found - kSideNames.begin());
}

}  // namespace

void draw_patient(const PatientPicture& picture) {
  if (std::filesystem::path(picture.out).extension() != ".png")
    throw InputError(picture.out, "", "a picture is written as PNG", "name a file that ends in .png");
  const std::optional<view::TransferFunction> look = look_named(picture.look);
  const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  const Case subject = open_subject(picture.subject);
  if (!look && !picture.structures.empty())
    throw InputError("--structure", "", "all structures are shown with '" + std::string(view::kSurfaces) + "'",
                     "choose a look of the CT, such as Bones");
  const ReferenceView* plane_shown = picture.view.empty() ? nullptr : subject.find_view(picture.view);
  if (!picture.view.empty() && !plane_shown) {
    std::vector<std::string> names;
    for (const ReferenceView& view : subject.views) names.push_back(view.name);
    throw InputError("--view", "", "there is no view named '" + picture.view + "'", suggest(picture.view, names));
  }

  std::vector<std::string> names(256);
  for (const Label& label : subject.label_table) names[label.value] = label.name;
  const AcousticVolume volume = make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table);
  const gl::HeadlessContext context;
  gl::Simulator simulator;
  gl::upload_ct(picture.subject, volume.grid, [&] { simulator.set_volume(volume, table); });
  const view::PatientTextures patient(simulator.volume_texture(), subject.ct, subject.labels,
                                      view::colours_of_organs(names));

  view::VolumeStyle style;
  style.skin = kSkin;
  if (look) {
    style.ct.emplace();
    style.ct->function = *look;
    style.ct->structures = structures_named(picture.structures, subject);
  }
  view::UltrasoundPlane plane;
  style.plane = style.probe = plane_shown != nullptr;
  style.cut = picture.cut;
  view::OrbitCamera camera = view::OrbitCamera::framing(subject.ct.grid);
  if (plane_shown) {
    const Probe* probe = find_probe(plane_shown->probe);
    simulator.set_probe(*probe, plane_shown->depth_mm);
    simulator.set_settings(
        at_quality(trainer_settings(probe->frequency_mhz, plane_shown->depth_mm), Quality::balanced));
    simulator.set_pose(plane_shown->patient_from_probe);
    plane.image = &simulator.image();
    plane.image_version = simulator.image_version();
    plane.geometry = simulator.geometry();
    plane.probe = *probe;
    plane.patient_from_probe = plane_shown->patient_from_probe;
    camera = view::OrbitCamera::facing(subject.ct.grid, plane.patient_from_probe);
  }
  if (!picture.from.empty()) camera = view::OrbitCamera::from(side_named(picture.from), subject.ct.grid);
  camera.orbit(picture.turn_deg, picture.tilt_deg);

  view::VolumeView view;
  const gl::Texture& drawn = view.render(picture.width, picture.height, patient, camera, plane, style);
  Image<Rgba8> image(drawn.width(), drawn.height());
  drawn.read(GL_RGBA, GL_UNSIGNED_BYTE, image.pixels.data(), image.pixels.size() * sizeof(Rgba8));
  write_png(picture.out, image);
}

}  // namespace insonate
