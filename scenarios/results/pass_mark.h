#pragma once

#include <span>

namespace insonate {

/// Mean and standard deviation of a group's scores. The deviation is computed from the sum of squares over n - 1.
struct GroupScores {
  int count = 0;
  double mean = 0;
  double deviation = 0;
};

/// Share of a group that a pass mark judges wrongly, in per cent: as observed, and from the group's normal
/// distribution.
struct Misjudged {
  double observed_percent = 0;
  double theoretical_percent = 0;
};

/// A pass mark by contrasting groups: the score between the group means at which the normal distributions fitted to
/// novices and to experts cross. From P. R. Brandon, "Two versions of the contrasting-groups standard-setting method: a
/// review", Measurement and Evaluation in Counseling and Development 35, 167-181 (2002). With means m and deviations s,
/// it is the root between the means of
///   (s2^2 - s1^2) x^2 - 2 (m1 s2^2 - m2 s1^2) x + m1^2 s2^2 - m2^2 s1^2 + 2 s1^2 s2^2 ln(s1 / s2) = 0,
/// and (m1 + m2) / 2 if the deviations are equal.
struct PassMark {
  GroupScores novices;
  GroupScores experts;
  double percent = 0;
  Misjudged false_passes;  ///< novices at or above the pass mark
  Misjudged false_fails;   ///< experts below the pass mark
};

/// Returns the pass mark from scores in per cent. Throws std::domain_error with a sentence if there is none: a group
/// has fewer than two scores or only equal ones, the experts are not better than the novices, or the normal
/// distributions do not cross between their means.
PassMark contrasting_groups(std::span<const double> novices, std::span<const double> experts);

}  // namespace insonate
