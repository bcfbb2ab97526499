// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace axial {

// The sums of pairs of numbers from which their correlation follows. Digits are lost if a mean is
// many standard deviations from 0: six digits remain at 10,000 of them.
struct PairSums {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;

  void add(double p, double q) {
    n += 1;
    a += p;
    b += q;
    aa += p * p;
    bb += q * q;
    ab += p * q;
  }

  // Pearson's; 0 if one of the numbers does not vary, or without pairs.
  double correlation() const {
    const double variances = (aa - a * a / n) * (bb - b * b / n);
    return n > 0 && variances > 0 ? (ab - a * b / n) / std::sqrt(variances) : 0;
  }
};

}  // namespace axial
