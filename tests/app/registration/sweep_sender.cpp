// Stands in for a tracked scanner: scans a body or the built-in patient, sends images and transforms over OpenIGTLink
// until it is killed, and prints its port.
//   sweep_sender PORT FOLDER [built-in] [MM DEGREES]
// PORT 0 is any that is free. FOLDER gets ct.nrrd (not of the built-in patient), start.txt, truth.txt and image.txt,
// which is ImageToProbe. The start is off by MM and DEGREES, by default 6 and 5.

#include "sweep_player.h"
#include <glm/gtc/matrix_transform.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "sim/core/text.h"
#include "sim/files/files.h"
#include "sim/gl/headless_context.h"
#include "sim/volume/ct_reader.h"
#include "tests/imaging/test_body.h"
#include "tools/cli/subject.h"

namespace {

void write_matrix(const std::filesystem::path& file, const glm::dmat4& matrix) {
  std::string text;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text += insonate::exact_text(matrix[column][row]) + (column == 3 ? "\n" : " ");
  insonate::write_file(file, text);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace insonate;
  if (argc < 3) return 2;
  const std::filesystem::path folder = argv[2];
  const bool built_in = argc > 3 && std::string(argv[3]) == "built-in";
  const int off = built_in ? 4 : 3;
  const double mm = argc > off + 1 ? std::atof(argv[off]) : 6, degrees = argc > off + 1 ? std::atof(argv[off + 1]) : 5;
  AcousticVolume volume;
  Pose pose = test::on_the_skin(0, 6, 0);
  double depth_mm = 100, tilt_deg = 14, slide_mm = 18;
  const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  if (built_in) {
    const Case subject = open_subject({});
    volume = make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table);
    pose = subject.views.front().patient_from_probe;
    depth_mm = 150;
    tilt_deg = 20;
    slide_mm = 20;
  } else {
    volume = test::test_body();
    Volume<std::int16_t> ct;
    ct.grid = volume.grid;
    for (const AcousticVoxel& voxel : volume.voxels) ct.voxels.push_back(voxel.hu);
    write_ct(folder / "ct.nrrd", ct);
  }
  test::Scan scan;
  {
    const gl::HeadlessContext context;
    scan = test::make_scan(volume, table, *find_probe("curvilinear"), depth_mm,
                           hand_sweep(pose, 60, tilt_deg, slide_mm), 480, 360);
  }
  write_matrix(folder / "start.txt", test::start_off_by(scan, mm * glm::normalize(glm::dvec3(2, -1, 1)), degrees));
  write_matrix(folder / "truth.txt", scan.ct_from_tracker);
  write_matrix(folder / "image.txt", scan.probe_from_pixel);
  const test::SweepPlayer player(scan, {}, std::uint16_t(std::atoi(argv[1])));
  std::printf("%d\nThe start is off by %.1f mm.\n", int(player.port()),
              test::error_of(scan, test::start_off_by(scan, mm * glm::normalize(glm::dvec3(2, -1, 1)), degrees)));
  std::fflush(stdout);
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}
