// SPDX-License-Identifier: GPL-3.0-or-later
// The transfer function of sRGB (IEC 61966-2-1), from and to values from 0 to 1.
#pragma once

#include <cmath>

namespace axial {

inline double light_of_srgb(double value) {
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

inline double srgb_of_light(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace axial
