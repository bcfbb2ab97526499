// SPDX-License-Identifier: GPL-3.0-or-later
#include "video/motion.h"

#include <cmath>

namespace axial::video {

Motion then(const Motion& first, const Motion& second) {
  return {second.turn * first.turn, second.turn * first.shift + second.shift};
}

// The displacement of z is (turn - 1) z + shift. The mean of z over the picture is 0, and the mean
// of |z|^2 is (1 + aspect^2) / 12.
double displacement(const Motion& motion, double aspect) {
  const double mean_square = (1 + aspect * aspect) / 12;
  return std::sqrt(std::norm(motion.turn - 1.0) * mean_square + std::norm(motion.shift));
}

}  // namespace axial::video
