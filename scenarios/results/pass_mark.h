#pragma once

#include <span>

namespace insonate {

/// Mean and standard deviation of a group's scores, the latter from the sum of squares over n - 1.
struct GroupScores {
  int count = 0;
  double mean = 0;
  double deviation = 0;
};

/// How many of a group a pass mark judges wrongly, in per cent: as it happened, and as the group's normal says.
struct Misjudged {
  double observed_percent = 0;
  double theoretical_percent = 0;
};

/// A pass mark by contrasting groups: the score at which the normals through the scores of novices and of experts
/// cross, between their means. From P. R. Brandon, "Two versions of the contrasting-groups standard-setting method: a
/// review", Measurement and Evaluation in Counseling and Development 35, 167-181 (2002): with means m and deviations s
/// it is the root between the means of
///   (s2^2 - s1^2) x^2 - 2 (m1 s2^2 - m2 s1^2) x + m1^2 s2^2 - m2^2 s1^2 + 2 s1^2 s2^2 ln(s1 / s2) = 0,
/// and (m1 + m2) / 2 where the deviations are equal.
struct PassMark {
  GroupScores novices;
  GroupScores experts;
  double percent = 0;
  Misjudged false_passes;  ///< novices at the mark or above
  Misjudged false_fails;   ///< experts below it
};

/// From scores in per cent. Throws std::domain_error with a sentence when there is no such mark: a group has fewer than
/// two scores or all of one value, the experts are no better than the novices, or the normals do not cross between
/// their means.
PassMark contrasting_groups(std::span<const double> novices, std::span<const double> experts);

}  // namespace insonate
