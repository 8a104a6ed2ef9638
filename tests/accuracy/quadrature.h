#pragma once

#include <cmath>

namespace insonate::test {

/// Integrates f from a to b by adaptive Simpson quadrature. A panel is halved until both halves agree with it to
/// `tolerance` (absolute, divided among the halves), or until it is 2^-depth of the whole.
template <typename Function>
class Simpson {
public:
  Simpson(const Function& f, double tolerance) : f_(f), tolerance_(tolerance) {}

  double operator()(double a, double b) const {
    const double fa = f_(a), fm = f_((a + b) / 2), fb = f_(b);
    return refined(a, b, fa, fm, fb, panel(a, b, fa, fm, fb), tolerance_, kDepth);
  }

private:
  static constexpr int kDepth = 40;

  static double panel(double a, double b, double fa, double fm, double fb) { return (b - a) / 6 * (fa + 4 * fm + fb); }

  double refined(double a, double b, double fa, double fm, double fb, double whole, double tolerance, int depth) const {
    const double m = (a + b) / 2, f1 = f_((a + m) / 2), f3 = f_((m + b) / 2);
    const double left = panel(a, m, fa, f1, fm), right = panel(m, b, fm, f3, fb);
    const double difference = left + right - whole;
    if (depth == 0 || std::abs(difference) <= 15 * tolerance) return left + right + difference / 15;
    return refined(a, m, fa, f1, fm, left, tolerance / 2, depth - 1) +
           refined(m, b, fm, f3, fb, right, tolerance / 2, depth - 1);
  }

  const Function& f_;
  double tolerance_;
};

}  // namespace insonate::test
