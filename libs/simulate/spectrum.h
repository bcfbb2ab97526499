// SPDX-License-Identifier: GPL-3.0-or-later
// Light in bands of wavelengths, and the colours that a camera makes of it.
#pragma once

#include <Eigen/Core>
#include <array>

namespace axial::simulate {

// A number for each band of 20 nm from 400 to 700 nm.
inline constexpr int kBands = 16;
using Spectrum = Eigen::Array<float, kBands, 1>;

// The middle of a band [nm].
constexpr double wavelength(int band) {
  return 400 + 20 * band;
}

// Interpolates linearly between values at 400, 425, 450 ... 700 nm.
Spectrum spectrum_of(const std::array<double, 13>& values);

// The sensitivities of a camera: rows R G B. Each row has the sum 1, so that the colour of the
// spectrum 1 is (1, 1, 1).
const Eigen::Matrix<float, 3, kBands>& sensitivities();

// The linear colour (R G B) of a spectrum.
Eigen::Vector3f color_of(const Spectrum& light);

// A smooth reflectance, within 0.002 to 1, whose color_of() is `color` (linear R G B, 0 to 1), or
// near it if no reflectance within these bounds has this colour.
Spectrum reflectance_of(const Eigen::Vector3f& color);

// The spectra of daylight at the surface (a black body of 6,500 K) and of a white LED. The mean of
// each is 1.
Spectrum daylight();
Spectrum white_led();

}  // namespace axial::simulate
