// Recomputes what insonate-render writes of a picture, stage by stage, with code that knows only the files.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/tools/render/render_program.h"
#include "tests/tools/render/stage_folder.h"
#include "tests/tools/render/synthetic_ct.h"

using namespace outsider;

namespace {

// Half a reflection length is a whole number of samples, so that alpha follows from the impedances in the files.
struct View {
  std::string arguments, pose, settings;
};

// 240 samples over 60 mm. Everything that the paper leaves out is on, and so is speckle.
const View kFan = {
    "--probe curvilinear --depth 60",
    // rotated about the beam, and pressed in until the fan's corners are under the skin
    "0.96 0 0.28 -4  0 1 0 9  -0.28 0 0.96 1  0 0 0 1",
    "preset = 'paper'\nsamples = 240\nreflection_length_mm = 1.0\nfrequency_mhz = 3.5\nabsorption = true\n"
    "two_way = true\ngel_mm = 3.1\nbeam_lines = 9\nreference_level = 'fixed'\n"
    "tgc_db = [0, 2, 5, 9, 14, 20, 27, 35]\ngain_db = 4\nimage_width = 160\nimage_height = 120\n"
    // loud enough that a wrong number among them is visible in the picture
    "electronic_noise = true\nnoise_db = -30\nclutter = true\nclutter_db = -10\n"};

// The same with reverberation.
const View kRinging = {kFan.arguments, kFan.pose, kFan.settings + "reverberation = true\nface_reflection = 1\n"};

// The same with refraction shadows behind the edges of round objects.
const View kRefracting = {kFan.arguments, kFan.pose, kFan.settings + "edge_shadow = true\n"};

// The same through a slice of three planes that bend, with reverberation.
const View kSlice = {kRinging.arguments, kRinging.pose,
                     kRinging.settings + "slice_planes = 3\nslice_thickness_mm = 4\nelevation_focus_mm = 35\n"};

// The paper's own model except for the reflection length, gel in front of a face that stands off the skin, and a wide
// box beam.
const View kLinear = {"--probe linear --depth 40", "-1 0 0 3  0 0.96 -0.28 -2  0 -0.28 -0.96 0  0 0 0 1",
                      "preset = 'paper'\nsamples = 200\nreflection_length_mm = 0.8\ngel_mm = 6.05\nspeckle = false\n"
                      "beam_window = 'box'\nbeam_lines = 15\ntransmission_sigma_mm = 1.2\nreflection_sigma_mm = 0\n"
                      "image_width = 90\nimage_height = 140\n"};

// The reference differs from its files by their rounding to single precision, which accumulates over some hundred
// samples and lines.
const Tolerances kReference{1e-6, 1e-6, 2e-6, 2e-5};
// The graphics card computes in single precision. These are the tolerances of the model's accuracy contract. For the
// scatterers it is the accuracy of their lookup. For U it is the place of a pixel in single precision among some
// hundred samples, times the contrast there.
const Tolerances kGraphicsCard{1e-4, 1e-4, 1e-3, 1e-4};

/// @param patient  --ct or --case, with a path in the folder
StageFolder render(const TestFolder& folder, const std::string& patient, const View& view, const std::string& more) {
  folder.file("pose.txt", view.pose);
  folder.file("settings.toml", view.settings);
  const std::string in = folder.path.string();
  const Outcome outcome = run(folder, INSONATE_RENDER_PROGRAM,
                              patient + " --pose " + in + "/pose.txt --settings " + in + "/settings.toml " +
                                  view.arguments + " --stages " + in + "/stages " + more + " " + in + "/image.png");
  INFO(outcome.errors);
  REQUIRE(outcome.code == 0);
  return read_stage_folder(folder.path / "stages");
}

StageFolder render(const SyntheticCt& ct, const View& view, const std::string& more) {
  const TestFolder folder;
  ct.write_nrrd(folder.path / "ct.nrrd");
  return render(folder, "--ct " + folder.path.string() + "/ct.nrrd", view, more);
}

void check(const StageFolder& stages, const Tolerances& tolerances) {
  std::map<std::string, double> all = misfits(stages, tolerances);
  all.merge(volume_misfits(stages));
  for (const auto& [stage, misfit] : all) {
    INFO(stage << ": the worst is " << misfit << " of what is tolerated");
    CHECK(misfit < 1);
  }
}

/// Checks that the insonated volume is the CT, voxel by voxel.
void check(const StageFolder& stages, const SyntheticCt& ct, const Tolerances& tolerances) {
  check(stages, tolerances);
  CHECK(stages.hounsfield.size == ct.size);
  CHECK(stages.hounsfield.voxels == ct.voxels);
  CHECK(length(stages.hounsfield.origin - ct.origin) < 1e-9);
  for (std::size_t a = 0; a < 3; ++a) CHECK(length(stages.hounsfield.step[a] - ct.axes[a]) < 1e-9);
}

}  // namespace

TEST_CASE("every stage of the graphics card's pictures follows from the stages before it, the first from the CT") {
  const SyntheticCt ct;
  SECTION("a fan") {
    check(render(ct, kFan, ""), ct, kGraphicsCard);
  }
  SECTION("a linear array") {
    check(render(ct, kLinear, ""), ct, kGraphicsCard);
  }
  SECTION("with reverberation") {
    check(render(ct, kRinging, ""), ct, kGraphicsCard);
  }
  SECTION("with edge shadows") {
    check(render(ct, kRefracting, ""), ct, kGraphicsCard);
  }
  SECTION("through a slice of several planes") {
    check(render(ct, kSlice, ""), ct, kGraphicsCard);
  }
}

TEST_CASE("every stage of the reference's pictures follows from the stages before it, the first from the CT") {
  const SyntheticCt ct;
  SECTION("a fan") {
    check(render(ct, kFan, "--reference"), ct, kReference);
  }
  SECTION("a linear array") {
    check(render(ct, kLinear, "--reference"), ct, kReference);
  }
  SECTION("with reverberation and edge shadows") {
    const View both{kFan.arguments, kFan.pose, kRinging.settings + "edge_shadow = true\n"};
    check(render(ct, both, "--reference"), ct, kReference);
  }
  SECTION("through a slice of several planes, with edge shadows") {
    const View both{kFan.arguments, kFan.pose, kSlice.settings + "edge_shadow = true\n"};
    check(render(ct, both, "--reference"), ct, kReference);
  }
}

TEST_CASE("every stage of model W's pictures follows from the volume, and one wrong number is found") {
  const SyntheticCt ct;
  const View view{"--model W --probe curvilinear --depth 60", kFan.pose,
                  "samples = 120\nreflection_length_mm = 1.5\ncompression = 300\ncontact_mm = 4\ndark_hu = -60\n"
                  "bright_hu = 120\nreflection_share = 0.4\nimage_width = 90\nimage_height = 70\n"};
  for (const bool single : {true, false}) {
    const StageFolder stages = render(ct, view, single ? "" : "--reference");
    CHECK(stages.hounsfield.voxels == ct.voxels);
    for (const auto& [stage, misfit] : wein_misfits(stages, single)) {
      INFO(stage << ": the worst is " << misfit << " of what is tolerated");
      CHECK(misfit < 1);
    }
    for (const auto& [name, plane] : stages.planes) {
      StageFolder wrong = stages;
      wrong.planes.at(name).at(plane.width / 2, plane.height / 3) += name == "image" ? 2 : 0.02;
      double worst = 0;
      for (const auto& [stage, misfit] : wein_misfits(wrong, single)) worst = std::max(worst, misfit);
      INFO(name);
      CHECK(worst > 1);
    }
  }
}

TEST_CASE("a CT that is resampled lies beside the stages as it was insonated") {
  const SyntheticCt fine;
  SyntheticCt coarse = fine;  // every third voxel along each axis
  coarse.voxels.clear();
  for (std::size_t a = 0; a < 3; ++a) {
    coarse.size[a] = fine.size[a] / 3;
    coarse.origin = coarse.origin + fine.axes[a];
    coarse.axes[a] = 3 * fine.axes[a];
  }
  for (int k = 0; k < coarse.size[2]; ++k)
    for (int j = 0; j < coarse.size[1]; ++j)
      for (int i = 0; i < coarse.size[0]; ++i)
        coarse.voxels.push_back(
            fine.voxels[std::size_t(((3 * k + 1) * fine.size[1] + 3 * j + 1) * fine.size[0] + 3 * i + 1)]);
  const StageFolder stages = render(coarse, kFan, "");
  check(stages, kGraphicsCard);
  const ShortVolume& used = stages.hounsfield;
  CHECK(length(used.origin - fine.origin) < 1e-9);
  std::size_t n = 0;
  int worst = 0;
  for (int k = 0; k < coarse.size[2]; ++k)
    for (int j = 0; j < coarse.size[1]; ++j)
      for (int i = 0; i < coarse.size[0]; ++i)
        worst = std::max(worst, std::abs(used.voxel(3 * i + 1, 3 * j + 1, 3 * k + 1) - coarse.voxels[n++]));
  CHECK(worst == 0);
}

TEST_CASE("what labels say of a case's echogenicity can be recomputed too") {
  const SyntheticCt ct;
  const TestFolder folder;
  std::filesystem::create_directory(folder.path / "case");
  ct.write_nrrd(folder.path / "case" / "ct.nrrd");
  std::string labels = bytes_of(folder.path / "case" / "ct.nrrd");
  labels.resize(labels.find("\n\n") + 2);
  labels.replace(labels.find("type: short"), 11, "type: uint8");
  for (std::size_t v = 0; v < ct.voxels.size(); ++v)  // the rest by its density
    labels += char(ct.voxels[v] > 20 ? 1 : ct.voxels[v] > -20 ? 3 : 0);
  folder.file("case/labels.nrrd", labels);
  folder.file("case/case.toml",
              "format = 1\nname = \"Labelled\"\nct = \"ct.nrrd\"\nlabels = \"labels.nrrd\"\n"
              "[[label]]\nvalue = 1\nname = \"liver\"\ntissue = \"liver\"\n"
              "[[label]]\nvalue = 3\nname = \"kidney\"\ntissue = \"kidney_cortex\"\n");
  check(render(folder, "--case " + folder.path.string() + "/case", kFan, ""), ct, kGraphicsCard);
}

TEST_CASE("one wrong number in any of the files is found") {
  const SyntheticCt ct;
  const StageFolder slice = render(ct, kSlice, "");
  const std::map<std::string, double> before = misfits(slice, kGraphicsCard);
  for (const auto& [name, plane] : slice.planes) {
    StageFolder wrong = slice;
    Plane& changed = wrong.planes.at(name);
    double largest = 0;
    for (double value : changed.values) largest = std::max(largest, std::abs(value));
    // Where the picture is not black. The change is two levels in the picture, and in the other planes more than single
    // precision explains. The envelope has the widest tolerance on the graphics card, and noise is known only from
    // nearby pixels.
    const bool lightly = name == "speckle" || name == "noise";
    changed.at(changed.width / 2, changed.height / 3) += name == "image" ? 2 : (lightly ? 0.05 : 1e-3) * largest;
    bool found = false;
    for (const auto& [stage, misfit] : misfits(wrong, kGraphicsCard)) found |= misfit > 1 && misfit > before.at(stage);
    INFO(name);
    CHECK(found);
  }
  StageFolder wrong = slice;
  wrong.echogenicity.voxels[wrong.echogenicity.voxels.size() / 2] += 2;
  CHECK(volume_misfits(slice).at("volume_echogenicity") < 1);
  CHECK(volume_misfits(wrong).at("volume_echogenicity") > 1);
}
