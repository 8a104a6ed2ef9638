#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace insonate {

using Parameters = std::vector<double>;

/// Evaluates several points in one call: returns one finite number per point.
using EvaluateAll = std::function<std::vector<double>(std::span<const Parameters>)>;

/// How local searches run.
struct LocalSearch {
  Parameters low, high;        ///< bounds; a start that lies outside begins at the nearest place within
  double first_step = 1;       ///< in each parameter
  double tolerance = 0.01;     ///< ends when no parameter changes by more
  int most_evaluations = 500;  ///< per start
};

/// Where a local search ended.
struct Optimum {
  Parameters at;
  double value = 0;
  int evaluations = 0;
  bool within_tolerance = false;  ///< false: it used up its evaluations
};

/// Maximises a function from several starts by BOBYQA of NLopt (M. J. D. Powell, "The BOBYQA algorithm for bound
/// constrained optimization without derivatives", DAMTP 2009/NA06). The searches advance together: each call of
/// `evaluate` has the next point of every search that has not ended. So a call with many points can be cheap.
///
/// `evaluate` is called on the caller's thread; what it throws ends all searches and is thrown on. The result depends
/// on no thread's speed. Throws std::runtime_error if NLopt fails.
/// @param starts  each of 2 or more parameters
/// @return one optimum per start, in their order
std::vector<Optimum> maximise_from(const std::vector<Parameters>& starts, const EvaluateAll& evaluate,
                                   const LocalSearch& search);

/// Returns whether a higher place lies on the same hill: along the straight way to it, in 8 steps, no value is below
/// 0.98 times that of `from`. A smaller dip is unevenness. False if `from` reaches 0.98 times the value of `to`: of two
/// places on a plateau, none is the better one. Values must be shares, from 0 on.
bool leads_up(const Optimum& from, const Optimum& to, const EvaluateAll& evaluate);

/// Returns parameters of rigid motions that fill a range: translations in a ball, rotations in another. They are points
/// of Halton's sequence (J. H. Halton, Numerische Mathematik 2, 1960), so equal calls give equal points. Both are
/// denser at the middle, where a start that is worth giving is likely to be right: an even point at the share r of a
/// ball's radius is moved to r^2.
/// @param first  how many points of the sequence come before these
std::vector<Parameters> scattered_motions(std::size_t first, std::size_t count, double translation_mm,
                                          double rotation_mm);

}  // namespace insonate
