// Tests insonate-register from a recording and a CT to its folder, and what it refuses.

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "devices/record/sequence_recorder.h"
#include "sim/core/text.h"
#include "sim/files/digest.h"
#include "sim/files/png.h"
#include "sim/gl/headless_context.h"
#include "sim/reconstruction/tracked_picture.h"
#include "sim/registration/synthetic_sweep.h"
#include "sim/volume/ct_reader.h"
#include "tests/core/run_program.h"
#include "tests/imaging/test_body.h"
#include "tests/volume/dicom_files.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

constexpr double kDepth_mm = 100;
constexpr int kWidth = 160, kHeight = 120;

/// A folder with the test body's CT, and a recording of a sweep over it whose frame is shifted by 3, -2, 4 mm.
struct Workplace {
  TemporaryFolder folder;
  Volume<std::int16_t> ct;

  /// @param breath_mm  how far the body's organs have moved in the recording, but not in the CT
  explicit Workplace(bool with_images = true, double breath_mm = 0) {
    AcousticVolume body = test::test_body();
    ct.grid = body.grid;
    for (const AcousticVoxel& voxel : body.voxels) ct.voxels.push_back(voxel.hu);
    write_ct(folder.path / "ct.nrrd", ct);
    if (!with_images) return;
    if (breath_mm > 0) body = deformed(body, breath({0, 55, 0}, breath_mm));
    const gl::HeadlessContext context;
    const Probe probe = *find_probe("curvilinear");
    const TrackedSweep sweep =
        synthetic_sweep(body, read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml"), probe, kDepth_mm,
                        trainer_settings(probe.frequency_mhz, kDepth_mm),
                        hand_sweep(test::on_the_skin(0, 6, 0), breath_mm > 0 ? 16 : 12, 12, 16), kWidth, kHeight);
    record("sweep.igs.mha", sweep, [](float grey) { return std::isnan(grey) ? 0 : int(grey); });
    record("black.igs.mha", sweep, [](float) { return 0; });
    record_dicom("sweep.dcm", "poses.txt", sweep);
    TrackedSweep three = sweep;
    three.images.resize(3);
    record("three.igs.mha", three, [](float grey) { return std::isnan(grey) ? 0 : int(grey); });
  }
  template <typename Grey>
  void record(const char* name, const TrackedSweep& sweep, Grey&& grey) const {
    SequenceRecorder recorder(folder.path / name, kWidth, kHeight);
    const ImageGeometry geometry = image_geometry(sweep.probe, kDepth_mm, kWidth, kHeight);
    double time_s = 1;
    for (const SweepImage& image : sweep.images) {
      Image<std::uint8_t> picture(kWidth, kHeight);
      std::ranges::transform(image.grey.pixels, picture.pixels.begin(),
                             [&](float each) { return std::uint8_t(grey(each)); });
      Pose pose = image.sweep_from_probe;
      pose.translation -= glm::dvec3(3, -2, 4);
      recorder.add({time_s, PoseStatus::ok, pose}, picture, patient_from_pixel(Pose{}, geometry));
      time_s += 0.1;
    }
    recorder.finish();
  }
  void record_dicom(const char* name, const char* poses_name, const TrackedSweep& sweep) const {
    const ImageGeometry geometry = image_geometry(sweep.probe, kDepth_mm, kWidth, kHeight);
    DicomClip clip;
    clip.columns = kWidth;
    clip.rows = kHeight;
    clip.frames = int(sweep.images.size());
    clip.regions = {{0, 0, kWidth - 1, kHeight - 1, 1, 1, 3, geometry.mm_per_pixel / 10, geometry.mm_per_pixel / 10}};
    std::string poses;
    for (const SweepImage& image : sweep.images) {
      for (const float grey : image.grey.pixels) clip.stored.push_back(std::isnan(grey) ? 0 : std::uint8_t(grey));
      Pose pose = image.sweep_from_probe;
      pose.translation -= glm::dvec3(3, -2, 4);
      const glm::dmat4 rows = glm::transpose(pose.matrix());
      for (int i = 0; i < 16; ++i) poses += exact_text(rows[i / 4][i % 4]) + (i < 15 ? " " : "\n");
    }
    write_dicom_clip(folder.path / name, clip);
    folder.put(poses_name, poses);
  }
  std::string in(const char* name) const { return (folder.path / name).string(); }
  ProgramOutcome run_as_found(const std::string& arguments,
                              const std::string& search = "--search-mm 12 --search-deg 8") const {
    return run_program(INSONATE_REGISTER_PROGRAM " --ct " + in("ct.nrrd") + " " + search + " " + arguments);
  }
  ProgramOutcome run(const std::string& arguments, const std::string& search = "--search-mm 12 --search-deg 8") const {
    return run_program(INSONATE_REGISTER_PROGRAM " --ct " + in("ct.nrrd") + " --probe curvilinear --depth 100 " +
                       search + " " + arguments);
  }
};

}  // namespace

TEST_CASE("a recording is registered, and everything about it lies in a new folder") {
  const Workplace place;
  const ProgramOutcome outcome = place.run(place.in("sweep.igs.mha") + " " + place.in("out"));
  INFO(outcome.errors << outcome.output);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.output.find("Transform of the probe: ProbeToPatient.\nConverged: the expected error") == 0);
  const fs::path out = place.in("out");
  const auto json = nlohmann::json::parse(read_file(out / "registration.json"));
  CHECK(json["converged"] == true);
  CHECK(json["frames"] == 12);
  CHECK(json["similarity_after"] > json["similarity_before"]);
  // What it takes to do it again.
  CHECK(json["command"].get<std::string>().find("insonate-register --ct " + place.in("ct.nrrd") + " --probe") == 0);
  CHECK(json["recording_digest"] == digest_of(read_file(place.in("sweep.igs.mha"))));
  CHECK(json["ct_digest"] == digest_of(read_file(place.in("ct.nrrd"))));
  CHECK(json["made_by"].contains("Commit"));
  CHECK(json["made_by"]["OpenGL"].get<std::string>().find(", OpenGL 4.") != std::string::npos);
  CHECK(json["transform"] == "ProbeToPatient");
  CHECK(json["patch"] == 8);
  // The shift of the recording, within the size of the CT's voxels.
  const double shift[] = {3, -2, 4};
  for (std::size_t row = 0; row < 3; ++row) {
    CHECK(json["ct_from_sweep"][row][3].get<double>() == Approx(shift[row]).margin(4));
    CHECK(json["ct_from_sweep"][row][row].get<double>() > 0.995);
    CHECK(json["parameters"][row == 0 ? "tx" : row == 1 ? "ty" : "tz"]["standard_deviation_mm"] > 0);
  }
  for (const char* file :
       {"ct_from_sweep.tfm", "sweep_from_ct.tfm", "ct_from_sweep.h5", "sweep_from_ct.h5", "scene.mrml", "index.html"})
    CHECK(read_file(out / file).find("Converged") != std::string::npos);
  const std::string csv = read_file(out / "evaluations.csv");
  CHECK(csv.find("evaluation,stage,similarity,tx_mm,ty_mm,tz_mm,rx_mm,ry_mm,rz_mm\n0,") == 0);
  CHECK(std::size_t(std::count(csv.begin(), csv.end(), '\n')) == json["evaluations"].get<std::size_t>() + 1);
  CHECK(read_ct(out / "ct.nrrd").grid.spacing.x == Approx(1).epsilon(0.2));  // the program resamples what it reads
  CHECK(read_labels(out / "sweep.nrrd").grid.size.x > 50);
  std::size_t shown = 0;
  const std::string page = read_file(out / "index.html");
  for (const auto& picture : fs::directory_iterator(out / "pictures")) {
    CHECK(page.find("src='pictures/" + picture.path().filename().string() + "'") != std::string::npos);
    ++shown;
  }
  CHECK(shown == 20);
  // The page shows the matrix that the JSON holds.
  CHECK(page.find(formatted("%12.6f\n", json["ct_from_sweep"][1][3].get<double>())) != std::string::npos);
  // A name that is taken is refused before any work.
  const ProgramOutcome again = place.run(place.in("sweep.igs.mha") + " " + place.in("out"));
  CHECK(again.code == 2);
}

TEST_CASE("an option takes no more than it asks for, wherever it stands") {
  const Workplace place;
  const ProgramOutcome outcome =
      place.run("--clip 0,0,160,120 " + place.in("sweep.igs.mha") + " --slices 6 " + place.in("out"),
                "--search-mm 0 --search-deg 0");
  INFO(outcome.errors);
  CHECK((outcome.code == 0 || outcome.code == 3));
  CHECK(place.run_as_found("--beam 0,1,0 " + place.in("sweep.igs.mha") + " --slices 6 " + place.in("more"))
            .errors.find("it is a recording, not a volume; leave out --beam") != std::string::npos);
}

TEST_CASE("a mask that leaves nothing is refused") {
  const Workplace place(true);
  write_png(place.in("black.png"), Image<std::uint8_t>(kWidth, kHeight));
  const ProgramOutcome outcome =
      place.run("--mask " + place.in("black.png") + " " + place.in("sweep.igs.mha") + " " + place.in("out"));
  CHECK(outcome.code == 2);
  CHECK(outcome.errors.find("black.png: the mask is black") != std::string::npos);
}

TEST_CASE("a recording is registered with the probe that its images show") {
  const Workplace place;
  const ProgramOutcome outcome = place.run_as_found(place.in("sweep.igs.mha") + " " + place.in("out"));
  INFO(outcome.errors << outcome.output);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.output.find("\nFound in the images: curvilinear, radius ") != std::string::npos);
  const auto json = nlohmann::json::parse(read_file(fs::path(place.in("out")) / "registration.json"));
  CHECK(json["probe"]["found_from_images"] == true);
  CHECK(json["probe"]["kind"] == "curvilinear");
  // A pixel is 1 mm large.
  CHECK(json["probe"]["radius_mm"].get<double>() == Approx(60).margin(2));
  CHECK(json["probe"]["field_of_view_deg"].get<double>() == Approx(60).margin(1));
  CHECK(json["probe"]["depth_mm"].get<double>() == Approx(kDepth_mm).margin(1));
  CHECK(read_file(fs::path(place.in("out")) / "index.html").find("found from the images") != std::string::npos);
  const ProgramOutcome with_depth =
      place.run_as_found("--depth 90 " + place.in("sweep.igs.mha") + " " + place.in("more"));
  CHECK(with_depth.code == 2);
  CHECK(with_depth.errors.find("--depth: the probe is found from the images") != std::string::npos);
  const ProgramOutcome black = place.run_as_found(place.in("black.igs.mha") + " " + place.in("more"));
  CHECK(black.code == 2);
  CHECK(black.errors.find("black.igs.mha: its images show no fan: hardly any pixel carries echo; name the probe") !=
        std::string::npos);
}

TEST_CASE("a volume of a sweep is registered by the probe and the planes that it shows") {
  const Workplace place;
  // The sweep as a volume of voxels of 1 mm, in the recording's frame.
  REQUIRE(place.run(place.in("sweep.igs.mha") + " " + place.in("first")).code == 0);
  const ProgramOutcome outcome = place.run_as_found(
      "--beam 0,1,0 " + (fs::path(place.in("first")) / "sweep.nrrd").string() + " " + place.in("out"),
      "--search-mm 6 --search-deg 4");  // a volume of so few images is nearly as similar at places further off
  INFO(outcome.errors << outcome.output);
  REQUIRE((outcome.code == 0 || outcome.code == 3));
  const auto json = nlohmann::json::parse(read_file(fs::path(place.in("out")) / "registration.json"));
  CHECK(outcome.output.find("Found in the volume: curvilinear, radius ") == 0);
  // The sweep slides along z by 16 mm and tilts by 24 degrees.
  CHECK(outcome.output.find("; planes tilted over 2") != std::string::npos);
  CHECK(json["probe"]["kind"] == "curvilinear");
  CHECK(json["probe"]["found_in_volume"].get<std::string>().find("; planes tilted over 2") != std::string::npos);
  CHECK(json["probe"]["radius_mm"].get<double>() == Approx(60).margin(3));  // from voxels of 1 mm
  CHECK(json["probe"]["depth_mm"].get<double>() == Approx(kDepth_mm).margin(2));
  // The shift of the recording, within the size of the CT's voxels.
  const double shift[] = {3, -2, 4};
  for (std::size_t row = 0; row < 3; ++row) {
    CHECK(json["ct_from_sweep"][row][3].get<double>() == Approx(shift[row]).margin(4));
    CHECK(json["ct_from_sweep"][row][row].get<double>() > 0.99);
  }
  CHECK(json["similarity_after"] > json["similarity_before"]);
  const auto refused = [&](const std::string& arguments, const std::string& sentence) {
    const ProgramOutcome bad = place.run_as_found(arguments + " " + place.in("more"));
    INFO(bad.errors);
    CHECK(bad.code == 2);
    CHECK(bad.errors.find(sentence) != std::string::npos);
  };
  refused("--beam 0,0,0 " + place.in("first/sweep.nrrd"), "--beam: it is not a direction");
  refused("--beam 0,1,0 --depth 90 " + place.in("first/sweep.nrrd"), "--depth excludes --beam");
  refused("--beam 0,1,0 " + place.in("sweep.igs.mha"),
          "sweep.igs.mha: it is a recording, not a volume; leave out --beam");
}

TEST_CASE("a clip of DICOM ultrasound with its poses is registered inside a label map") {
  const Workplace place;
  // All but the first image of the sweep, which slides along z from -8 to 8 mm before the shift.
  Volume<std::uint8_t> labels{{{61, 61, 61}, glm::dvec3(3), {-90, -60, -150}, glm::dmat3(1)}, {}};
  labels.voxels.assign(labels.grid.count(), 0);
  for (int k = 0; k < 61; ++k)
    for (int j = 0; j < 61; ++j)
      for (int i = 0; i < 61; ++i) labels.at({i, j, k}) = labels.grid.patient_from_index(glm::dvec3(i, j, k)).z > -7.5;
  write_labels(place.folder.path / "inside.nrrd", labels);
  const ProgramOutcome outcome =
      run_program(INSONATE_REGISTER_PROGRAM " --ct " + place.in("ct.nrrd") + " --search-mm 12 --search-deg 8 --poses " +
                  place.in("poses.txt") + " --mask-volume " + place.in("inside.nrrd") + " " + place.in("sweep.dcm") +
                  " " + place.in("out"));
  INFO(outcome.errors << outcome.output);
  REQUIRE(outcome.code == 0);
  const auto json = nlohmann::json::parse(read_file(fs::path(place.in("out")) / "registration.json"));
  CHECK(json["frames"] == 12);
  CHECK(json["slices"] > 3);
  CHECK(json["slices"] < 12);
  const double shift[] = {3, -2, 4};
  for (std::size_t row = 0; row < 3; ++row)
    CHECK(json["ct_from_sweep"][row][3].get<double>() == Approx(shift[row]).margin(4));
  CHECK(place.run(place.in("sweep.dcm") + " " + place.in("other")).errors.find("as --poses FILE") != std::string::npos);
  // A recording has poses of its own, whatever the file of others holds.
  CHECK(place.run("--poses " + place.in("sweep.igs.mha") + " " + place.in("sweep.igs.mha") + " " + place.in("other"))
            .errors.find("--poses: they are for DICOM ultrasound") != std::string::npos);
}

TEST_CASE("a recording of a body that has breathed is registered with a deformation") {
  const Workplace place(true, 5);
  const ProgramOutcome outcome =
      place.run("--free-form 25 --smoothness 300 --slices 8 --search-mm 3 --search-deg 3 --start " +
                    place.folder.put("start.txt", "1 0 0 3 0 1 0 -2 0 0 1 4 0 0 0 1\n").string() + " " +
                    place.in("sweep.igs.mha") + " " + place.in("out"),
                "");
  INFO(outcome.errors << outcome.output);
  REQUIRE(outcome.code == 0);
  CHECK(outcome.output.find(" Deformation: LC2 of the images that were not fitted went from ") != std::string::npos);
  const fs::path out = place.in("out");
  const auto json = nlohmann::json::parse(read_file(out / "registration.json"));
  const auto& free_form = json["free_form"];
  CHECK(free_form["improved"] == true);
  CHECK(free_form["spacing_mm"] == 25);
  CHECK(free_form["least_jacobian"] > 0.2);
  const auto& points = free_form["control_points"];
  CHECK(free_form["control_mm"].size() ==
        points[0].get<std::size_t>() * points[1].get<std::size_t>() * points[2].get<std::size_t>());
  CHECK(json["parameters"].size() == 12);  // the deformation follows an affine registration
  for (const char* file : {"ct_from_sweep.nrrd", "sweep_from_ct.nrrd"})
    CHECK(read_file(out / file).find("kinds: vector domain domain domain\n") != std::string::npos);
  for (const char* file : {"ct_from_sweep.tfm", "sweep_from_ct.tfm"})
    CHECK(
        read_file(out / file).find("# The affine part alone; the .h5 and .nrrd files hold the whole map. Converged") !=
        std::string::npos);
  for (const char* file : {"ct_from_sweep.h5", "sweep_from_ct.h5"})
    CHECK(read_file(out / file).find("DisplacementFieldTransform_double_3_3") != std::string::npos);
  CHECK(read_file(out / "scene.mrml").find("fileName=\"sweep_from_ct.nrrd\"") != std::string::npos);
  const std::string csv = read_file(out / "evaluations.csv"), page = read_file(out / "index.html");
  CHECK(csv.find(",shear_xy_mm,bending_energy_mm-2\n0,") != std::string::npos);
  CHECK(csv.find(",free-form vary,") != std::string::npos);
  CHECK(csv.find(",free-form step,") != std::string::npos);
  CHECK(std::size_t(std::count(csv.begin(), csv.end(), '\n')) ==
        1 + json["evaluations"].get<std::size_t>() + free_form["evaluations"].get<std::size_t>());
  CHECK(page.find("Both, deformed") != std::string::npos);
  CHECK(std::distance(fs::directory_iterator(out / "pictures"), {}) == 28);

  // The rigid part of such a result is a start.
  const ProgramOutcome again = place.run("--start " + (out / "registration.json").string() + " --slices 8 " +
                                             place.in("sweep.igs.mha") + " " + place.in("again"),
                                         "--search-mm 3 --search-deg 3");
  INFO(again.errors);
  CHECK(again.code == 0);
}

TEST_CASE("a registration that does not converge exits with 3 and says so in every file") {
  const Workplace place;
  // The search may not leave the start, which is 50 mm off.
  place.folder.put("start.txt", "1 0 0 40 0 1 0 0 0 0 1 30 0 0 0 1\n");
  const ProgramOutcome outcome =
      place.run("--start " + place.in("start.txt") + " " + place.in("sweep.igs.mha") + " " + place.in("out"),
                "--search-mm 0 --search-deg 0");
  INFO(outcome.errors << outcome.output);
  REQUIRE(outcome.code == 3);
  CHECK(outcome.output.find("\nNot converged: ") != std::string::npos);
  const fs::path out = place.in("out");
  CHECK(nlohmann::json::parse(read_file(out / "registration.json"))["converged"] == false);
  for (const char* file :
       {"ct_from_sweep.tfm", "sweep_from_ct.tfm", "ct_from_sweep.h5", "sweep_from_ct.h5", "scene.mrml", "index.html"})
    CHECK(read_file(out / file).find("Not converged: ") != std::string::npos);
}

TEST_CASE("a registration that does not fit on the disk ends in a sentence, and leaves nothing behind") {
  const Workplace place;
  // The first file is too large for each: a picture, a larger one, and a volume.
  for (const char* bytes : {"500", "20000", "300000"}) {
    const ProgramOutcome outcome =
        run_program(std::string("prlimit --fsize=") + bytes + " " + INSONATE_REGISTER_PROGRAM " --ct " +
                    place.in("ct.nrrd") + " --probe curvilinear --depth 100 --search-mm 0 --search-deg 0 --slices 4 " +
                    place.in("sweep.igs.mha") + " " + place.in("out"));
    INFO(bytes << " bytes: " << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.errors.find("cannot be written") != std::string::npos);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    for (const auto& left : fs::directory_iterator(place.folder.path))
      CHECK(left.path().filename().string().find("out") == std::string::npos);
  }
}

TEST_CASE("what insonate-register cannot use it refuses in a sentence, with exit code 2") {
  const Workplace place;
  place.folder.put("away.txt", "1 0 0 0 0 1 0 -100 0 0 1 0 0 0 0 1\n");
  place.folder.put("far.txt", "1 0 0 0 0 1 0 0 0 0 1 900 0 0 0 1\n");
  place.folder.put("start.json", "{\"patient_from_probe\": []}");
  place.folder.put("probe.toml", "kind = \"convex\"\n");
  const std::string sweep = place.in("sweep.igs.mha") + " " + place.in("out");
  const auto refused = [&](const std::string& arguments, const std::string& sentence) {
    const ProgramOutcome outcome = place.run(arguments);
    INFO(arguments << ": " << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(outcome.errors.find(sentence) != std::string::npos);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK_FALSE(fs::exists(place.in("out")));
  };
  refused("--start " + place.in("far.txt") + " " + sweep, "of what the sweep shows lies in the CT");
  refused("--start " + place.in("start.json") + " " + sweep,
          "there is no key 'ct_from_sweep'; write the matrix ct_from");
  refused("--start " + place.in("away.txt") + " " + sweep, "at the start ");
  refused(place.in("black.igs.mha") + " " + place.in("out"), "the images show nothing in the probe's fan");
  refused("--face-pixel 900,900 " + sweep, "% of the probe's fan; name the probe");
  CHECK(place.run_as_found("--probe-file " + place.in("probe.toml") + " " + sweep)
            .errors.find("there is no kind of probe named 'convex'") != std::string::npos);
  refused("--transform ToolToTracker " + sweep, "sweep.igs.mha: ");
  refused("--patch 3 " + sweep, "--patch: ");
  refused("--free-form 25 --measure mi " + sweep,
          "--free-form: a deformation is fitted by LC2 alone; leave out --measure.");
  refused("--free-form 25 --patch 0 " + sweep, "--free-form: a deformation is fitted by patches; give --patch from 4");
  refused("--free-form 2 " + sweep, "--free-form: ");
  refused("--smoothness 10 " + sweep, "--smoothness requires --free-form");
  refused("--free-form 25 " + place.in("three.igs.mha") + " " + place.in("out"),
          "three.igs.mha: a deformation needs 4 images; there are 3; record a longer sweep, or leave out --free-form.");
  refused(place.in("missing.igs.mha") + " " + place.in("out"), "missing.igs.mha: ");
}

TEST_CASE("recordings of PLUS without what a registration needs are refused in a sentence") {
  const fs::path plus = fs::path(INSONATE_SCANS_FOLDER) / "plus";
  if (!fs::exists(plus)) {
    WARN("skipped: there is no " << plus);
    return;
  }
  const Workplace place(false);
  std::size_t tried = 0;
  for (const auto& recording : fs::directory_iterator(plus)) {
    const std::string name = recording.path().filename().string();
    if (name.find(".igs.") == std::string::npos) continue;
    ++tried;
    const ProgramOutcome outcome = place.run(recording.path().string() + " " + place.in("out"));
    INFO(name << ": " << outcome.errors);
    CHECK(outcome.code == 2);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
  }
  CHECK(tried > 3);
}
