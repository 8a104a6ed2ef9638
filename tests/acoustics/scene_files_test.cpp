#include "sim/acoustics/scene_files.h"

#include <catch2/catch.hpp>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/acoustics/helpers.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;
using test::shipped;
namespace fs = std::filesystem;

namespace {

// The numbers of a CSV below its first line.
std::vector<std::vector<double>> numbers_of(const std::string& csv) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line, cell;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    rows.emplace_back();
    std::istringstream cells(line);
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

}  // namespace

TEST_CASE("scatterers are written in metres, in the frame of other programs") {
  CHECK(scatterers_csv({{{1, 20, 3}, -2}, {{0, 5.25, 0}, 0.5}}) ==
        "x_m,y_m,z_m,amplitude\n0.001,-0.003,0.02,-2\n0,0,0.00525,0.5\n");
}

TEST_CASE("elements are written with their angles") {
  const Transducer transducer = shipped("curvilinear");
  const auto rows = numbers_of(elements_csv(transducer));
  REQUIRE(rows.size() == 128);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double angle = (double(i) - 63.5) * transducer.pitch_mm / transducer.radius_mm;
    CHECK(rows[i][3] == Approx(angle));
    CHECK(rows[i][0] == Approx(1e-3 * transducer.radius_mm * std::sin(angle)));
    CHECK(rows[i][1] == 0);
    CHECK(rows[i][2] == Approx(1e-3 * transducer.radius_mm * (std::cos(angle) - 1)));
  }
}

TEST_CASE("the transducer's numbers are written in SI units") {
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 60;
  beamforming.receive_apodization = Apodization::hann;
  const std::string text = transducer_csv(shipped("curvilinear"), beamforming);
  for (const char* line :
       {"\nkind,curvilinear,\n", "\nelements,128,\n", "\npitch,0.000508,m\n", "\nwidth,0.00046,m\n",
        "\nradius,0.04957,m\n", "\nheight,0.0135,m\n", "\nelevation_focus,0.06,m\n", "\nfrequency,3570000,Hz\n",
        "\nbandwidth,79,%\n", "\nsound_speed,1540,m/s\n", "\nsampling_frequency,100000000,Hz\n",
        "\ntransmit_focus,0.06,m\n", "\nreceive_focus,dynamic,\n", "\nreceive_apodization,hann,\n"}) {
    CAPTURE(line);
    CHECK(text.find(line) != std::string::npos);
  }
  CHECK(transducer_csv(shipped("linear"), beamforming).find("radius") == std::string::npos);
}

TEST_CASE("a written scene holds all that repeats its central line") {
  Transducer transducer;
  transducer.elements = 16;
  transducer.height_mm = 2;
  transducer.elevation_focus_mm = 20;
  Beamforming beamforming;
  beamforming.transmit_focus_mm = 20;
  const TemporaryFolder temporary;
  const fs::path folder = temporary.path / "scene";
  // One scatterer at the focus: the line is the pulse, which the two sampled responses and the excitation give.
  write_scene(folder, transducer, beamforming, {{{0, 20, 0}, 1}}, 30);
  CHECK_THROWS_AS(write_scene(folder, transducer, beamforming, {}, 30), InputError);
  for (const char* name : {"scatterers.csv", "transducer.csv", "elements.csv"}) CHECK(fs::exists(folder / name));

  const auto column = [&](const char* name, std::size_t which) {
    std::vector<double> values;
    for (const auto& row : numbers_of(read_file(folder / name))) values.push_back(row[which]);
    return values;
  };
  const std::vector<double> rf = column("central_line.csv", 1), element = column("element_response.csv", 1),
                            excitation = column("excitation.csv", 1);
  const auto times = column("central_line.csv", 0);
  CHECK(times.front() == Approx(2 * 1e-3 / 1540).margin(1e-8));
  CHECK(times[1] - times[0] == Approx(1e-8).epsilon(1e-3));
  CHECK(column("element_response.csv", 0)[element.size() / 2] == Approx(0).margin(1e-15));

  // The pulse from the files, placed so that its middle is at 2 * 20 mm / 1540 m/s.
  std::vector<double> once(element.size() + element.size() - 1), pulse(once.size() + excitation.size() - 1);
  for (std::size_t i = 0; i < element.size(); ++i)
    for (std::size_t k = 0; k < element.size(); ++k) once[i + k] += element[i] * element[k];
  for (std::size_t i = 0; i < once.size(); ++i)
    for (std::size_t k = 0; k < excitation.size(); ++k) pulse[i + k] += once[i] * excitation[k];
  const auto match = [&](std::size_t shift) {  // the normalised correlation at a shift
    double product = 0, ours = 0, theirs = 0;
    for (std::size_t k = 0; k < pulse.size(); ++k) {
      product += pulse[k] * rf[k + shift];
      ours += rf[k + shift] * rf[k + shift];
      theirs += pulse[k] * pulse[k];
    }
    return product / std::sqrt(ours * theirs);
  };
  const auto shift = std::size_t(std::lround((2 * 0.020 / 1540 - times[0]) / 1e-8 - double(pulse.size() - 1) / 2));
  // Half a sample of rounding, an eighth of a radian.
  CHECK(match(shift) > 0.985);
}
