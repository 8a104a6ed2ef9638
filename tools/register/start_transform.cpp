#include "tools/register/start_transform.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

constexpr std::size_t kLargestFile = 1 << 20;
constexpr double kFarthest_mm = 1e5;         // of a landmark from the origin; a tracker's range is far smaller
constexpr double kMinOffLine_mm = 5;         // of the landmarks
constexpr double kMaxLandmarkError_mm = 30;  // as far as a search looks by default
constexpr double kBody_hu = -300;
constexpr double kMinShare = 0.1;  // of what the sweep shows that lies in the CT, and in the body

/// Returns how far the point that lies farthest from a line through the first point and the one farthest from it lies
/// off that line. Points are columns.
double off_line_mm(const Eigen::MatrixXd& points) {
  double most = 0;
  const Eigen::Vector3d first = points.col(0);
  Eigen::Vector3d along = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 1; i < points.cols(); ++i)
    if ((points.col(i) - first).norm() > along.norm()) along = points.col(i) - first;
  for (Eigen::Index i = 1; i < points.cols() && along.norm() > 0; ++i) {
    const Eigen::Vector3d apart = points.col(i) - first;
    most = std::max(most, apart.cross(along.normalized()).norm());
  }
  return most;
}

std::string percent(double share) {
  return std::to_string(int(std::lround(100 * share))) + " %";
}

}  // namespace

StartTransform start_from_landmarks(const std::string& file) {
  std::istringstream text(read_file(file, kLargestFile));
  std::vector<double> numbers;
  for (std::string word; text >> word;) {
    std::size_t used = 0;
    double number = NAN;
    try {
      number = std::stod(word, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used != word.size() || !(std::abs(number) <= kFarthest_mm))
      throw InputError(file, "number " + std::to_string(numbers.size() + 1),
                       "'" + word + "' is not a number within 100 m of the origin",
                       "write six numbers per landmark: x y z in the sweep and x y z in the CT, mm");
    numbers.push_back(number);
  }
  const std::size_t pairs = numbers.size() / 6;
  if (numbers.size() % 6 != 0 || pairs < 3)
    throw InputError(file, "", "it holds " + std::to_string(numbers.size()) + " numbers",
                     "write six per landmark, of three or more landmarks");
  const Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic>> all(numbers.data(), 6, Eigen::Index(pairs));
  const Eigen::MatrixXd in_sweep = all.topRows(3), in_ct = all.bottomRows(3);
  if (off_line_mm(in_sweep) < kMinOffLine_mm || off_line_mm(in_ct) < kMinOffLine_mm)
    throw InputError(file, "", "the landmarks lie on a line or within 5 mm of it, so no rotation follows from them",
                     "add one that lies beside it, and give all in mm");
  const Eigen::Matrix4d fit = Eigen::umeyama(in_sweep, in_ct, false);
  StartTransform result;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) result.ct_from_sweep[column][row] = fit(row, column);
  const Eigen::MatrixXd apart = (fit.topLeftCorner<3, 3>() * in_sweep).colwise() + fit.topRightCorner<3, 1>() - in_ct;
  result.landmark_error_mm = std::sqrt(apart.squaredNorm() / double(pairs));
  if (*result.landmark_error_mm > kMaxLandmarkError_mm)
    throw InputError(file, "",
                     "the landmarks' places do not fit each other: they stay " +
                         std::to_string(std::lround(*result.landmark_error_mm)) + " mm apart (root mean square)",
                     "write each pair in one line, in mm, and the CT's points in LPS");
  return result;
}

void check_start(const std::string& ct_file, const Volume<std::int16_t>& ct, const TrackedSweep& sweep,
                 const glm::dmat4& ct_from_sweep) {
  const std::string name = ct_file.empty() ? "the built-in patient" : ct_file;
  double points = 0, in_ct = 0, in_body = 0;
  for (const glm::dvec3& point : target_points(sweep)) {
    const glm::dvec3 index = ct.grid.index_from_patient(glm::dvec3(ct_from_sweep * glm::dvec4(point, 1)));
    ++points;
    if (!ct.grid.contains(glm::ivec3(glm::round(index)))) continue;
    ++in_ct;
    in_body += sample_trilinear(ct, index) > kBody_hu;
  }
  if (in_ct < kMinShare * points)
    throw InputError(name, "",
                     "at the start only " + percent(in_ct / points) + " of what the sweep shows lies in the CT",
                     "give a nearer --start or --landmarks, or a CT of the region that was scanned");
  if (in_body < kMinShare * points)
    throw InputError(name, "",
                     "at the start the sweep looks away from the body: only " + percent(in_body / points) +
                         " of what it shows is tissue",
                     "give a nearer --start or --landmarks");
}

}  // namespace insonate
