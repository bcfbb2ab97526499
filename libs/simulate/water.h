// SPDX-License-Identifier: GPL-3.0-or-later
// What water does to light on its way: Jerlov's types of water, in bands of wavelengths.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "simulate/spectrum.h"

namespace axial::simulate {

// Optical properties of water [1/m].
struct Water {
  std::string type;
  Spectrum absorption, scattering;
  Spectrum daylight_loss;  // of light from the surface, by depth (K_d)
  // The share of scattering at angles so small that the light is blurred and not lost, and the
  // standard deviation of these angles [rad].
  float blurred = 0.35f;
  double blur_angle = 0.004;

  // Loss along a ray, without and with the blurred light.
  Spectrum beam() const { return absorption + scattering; }
  Spectrum loss() const { return absorption + (1 - blurred) * scattering; }
};

// The water of a Jerlov type: I, IA, IB, II, III, 1C, 3C, 5C, 7C or 9C. `scattering`: at 550 nm
// [1/m]; scattering is proportional to 1 / wavelength. Empty: a usual value of the type. K_d is
// Jerlov's (Marine Optics, 1976, table XXVII). The absorption follows from Kirk's relation (1984),
// K_d = sqrt(a^2 + (0.425 m - 0.19) a b) / m with m = 0.86, the mean
// cosine of daylight in water.
// Throws an Error for another type, and unless `scattering` is within 0 to 20.
Water jerlov_water(std::string_view type, std::optional<double> scattering = {});

// The part of the light scattered by an angle that goes into a unit of solid angle [1/sr]: Henyey
// and Greenstein's function with mean cosine 0.85. `cosine`: of the angle between the directions in
// which the light travels before and after.
double phase(double cosine);

// Water of three colours without a spectrum: I = J exp(-a d) + B (1 - exp(-b d)) with the distance
// d in water, for tests of programs that assume this model. Channels R G B.
struct PlainWater {
  Eigen::Array3f a, b;  // [1/m]
  Eigen::Array3f veil;  // B, linear, 0 to 1

  // Returns I for J = `color` at the distance `d` [m].
  Eigen::Vector3f seen(const Eigen::Vector3f& color, double d) const;
};

}  // namespace axial::simulate
