// Tests what insonate-render --stages writes of model W: each file has the form that docs/stages.md states, and holds
// the stage that it is named after.

#include <catch2/catch.hpp>

#include <utility>

#include "sim/tissue/acoustic_volume.h"
#include "sim/volume/ct_reader.h"
#include "sim/wein/wein_settings_file.h"
#include "tests/tools/render/stage_folder.h"
#include "tests/tools/render/synthetic_ct.h"
#include "tests/wein/wein_parity.h"

using namespace insonate;
using namespace insonate::test;

TEST_CASE("model W: each file of the stages has its form, and holds the stage of its name") {
  const bool by_reference = GENERATE(false, true);
  const View view{"curvilinear",
                  60,
                  {{{0.96, 0, -0.28}, {0, 1, 0}, {0.28, 0, 0.96}}, {-4, 9, 1}},
                  "samples = 120\nreflection_length_mm = 1.5\ncompression = 300\ncontact_mm = 4\ndark_hu = -60\n"
                  "bright_hu = 120\nreflection_share = 0.4\nimage_width = 90\nimage_height = 70\n"
                  "exact_filter = true\n"};
  const Volume<std::int16_t> ct = synthetic_ct();
  const AcousticVolume volume =
      make_acoustic_volume(ct, {}, {}, read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"));
  Volume<std::int16_t> without_noise{ct.grid, {}};
  for (const AcousticVoxel& voxel : volume.voxels) without_noise.voxels.push_back(voxel.hu);
  const TemporaryFolder folder;
  write_ct(folder.path / "ct.nrrd", ct);
  const StageFolder stages = export_stages(folder, "--ct " + (folder.path / "ct.nrrd").string(), view,
                                           std::string("--model W") + (by_reference ? " --reference" : ""));
  const WeinSettings settings = read_wein_settings(folder.path / "settings.toml");

  check_forms(stages,
              {{"intensity", "I, relative to the intensity at the face"},
               {"scan_echogenicity", "E, times I"},
               {"scan_reflection", "R, 0 to 1"}},
              {{"pixel_line", "scan line at the pixel"},
               {"pixel_sample", "sample at the pixel"},
               {"image", "s R + (1 - s) E, 255 for 1"}},
              {"volume"});
  check_geometry(stages, view, settings.samples, settings.image_width, settings.image_height, ct.grid);
  check_settings(stages, named_settings(settings));
  CHECK(stages.description.at("model") == "W");
  CHECK((stages.description.at("made_by") == "reference in double precision") == by_reference);
  CHECK(stages.description.at("air_mu") == kAirMu);
  CHECK(stages.description.at("contact_tissue_hu") == kCouplingTissue_hu);
  CHECK(stages.description.at("contact_air_hu") == kCouplingAir_hu);
  CHECK((stages.files.at("volume").volume<std::int16_t>().voxels == without_noise.voxels));

  const ReferenceWeinStages reference =
      reference_wein_stages(wein_field(volume, settings.reflection_length_mm), *find_probe(view.probe), view.depth_mm,
                            settings, view.patient_from_probe);
  if (by_reference) {
    check_rounded(stages, "intensity", reference.exact.intensity);
    check_rounded(stages, "scan_echogenicity", reference.exact.scan_echogenicity);
    check_rounded(stages, "scan_reflection", reference.exact.scan_reflection);
    CHECK((stages.grey().pixels == reference.exact.grey.pixels));
  } else {
    check_wein_stages(reference, {stages.image("intensity"),
                                  stages.image("scan_echogenicity"),
                                  stages.image("scan_reflection"),
                                  {},
                                  {},
                                  stages.grey()});
  }
}
