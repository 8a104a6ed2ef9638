#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "devices/bytes.h"
#include "devices/crc16.h"
#include "tests/devices/golden_reports.h"

// Reports that carry a number as their place along x in millimetres, and the way `insonate-devices watch` prints them.
// A test can thus see which reports arrived.
namespace insonate {

using Report = std::vector<unsigned char>;

/// Returns the golden report with its place along x (mm) and a matching sequence number.
inline Report hydra_report(int x) {
  Report report(std::begin(golden::kHydra), std::end(golden::kHydra));
  report[7] = std::uint8_t(x);
  report[8] = std::uint8_t(x);
  report[9] = std::uint8_t(x >> 8);
  const std::uint16_t crc = crc16_1021(Bytes(report).first(50), 0x1d0f);
  report[50] = std::uint8_t(crc);
  report[51] = std::uint8_t(crc >> 8);
  return report;
}

/// Returns the golden frame with its place along x (mm) and a matching frame number.
inline Report viper_frame(int x) {
  Report frame(std::begin(golden::kViper), std::end(golden::kViper));
  frame[12] = std::uint8_t(x);
  frame[13] = std::uint8_t(x >> 8);
  const float centimetres = float(x) / 10;
  std::memcpy(&frame[28], &centimetres, sizeof centimetres);
  const std::uint16_t crc = crc16_arc(Bytes(frame).first(56));
  frame[56] = std::uint8_t(crc);
  frame[57] = std::uint8_t(crc >> 8);
  return frame;
}

/// Returns the places along x (mm) of the samples that a watch has printed as ok; whole lines only.
inline std::vector<int> places(const std::string& out) {
  std::vector<int> places;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = out.find('\n', begin)) != std::string::npos; begin = end + 1) {
    double time_s = 0, x = 0;
    if (std::sscanf(out.substr(begin, end - begin).c_str(), "%lf ok %lf", &time_s, &x) == 2)
      places.push_back(int(std::lround(x)));
  }
  return places;
}

inline std::vector<int> counted(int first, int last) {
  std::vector<int> numbers;
  for (int number = first; number <= last; ++number) numbers.push_back(number);
  return numbers;
}

}  // namespace insonate
