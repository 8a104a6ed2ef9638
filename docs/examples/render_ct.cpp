// One ultrasound image of a CT, without a window: example-render-ct scan.nii.gz image.png

#include <cstdio>
#include <exception>
#include <stdexcept>

#include "sim/core/image.h"
#include "sim/files/files.h"
#include "sim/files/png.h"
#include "sim/gl/headless_context.h"
#include "sim/imaging/simulator.h"
#include "sim/volume/open_case.h"

using namespace insonate;

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: example-render-ct CT IMAGE.png");
#ifdef INSONATE_ASSETS_FOLDER
  set_assets_folder(INSONATE_ASSETS_FOLDER);
#endif

  // The patient: a CT as the sound meets it.
  const Case patient = open_case(argv[1]);
  const TissueTable tissues = read_tissue_table(assets_folder() / "tissues.toml");
  const AcousticVolume volume =
      make_acoustic_volume(patient.ct, patient.labels, tissue_by_label(patient), tissues, true);
  if (patient.views.empty()) throw std::runtime_error("there is no body in this CT");

  // The probe, where it is held, and the machine's settings.
  const ReferenceView& view = patient.views.front();
  const Probe& probe = *find_probe(view.probe);
  const Settings settings = trainer_settings(probe.frequency_mhz, view.depth_mm);

  // The simulator. Setters note what changed; a moving probe calls set_pose() and image() again, and nothing else.
  const gl::HeadlessContext context;
  gl::Simulator simulator;
  simulator.set_volume(volume, tissues);
  simulator.set_probe(probe, view.depth_mm);
  simulator.set_settings(settings);
  simulator.set_pose(view.patient_from_probe);

  Image<std::uint8_t> grey(settings.image_width, settings.image_height);
  simulator.image().read(GL_RED, GL_UNSIGNED_BYTE, grey.pixels.data(), grey.pixels.size());
  write_png(argv[2], mirrored(grey));  // the probe's marker on the left, as clinics show it
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
