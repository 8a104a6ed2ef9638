#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "sim/core/hash.h"
#include "tools/dataset/study.h"

namespace insonate {

/// Random numbers of one image, or of one patient. Each is a hash of the study's seed, the index, the name of what is
/// drawn and the attempt. So no draw depends on another, and a new key in a study leaves all other draws as they were.
class Draws {
public:
  Draws(std::uint32_t seed, std::uint32_t index) : key_(hash(seed, index)) {}

  std::uint32_t bits(std::string_view what, std::uint32_t attempt = 0) const {
    return hash(hash(key_, number_of(what)), attempt);
  }
  /// Returns a number from `range.least` up to `range.most`, evenly distributed.
  double within(const NumberRange& range, std::string_view what, std::uint32_t attempt = 0) const {
    return range.least + double(unit_float(bits(what, attempt))) * (range.most - range.least);
  }
  /// Returns one of the range's steps; any number if it has no step, or more than a million.
  double step_of(const SteppedRange& stepped, std::string_view what) const {
    if (stepped.step <= 0) return within(stepped.range, what);
    constexpr double kRounding = 1e-9;  // so that 0.3 at steps of 0.1 counts as three steps
    const double steps = std::floor((stepped.range.most - stepped.range.least) / stepped.step + kRounding);
    if (steps > 1e6) return within(stepped.range, what);
    return stepped.range.least + stepped.step * double(below(std::uint32_t(steps) + 1, what));
  }
  /// Returns a whole number below `count`, which is 1 or more.
  std::uint32_t below(std::uint32_t count, std::string_view what, std::uint32_t attempt = 0) const {
    return std::uint32_t(std::uint64_t(bits(what, attempt)) * count >> 32);
  }
  /// Returns an index, by weights of which one is above 0.
  std::size_t weighted(const std::vector<double>& weights, std::string_view what) const {
    double left = 0;
    for (const double weight : weights) left += weight;
    left *= double(unit_float(bits(what)));
    std::size_t last = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] <= 0) continue;
      last = i;
      if (left < weights[i]) return i;
      left -= weights[i];
    }
    return last;
  }

private:
  /// FNV-1a (Fowler, Noll, Vo), 32 bits.
  static constexpr std::uint32_t number_of(std::string_view what) {
    std::uint32_t number = 2166136261u;
    for (const char c : what) number = (number ^ std::uint8_t(c)) * 16777619u;
    return number;
  }

  std::uint32_t key_;
};

}  // namespace insonate
