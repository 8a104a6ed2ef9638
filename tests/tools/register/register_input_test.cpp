// What insonate-register reads besides the CT: recordings with images, probes, and whether the start fits the CT.
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "devices/record/sequence_recorder.h"
#include "devices/replay/read_log.h"
#include "devices/sequence/recorded_images.h"
#include "sim/core/image.h"
#include "sim/core/input_error.h"
#include "sim/files/png.h"
#include "sim/reconstruction/tracked_picture.h"
#include "sim/registration/echo_seen.h"
#include "sim/registration/find_fan.h"
#include "tests/core/temporary_folder.h"
#include "tests/volume/dicom_files.h"
#include "tools/register/read_sweep.h"
#include "tools/register/read_volume.h"
#include "tools/register/start_transform.h"

using namespace insonate;
using Catch::Contains;

namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr double kPixel_mm = 1.5;  // an image of 60 x 45 mm, which a linear probe of 40 mm fits into

/// Images of a gradient, whose top middle is the probe's face.
glm::dmat4 usual_matrix() {
  return {{kPixel_mm, 0, 0, 0}, {0, kPixel_mm, 0, 0}, {0, 0, 1, 0}, {-kPixel_mm * kWidth / 2, 0, 0, 1}};
}

struct Recorded {
  TemporaryFolder folder;
  SweepInput input;

  Recorded() {
    input.file = (folder.path / "scan.igs.mha").string();
    input.probe = *find_probe("linear");
    input.probe->lines = 64;
    input.depth_mm = 40;
  }

  void record(const glm::dmat4& matrix, int grey_step = 5, PoseStatus status = PoseStatus::ok) const {
    std::filesystem::remove(input.file);
    SequenceRecorder recorder(input.file, kWidth, kHeight);
    for (int i = 0; i < 3; ++i) {
      Image<std::uint8_t> picture(kWidth, kHeight);
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) picture.at(x, y) = std::uint8_t(60 + grey_step * y);
      ProbeSample sample;
      sample.time_s = i;
      sample.status = i == 0 ? PoseStatus::ok : status;
      if (sample.status == PoseStatus::ok) sample.patient_from_probe.translation.z = 2.0 * i;
      recorder.add(sample, picture, matrix);
    }
    recorder.finish();
  }
  void refused(const std::string& sentence) const { CHECK_THROWS_WITH(read_sweep(input), Contains(sentence)); }
};

Probe probe_of(const std::string& text) {
  const TemporaryFolder folder;
  return read_probe(folder.put("probe.toml", text).string());
}

}  // namespace

TEST_CASE("what an image shows beside the fan is not known") {
  SweepInput input;
  input.probe = *find_probe("curvilinear");
  input.depth_mm = 100;
  const ImageGeometry geometry = image_geometry(*input.probe, 100, input.width, input.height);
  const Image<std::uint8_t> grey(input.width, input.height, 50);
  const SweepImage image = place_image(grey, Pose(), patient_from_pixel(Pose(), geometry), input);
  int known = 0;
  for (int y = 1; y + 1 < input.height; ++y)  // at the image's own edge half of the filter's weights are missing
    for (int x = 1; x + 1 < input.width; ++x) {
      const bool is_known = !std::isnan(image.grey.at(x, y));
      known += is_known;
      if (is_known != line_position(*input.probe, 100, geometry.plane_mm(x, y)).has_value()) FAIL(x << " " << y);
    }
  CHECK(known > input.width * input.height / 2);
}

TEST_CASE("a recording is read with its images at the probe's face") {
  Recorded recorded;
  recorded.record(usual_matrix());
  const ReadSweep read = read_sweep(recorded.input);
  CHECK(read.frames == 3);
  CHECK(read.transform == "ProbeToPatient");
  CHECK(read.left_out == 0);
  REQUIRE(read.sweep.images.size() == 3);
  CHECK(read.sweep.images[1].sweep_from_probe.translation.z == Approx(2));
  // A clip hides what is outside of it.
  recorded.input.clip = {{0, 0, kWidth, kHeight - 4}};
  CHECK(read_sweep(recorded.input).sweep.images.size() == 3);
}

TEST_CASE("a recording that cannot be registered is refused in a sentence") {
  Recorded recorded;
  recorded.record(usual_matrix());
  recorded.input.clip = {{0, 0, kWidth + 1, kHeight}};
  recorded.refused(
      "--clip: the rectangle is not within the images of 40 x 30 pixels; give X,Y,WIDTH,HEIGHT in pixels.");
  recorded.input.clip.reset();
  recorded.input.face_pixel = {{500, 500}};
  recorded.refused("scan.igs.mha: the images show only 0 % of the probe's fan; name the probe and the depth");
  recorded.input.face_pixel.reset();
  recorded.input.transform = "ToolToTracker";
  recorded.refused("no frame has the transform 'ToolToTracker'");
  recorded.input.transform.clear();

  recorded.record(usual_matrix(), 0);
  recorded.refused("the images show nothing in the probe's fan: it is of one grey level");
  recorded.record(usual_matrix(), 5, PoseStatus::missing);
  recorded.refused(
      "fewer than two of its images have a pose whose status is OK; name the probe's transform with --transform; "
      "frames without a status of it count as lost.");

  glm::dmat4 off_plane = usual_matrix();
  off_plane[3].z = 3;
  recorded.record(off_plane);
  recorded.refused("the origin of its probe's frame does not lie in the images");
  glm::dmat4 without_size = usual_matrix();
  without_size[0] = {};
  recorded.record(without_size);
  recorded.refused(
      "scan.igs.mha: frame 0: ImageToProbe: a pixel is not from 0.001 mm to 10 mm large; give that matrix");
  recorded.input.probe_from_pixel = usual_matrix();
  CHECK(read_sweep(recorded.input).sweep.images.size() == 3);
  recorded.input.probe_from_pixel.reset();

  const std::string frame =
      "Seq_Frame0000_ProbeToPatientTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0000_ProbeToPatientTransformStatus = OK\nSeq_Frame0000_Timestamp = 0\nElementDataFile = LOCAL\n";
  recorded.folder.put("scan.igs.mha", "ObjectType = Image\nNDims = 3\nDimSize = 0 0 1\n" + frame);
  recorded.refused("it holds no images that can be read; record the ultrasound with the poses.");
  recorded.folder.put("scan.igs.mha",
                      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 1\nElementType = MET_UCHAR\n" + frame + "abcd");
  recorded.refused(
      "it does not say how its images lie in the probe's frame: ImageToProbe is missing, or invalid in all of them");
  recorded.folder.put("scan.igs.mha",
                      "ObjectType = Image\nNDims = 3\nDimSize = 2 2 1\nElementType = MET_UCHAR\n"
                      "Seq_Frame0000_ImageToProbeTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
                      "Seq_Frame0000_ImageToProbeTransformStatus = OK\n" +
                          frame + "abcd");
  recorded.refused("it has one image alone; give a sweep of two images or more.");
}

TEST_CASE("a fan whose pixels have the size of another unit is refused") {
  Recorded recorded;
  recorded.input.probe.reset();
  recorded.input.depth_mm.reset();
  recorded.record(usual_matrix());
  CHECK(read_sweep(recorded.input).sweep.depth_mm == Approx(kPixel_mm * kHeight).margin(kPixel_mm));
  glm::dmat4 in_cm(0.1);
  in_cm[3][3] = 1;
  recorded.record(in_cm * usual_matrix());
  recorded.refused("scan.igs.mha: the fan in its images has a depth of 4.5 mm, not 20 to 400; name");
  recorded.refused("if a pixel is not 0.15 x 0.15 mm large, give the right ImageToProbe as --image-to-probe FILE.");
  // 18 mm are no scan of a body, and 21 mm may be.
  glm::dmat4 smaller(0.4);
  smaller[3][3] = 1;
  recorded.record(smaller * usual_matrix());
  recorded.refused("the fan in its images has a depth of 18.0 mm, not 20 to 400");
  glm::dmat4 small(0.47);
  small[3][3] = 1;
  recorded.record(small * usual_matrix());
  CHECK(read_sweep(recorded.input).sweep.depth_mm == Approx(21).margin(1));
}

TEST_CASE("a file that is not what its ending says is refused by what it lacks") {
  Recorded recorded;
  recorded.input.file = recorded.folder.put("clip.DCM", "not a clip").string();
  recorded.refused("clip.DCM: it is not DICOM: DICM does not stand behind its first 128 bytes; export the clip again");
  const auto volume = [&](const char* name, const std::string& bytes) {
    recorded.input.file = recorded.folder.put(name, bytes).string();
    recorded.refused(
        ": it is not a recording of tracked images: it has no fields Seq_Frame...; if it is a 3D "
        "ultrasound volume, say with --beam X,Y,Z in which direction the sound ran.");
  };
  volume("volume.nrrd",
         "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 1 1\nkinds: domain domain domain\nencoding: raw\n\nab");
  volume("volume.mha",
         "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\nElementType = MET_UCHAR\n"
         "ElementDataFile = LOCAL\nab");
  volume("volume.nii.gz", "any");
  recorded.input.file = (recorded.folder.path / "none.nii").string();
  recorded.refused("none.nii: there is no such file");
  // A recording that is damaged is not taken for a volume.
  recorded.input.file = recorded.folder
                            .put("cut.igs.mha",
                                 "ObjectType = Image\nNDims = 3\nDimSize = 2 2 1\nElementType = MET_UCHAR\n"
                                 "Seq_Frame0000_ProbeToPatientTransformStatus = OK\nElementDataFile = LOCAL\nabcd")
                            .string();
  CHECK_THROWS_WITH(read_sweep(recorded.input), !Contains("--beam"));
}

TEST_CASE("a probe is read from a file, and refused with its line") {
  CHECK(probe_of("kind = \"curvilinear\"\nradius_mm = 50\nfield_of_view_deg = 70\ndepth_mm = 150\n").radius_mm == 50);
  CHECK(probe_of("kind = \"phased\"\nfield_of_view_deg = 90\nwidth_mm = 20\ndepth_mm = 150\n").width_mm == 20);
  const auto refused = [](const std::string& text, const std::string& sentence) {
    CHECK_THROWS_WITH(probe_of(text), Contains("probe.toml: line ") && Contains(sentence));
  };
  refused("\nkind = \"convex\"\n", "line 2, column 8: there is no kind of probe named 'convex'; write curvilinear");
  refused("kind = \"linear\"\nwidth_mm = 4\ndepth_mm = 50\n", "line 2");
  refused("kind = \"linear\"\nwidth_mm = 40\ndepth_mm = 500\n", "line 3");
  refused("kind = \"linear\"\nwidth_mm = 40\ndepth_mm = 50\nradius_mm = 60\n", "radius_mm");
}

TEST_CASE("a mask leaves pixels out") {
  Recorded recorded;
  recorded.record(usual_matrix());
  const auto unknown = [&] {
    std::size_t count = 0;
    const ReadSweep read = read_sweep(recorded.input);
    for (const float pixel : read.sweep.images[0].grey.pixels) count += std::isnan(pixel);
    return count;
  };
  const std::size_t before = unknown();
  Image<std::uint8_t> mask(kWidth, kHeight, 255);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2; ++x) mask.at(x, y) = 0;
  const std::filesystem::path file = recorded.folder.path / "mask.png";
  write_png(file, mask);
  CHECK(read_png(file).pixels == mask.pixels);
  recorded.input.mask = read_png(file);
  recorded.input.mask_file = file.string();
  // The left half of the images, of which the fan of 40 mm takes two thirds.
  CHECK(double(unknown() - before) > 0.3 * double(128 * 96) / 2);
  recorded.input.mask = Image<std::uint8_t>(kWidth + 1, kHeight);
  recorded.refused("mask.png: it has 41 x 30 pixels, and the images have 40 x 30; draw it over one of the images.");
  CHECK_THROWS_WITH(read_png(recorded.input.file), Contains("it cannot be read as a PNG"));
  CHECK_THROWS_WITH(read_png(recorded.folder.path / "none.png"), Contains("there is no such file; check the name."));
  write_png(file, Image<std::uint8_t>(8193, 1));
  CHECK_THROWS_WITH(read_png(file), Contains("mask.png: it has 8193 x 1 pixels; give a PNG with at most 8192 x 8192"));
  const std::string bytes = png_bytes(mask);
  CHECK_THROWS_WITH(read_png(recorded.folder.put("cut.png", bytes.substr(0, bytes.size() - 20))),
                    Contains("cut.png: it is damaged ("));
}

TEST_CASE("a clip of DICOM ultrasound is read with a pose per image, as the same recording is") {
  Recorded recorded;
  recorded.record(usual_matrix());
  recorded.input.clip = {{2, 0, kWidth - 4, kHeight}};
  const ReadSweep expected = read_sweep(recorded.input);
  // The same images, with text beside the region.
  DicomClip clip;
  clip.columns = kWidth;
  clip.rows = kHeight;
  for (int i = 0; i < 3; ++i)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        clip.stored.push_back(x < 2 || x >= kWidth - 2 ? std::uint8_t(80 * i) : std::uint8_t(60 + 5 * y));
  clip.regions = {{2, 0, kWidth - 3, kHeight - 1, 1, 1, 3, kPixel_mm / 10, kPixel_mm / 10}};
  SweepInput input = recorded.input;
  input.file = (recorded.folder.path / "clip.dcm").string();
  input.clip.reset();
  input.poses = {Pose{}, Pose{glm::dmat3(1), {0, 0, 2}}, Pose{glm::dmat3(1), {0, 0, 4}}};
  input.face_pixel = {{kWidth / 2, 0}};
  write_dicom_clip(input.file, clip);
  const auto check_same = [&](const ReadSweep& read) {
    CHECK(read.frames == 3);
    REQUIRE(read.sweep.images.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
      const SweepImage &one = read.sweep.images[i], &other = expected.sweep.images[i];
      CHECK(glm::distance(one.sweep_from_probe.translation, other.sweep_from_probe.translation) < 1e-9);
      std::size_t differ = 0;
      for (std::size_t n = 0; n < one.grey.pixels.size(); ++n) {
        const float a = one.grey.pixels[n], b = other.grey.pixels[n];
        differ += std::isnan(a) != std::isnan(b) || std::abs(a - b) > 1e-3;
      }
      CHECK(differ == 0);
    }
  };
  check_same(read_sweep(input));
  input.face_pixel.reset();
  input.probe_from_pixel = usual_matrix();
  check_same(read_sweep(input));
  SweepInput found = input;
  found.probe.reset();
  found.depth_mm.reset();
  found.probe_from_pixel.reset();
  const ReadSweep by_fan = read_sweep(found);
  REQUIRE(by_fan.fan);
  CHECK(by_fan.sweep.probe.kind == ProbeKind::linear);
  CHECK(by_fan.sweep.probe.width_mm == Approx(kPixel_mm * (kWidth - 4)).margin(kPixel_mm));
  // The poses are those of the face.
  CHECK(glm::distance(by_fan.sweep.images[2].sweep_from_probe.translation, glm::dvec3(0, 0, 4)) < 1e-9);

  const auto refused = [&](const std::string& sentence) { CHECK_THROWS_WITH(read_sweep(input), Contains(sentence)); };
  (*input.probe_from_pixel)[1] *= 1.06;
  refused("--image-to-probe: its pixels are 1.5000 x 1.5900 mm large, and those of the clip 1.5000 x 1.5000 mm; take");
  input.probe_from_pixel.reset();
  refused("clip.dcm: it does not say where the probe's face is in its images; give the pixel");
  input.face_pixel = {{kWidth / 2, 0}};
  input.poses->pop_back();
  refused("--poses: there are 2 poses, and the clip has 3 images; write one matrix per image.");
  input.poses.reset();
  refused("clip.dcm: DICOM does not say where the probe was; give a pose for each of its 3 images as --poses FILE.");
  input.poses = {Pose{}, Pose{}, Pose{}};
  clip.regions.clear();
  write_dicom_clip(input.file, clip);
  refused("clip.dcm: it has no ultrasound region that gives the size of its pixels; give the images' matrix as");
  input.transform = "ProbeToPatient";
  refused("--transform: DICOM ultrasound has no transforms; leave it out, and give --poses FILE.");
  input.transform.clear();
  clip.stored.resize(kWidth * kHeight);
  clip.frames = 1;
  write_dicom_clip(input.file, clip);
  input.poses = {Pose{}};
  refused("clip.dcm: it has one image; name a clip of a sweep.");
}

TEST_CASE("a volume of ultrasound is read as slices along its beam, and one that cannot be is refused") {
  const TemporaryFolder folder;
  // 24 x 24 x 8 voxels, whose values change along y.
  const auto volume = [&](const std::string& name, double spacing_mm, int first, int step) {
    const std::string mm = std::to_string(spacing_mm);
    std::string bytes = "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 24 24 8\n";
    bytes += "space directions: (" + mm + ",0,0) (0," + mm + ",0) (0,0," + mm + ")\n";
    bytes += "space origin: (0,0,0)\nendian: little\nencoding: raw\n\n";
    for (int n = 0; n < 24 * 24 * 8; ++n) {
      const std::int16_t value = std::int16_t(first + step * (n / 24 % 24));
      bytes += {char(value & 0xff), char(value >> 8 & 0xff)};
    }
    return folder.put(name, bytes).string();
  };
  const glm::dvec3 along_y(0, 2, 0), along_z(0, 0, 1);
  const std::string usual = volume("usual.nrrd", 1, 300, 10);
  const ReadSweep read = read_volume_sweep(usual, along_y, {});
  CHECK(read.frames == 20);
  CHECK(read.left_out == 0);
  REQUIRE(read.sweep.images.size() == 20);
  CHECK(read.sweep.probe.width_mm == Approx(23));
  CHECK(read.sweep.depth_mm == Approx(23));
  const Image<float>& grey = read.sweep.images[10].grey;
  CHECK(grey.at(grey.width / 2, grey.height / 4) < grey.at(grey.width / 2, 3 * grey.height / 4));

  // Where numbers below 0 mark what is not known, black is known. The slices reach from the middle of the first row to
  // that of the 24th, and a row of voxels is some 4 rows of their 96 pixels, of which one may count as either.
  const auto known_of = [&](const std::string& file) {
    const ReadSweep of_file = read_volume_sweep(file, along_y, {});
    const std::vector<float>& pixels = of_file.sweep.images[10].grey.pixels;
    return double(std::ranges::count_if(pixels, [](float each) { return !std::isnan(each); }));
  };
  const double all = known_of(usual);
  CHECK(known_of(volume("marked.nrrd", 1, -2, 1)) == Approx(21.5 / 23 * all).epsilon(0.01));
  CHECK(known_of(volume("black.nrrd", 1, 0, 1)) == Approx(22.5 / 23 * all).epsilon(0.01));

  const auto refused = [](const std::string& file, const glm::dvec3& beam, const std::string& sentence) {
    CHECK_THROWS_WITH(read_volume_sweep(file, beam, {}), Contains(sentence));
  };
  refused(usual, glm::dvec3(0), "--beam: it is not a direction; give X,Y,Z in LPS, such as 0,1,0 from front to back.");
  refused(usual, glm::dvec3(NAN), "--beam: it is not a direction");
  refused(volume("scan.seq.nrrd", 1, 300, 10), along_y, "scan.seq.nrrd: it is a recording, not a volume; leave out");
  refused(volume("small.nrrd", 0.1, 300, 10), along_y,
          "small.nrrd: it is 2 mm wide across the beam, not 5 to 200; crop it, or see whether --beam is right.");
  refused(usual, along_z, "usual.nrrd: it is 7 mm deep along the beam, not 10 to 400; crop it");
  refused(volume("dark.nrrd", 1, -1, -1), along_y,
          "dark.nrrd: fewer than two of its slices have a voxel that is known; give a volume of grey levels above 0.");
}

TEST_CASE("a label map keeps the pixels inside its labels alone") {
  Recorded recorded;
  recorded.record(usual_matrix());
  TrackedSweep sweep = read_sweep(recorded.input).sweep;
  const TrackedSweep whole = sweep;
  // Labels left of the probe's middle, about the first two images at z = 0 and 2.
  Volume<std::uint8_t> labels{{{40, 60, 5}, glm::dvec3(1), {-39.5, -10, -1}, glm::dmat3(1)}, {}};
  labels.voxels.assign(labels.grid.count(), 3);
  keep_labelled(sweep, labels, "labels.nrrd");
  REQUIRE(sweep.images.size() == 2);
  CHECK(sweep.images[1].sweep_from_probe.translation.z == Approx(2));
  const Image<float>&kept = sweep.images[0].grey, &before = whole.images[0].grey;
  const ImageGeometry geometry = image_geometry(sweep.probe, sweep.depth_mm, kept.width, kept.height);
  for (int y = 0; y < kept.height; ++y)
    for (int x = 0; x < kept.width; ++x) {
      const bool is_known = geometry.plane_mm(x, y).x < 0 && !std::isnan(before.at(x, y));
      CHECK(std::isnan(kept.at(x, y)) != is_known);
      if (is_known) CHECK(kept.at(x, y) == before.at(x, y));
    }
  labels.grid.size.z = 2;  // the first image alone
  labels.voxels.resize(labels.grid.count());
  sweep = whole;
  CHECK_THROWS_WITH(keep_labelled(sweep, labels, "labels.nrrd"),
                    Contains("labels.nrrd: fewer than two images show anything inside its labels; draw it in"));
}

TEST_CASE("what lies where the CT cuts the body is not compared") {
  Volume<std::int16_t> ct{{{60, 60, 60}, glm::dvec3(2), glm::dvec3(-59), glm::dmat3(1)}, {}};
  ct.voxels.assign(ct.grid.count(), 40);  // tissue from z = -59 to 59, of which a twelfth at each end is left out
  TrackedSweep whole{*find_probe("linear"), 40, {}};
  for (const double z : {-70.0, -52.0, -45.0, 0.0, 45.0, 52.0})
    whole.images.push_back({{glm::dmat3(1), {0, 0, z}}, Image<float>(20, 16, 100.0f)});
  TrackedSweep sweep = whole;
  CHECK(leave_out_ends(sweep, ct, glm::dmat4(1.0)) == Approx(0.5));
  REQUIRE(sweep.images.size() == 3);
  CHECK(sweep.images.front().sweep_from_probe.translation.z == -45);
  CHECK(sweep.images.back().sweep_from_probe.translation.z == 45);

  const glm::dmat4 by_20 = glm::translate(glm::dmat4(1.0), {0, 0, 20});
  sweep = whole;
  CHECK(leave_out_ends(sweep, ct, by_20) == Approx(0.5));
  CHECK(sweep.images.front().sweep_from_probe.translation.z == -52);

  INFO("nothing is left");
  sweep = whole;
  sweep.images.resize(4);
  const glm::dmat4 by_70 = glm::translate(glm::dmat4(1.0), {0, 0, -70});
  CHECK(leave_out_ends(sweep, ct, by_70) == 1);
  CHECK(sweep.images.empty());

  INFO("an end in air cuts nothing");
  ct.voxels.assign(ct.grid.count(), -1000);
  sweep = whole;
  CHECK(leave_out_ends(sweep, ct, glm::dmat4(1.0)) == 0);
  CHECK(sweep.images.size() == 6);
}

TEST_CASE("without a probe, it is found from the fan in the images") {
  constexpr int kLarge = 160;
  Recorded recorded;
  recorded.input.probe.reset();
  recorded.input.depth_mm.reset();
  const Probe phased = *find_probe("phased");
  // A tilted face, 24 pixels below the image's top; the probe's frame begins elsewhere.
  const glm::dvec2 face(85, 24);
  {
    SequenceRecorder recorder(recorded.input.file, kLarge, kLarge);
    for (int i = 0; i < 4; ++i) {
      Image<std::uint8_t> picture(kLarge, kLarge);
      for (int y = 0; y < kLarge; ++y)
        for (int x = 0; x < kLarge; ++x)
          if (line_position(phased, 100, glm::dvec2(x, y) - face)) picture.at(x, y) = std::uint8_t(90 + 20 * i + y / 2);
      recorder.add({double(i), PoseStatus::ok, Pose{glm::dmat3(1), {0, 0, 2.0 * i}}}, picture,
                   glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1));
    }
    recorder.finish();
  }
  const ReadSweep read = read_sweep(recorded.input);
  REQUIRE(read.fan);
  CHECK(read.sweep.probe.kind == ProbeKind::phased);
  CHECK(read.sweep.probe.width_mm == Approx(20).margin(0.5));
  CHECK(read.sweep.probe.field_of_view_deg == Approx(90).margin(1));
  CHECK(read.sweep.depth_mm == Approx(100).margin(1));  // a pixel
  // The fan's frame begins at its face.
  const glm::dvec3 origin = read.sweep.images[0].sweep_from_probe.translation;
  CHECK(origin.x == Approx(7 + face.x).margin(0.5));
  CHECK(origin.y == Approx(8 + face.y).margin(0.5));
  CHECK(origin.z == Approx(9));
  recorded.record(usual_matrix());
  CHECK(read_sweep(recorded.input).sweep.probe.kind == ProbeKind::linear);  // images that are full
  recorded.record(usual_matrix(), 0);
  recorded.refused("the images show nothing in the probe's fan");

  const auto record = [&](std::uint8_t grey, double last_mm) {
    std::filesystem::remove(recorded.input.file);
    SequenceRecorder recorder(recorded.input.file, kWidth, kHeight);
    for (int i = 0; i < 3; ++i) {
      const double mm = i == 2 ? last_mm : kPixel_mm;
      recorder.add({double(i), PoseStatus::ok, Pose{glm::dmat3(1), {0, 0, 2.0 * i}}},
                   Image<std::uint8_t>(kWidth, kHeight, grey),
                   glm::dmat4(mm, 0, 0, 0, 0, mm, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1));
    }
    recorder.finish();
  };
  record(90, 2 * kPixel_mm);
  recorded.refused(
      "scan.igs.mha: frame 2: its pixels have another size; record each depth on its own, and register one of them.");
  record(0, kPixel_mm);
  recorded.refused(
      "scan.igs.mha: its images show no fan: hardly any pixel carries echo; name the probe with --probe and --depth, "
      "or "
      "with --probe-file; if a pixel is not 1.5 x 1.5 mm large, give the right ImageToProbe as --image-to-probe FILE.");
}

TEST_CASE("the fan of a real scanner's image is found, and real images without a fan are refused") {
  const std::filesystem::path plus = std::filesystem::path(INSONATE_SCANS_FOLDER) / "plus";
  if (!std::filesystem::exists(plus)) {
    WARN("skipped: there is no " << plus);
    return;
  }
  const auto search = [&](const char* name) {
    RecordingOptions options;
    options.without_times = true;
    // The transform is not used, so any will do.
    options.transform = std::string(name).starts_with("Bk") ? "StylusToTracker" : "ImageToCroppedImage";
    const RecordedScan scan = read_log((plus / name).string(), options);
    REQUIRE(scan.images);
    ImageReader reader(*scan.images);
    EchoSeen seen;
    for (const RecordedImages::Frame& frame : scan.images->frames) seen.add(reader.grey(frame.number));
    return find_fan(seen.mask(), glm::dvec2(0.3));
  };
  const FanSearch curved = search("BkCurvilinearScanConvertedData.igs.mha");
  REQUIRE(curved.fan);
  INFO(description(*curved.fan));
  // Read off the image by eye: the face's corners at (237, 10) and (362, 10) and its lowest point at row 53, the edges'
  // angle from (237, 10) to (0, 95), the deepest row 386.
  CHECK(curved.fan->probe.kind == ProbeKind::curvilinear);
  CHECK(curved.fan->probe.radius_mm == Approx(0.3 * 67).margin(1));
  CHECK(curved.fan->probe.field_of_view_deg == Approx(140).margin(2));
  CHECK(curved.fan->depth_mm == Approx(0.3 * 333).margin(1));
  CHECK(curved.fan->face_pixel.x == Approx(299.5).margin(1.5));
  CHECK(curved.fan->face_pixel.y == Approx(53).margin(1.5));
  CHECK(curved.fan->shown < 0.97);
  CHECK(search("NwirePhantomFreehandCropped.igs.mha").problem.starts_with("its images show no fan"));
}

TEST_CASE("a start that does not fit the CT is refused before the search") {
  Recorded recorded;
  recorded.record(usual_matrix());
  const TrackedSweep sweep = read_sweep(recorded.input).sweep;
  Volume<std::int16_t> ct;
  ct.grid.size = {41, 31, 11};
  ct.grid.spacing = glm::dvec3(2);
  ct.grid.origin = {-40, -10, -5};
  ct.voxels.assign(ct.grid.count(), 40);
  check_start("ct.nrrd", ct, sweep, glm::dmat4(1.0));
  glm::dmat4 away(1.0);
  away[3].x = 500;
  CHECK_THROWS_WITH(check_start("ct.nrrd", ct, sweep, away),
                    "ct.nrrd: at the start only 0 % of what the sweep shows lies in the CT; give a nearer --start or "
                    "--landmarks, or a CT of the region that was scanned.");
  ct.voxels.assign(ct.grid.count(), -1000);
  CHECK_THROWS_WITH(check_start("", ct, sweep, glm::dmat4(1.0)),
                    "the built-in patient: at the start the sweep looks away from the body: only 0 % of what it shows "
                    "is tissue; give a nearer --start or --landmarks.");
}
