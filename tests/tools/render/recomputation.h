#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/tools/render/stage_folder.h"

namespace outsider {

inline constexpr double kFloat = 6e-8;  // largest relative error of rounding to float32

/// Holds what the recomputation of each part of a folder starts from, and the worst disagreements found.
class Recomputation {
public:
  explicit Recomputation(const StageFolder& stages);

  std::map<std::string, double> worst() const { return worst_; }

protected:
  const Plane& plane(const std::string& name) const { return planes_.at(name); }
  double value(const char* key) const { return about_.at(key); }
  double setting(const char* key) const { return set_.at(key); }
  bool on(const char* key) const { return set_.at(key); }
  void compare(const std::string& stage, double expected, double got, double tolerated);
  bool inside(int x, int y) const { return plane("pixel_line").at(x, y) > -1; }

  void pixels();
  Plane converted(const Plane& from) const;

  const StageFolder& stages_;
  const nlohmann::json &about_, &set_;
  const std::map<std::string, Plane>& planes_;
  std::vector<Vec3> starts_, directions_;
  int n_ = 0, d_ = 0;  // lines, samples
  double dr_ = 0, r_min_ = 0;

private:
  std::map<std::string, double> worst_;
};

inline Vec3 vec3(const nlohmann::json& json) {
  return {json.at(0), json.at(1), json.at(2)};
}

// Each function recomputes its part and returns the worst disagreement by stage.
std::map<std::string, double> line_misfits(const StageFolder& stages, const Tolerances& tolerances);
std::map<std::string, double> echo_misfits(const StageFolder& stages, const Tolerances& tolerances);
std::map<std::string, double> picture_misfits(const StageFolder& stages, const Tolerances& tolerances);

}  // namespace outsider
