// SPDX-License-Identifier: GPL-3.0-or-later
// How different colours look.
#pragma once

#include <Eigen/Core>
#include <array>

namespace axial::color {

// CIE L*a*b* of linear sRGB, for the white of D65 (IEC 61966-2-1, CIE 15).
std::array<double, 3> lab_of(const Eigen::Array3f& rgb);

// CIEDE2000 of two colours in CIE L*a*b* (Sharma, Wu and Dalal 2005). 1 is just visible.
double ciede2000(const std::array<double, 3>& first, const std::array<double, 3>& second);

}  // namespace axial::color
