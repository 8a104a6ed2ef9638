// The noise of a CT must not be taken for anatomy: the same patient at a lower dose gives the same pictures. Labels say
// only where the organs are; the pictures are of the CT alone.

#include <catch2/catch.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <vector>

#include "sim/imaging/simulator.h"
#include "sim/tissue/ct_noise.h"
#include "sim/volume/ct_reader.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/real_ct.h"

using namespace insonate;

namespace {

const std::filesystem::path kSlab = INSONATE_SCANS_FOLDER "/abdomen_ct/upper_ct.nii.gz";
const std::filesystem::path kSlabLabels = INSONATE_SCANS_FOLDER "/abdomen_ct/upper_labels.nii.gz";

/// Returns the scan as open_case() does, with noise of a standard deviation added to the scanner's own voxels.
Case scan_with_noise(const std::filesystem::path& file, double noise_hu) {
  Case subject;
  subject.ct = read_ct(file);
  std::mt19937 random(1);
  std::normal_distribution<double> noise;
  for (std::int16_t& hu : subject.ct.voxels)
    hu = std::int16_t(std::max(-1024.0, hu + std::round(noise_hu * noise(random))));
  subject.ct = resample_isotropic(subject.ct, kInsonatedVoxel_mm);
  return subject;
}

/// Returns the patient's pictures, one for each pose.
std::vector<Image<std::uint8_t>> pictures(gl::Simulator& simulator, const Case& subject,
                                          const std::vector<Pose>& poses) {
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const Probe& probe = *find_probe("curvilinear");
  const AcousticVolume acoustic = make_acoustic_volume(subject.ct, {}, {}, table);
  simulator.set_volume(acoustic, table);
  simulator.set_probe(probe, 160);
  simulator.set_settings(trainer_settings(probe.frequency_mhz, 160));
  std::vector<Image<std::uint8_t>> pictures;
  for (const Pose& pose : poses) {
    simulator.set_pose(pose);
    pictures.push_back(simulator.read_stages().grey);
  }
  return pictures;
}

/// From the front, the flanks and between, at two heights.
std::vector<Pose> poses_around(const Case& subject, double above_centre_mm) {
  std::vector<Pose> poses;
  for (const double degrees : {-20.0, 0.0, 30.0, 60.0, 90.0, 120.0})
    for (const double z : {-20.0, 10.0}) {
      const double angle = glm::radians(degrees);
      poses.push_back(test::on_skin_of(subject, subject.ct.grid.centre() + glm::dvec3(0, 0, above_centre_mm + z),
                                       {std::cos(angle), std::sin(angle), 0}));
    }
  return poses;
}

struct Means {
  double pixels = 0, grey_before = 0, grey = 0, hu = 0;  ///< sums
  double change() const { return (grey - grey_before) / pixels; }
};

}  // namespace

TEST_CASE("noise of 20 HU changes no organ's mean grey by three levels") {
  if (!std::filesystem::exists(kSlab)) {
    WARN("skipped: the real scans are not there");
    return;
  }
  const test::TestContext context;
  gl::Simulator simulator;
  const Case clear = scan_with_noise(kSlab, 0), noisy = scan_with_noise(kSlab, 20);
  const Volume<std::uint8_t> labels = resample_labels(read_labels(kSlabLabels), clear.ct.grid);
  const Volume<std::int16_t> density = without_noise(clear.ct, ct_noise_hu(clear.ct));
  std::map<int, Means> organs;
  const std::vector<Pose> poses = poses_around(clear, 0);
  const auto without_noise_added = pictures(simulator, clear, poses), with_noise = pictures(simulator, noisy, poses);
  const ImageGeometry geometry = simulator.geometry();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& pose = poses[i];
    const Image<std::uint8_t>&before = without_noise_added[i], &now = with_noise[i];
    for (int y = 0; y < now.height; ++y)
      for (int x = 0; x < now.width; ++x) {
        const glm::dvec3 at = clear.ct.grid.index_from_patient(pose.point({geometry.plane_mm(x, y), 0}));
        const std::uint8_t label = sample_nearest(labels, at);
        if (label == 0) continue;
        Means& means = organs[label];
        means.grey_before += before.at(x, y);
        means.grey += now.at(x, y);
        means.hu += sample_trilinear(density, at);
        ++means.pixels;
      }
  }
  int compared = 0;
  for (const auto& [label, means] : organs) {
    if (means.pixels < 2000) continue;
    INFO("label " << label << ": " << means.pixels << " pixels of " << means.hu / means.pixels << " HU and grey "
                  << means.grey_before / means.pixels << " change by " << means.change());
    // From -30 to -5 HU and from 8 to 14 HU echogenicity falls and rises by over 40 dB, because fluid lies between. An
    // organ there, like this patient's kidneys and fatty pancreas, has parts on either side, and a few HU decide.
    const double mean_hu = means.hu / means.pixels;
    const bool near_fluid = mean_hu > -30 && mean_hu < 20;
    CHECK(std::abs(means.change()) < (near_fluid ? 10 : 3));
    compared += !near_fluid;
  }
  CHECK(compared >= 8);
}

TEST_CASE("noise of 20 HU leaves a whole picture's mean grey as it is") {
  if (!std::filesystem::exists(test::kRealCt)) {
    WARN("skipped: the real scans are not there");
    return;
  }
  const test::TestContext context;
  gl::Simulator simulator;
  const Case clear = scan_with_noise(test::kRealCt, 0), noisy = scan_with_noise(test::kRealCt, 20);
  const std::vector<Pose> poses = poses_around(clear, 90);
  const auto before = pictures(simulator, clear, poses), now = pictures(simulator, noisy, poses);
  const auto mean = [](const Image<std::uint8_t>& grey) {
    double sum = 0, inside = 0;
    for (const std::uint8_t level : grey.pixels) {
      sum += level;
      inside += level > 0;
    }
    return sum / inside;
  };
  for (std::size_t i = 0; i < poses.size(); ++i) CHECK(mean(now[i]) == Approx(mean(before[i])).margin(3));
}
