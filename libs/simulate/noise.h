// SPDX-License-Identifier: GPL-3.0-or-later
// Procedural noise from integer hashes, without tables and transcendental functions. The results
// are identical bit for bit on every thread and on every machine with IEEE arithmetic.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace axial::simulate {

// Gradient noise on a lattice of spacing 1. It is smooth (C2), with mean zero, a standard deviation
// of about 0.19 and most of its energy at wavelengths near 1.5. `seed` selects one of 2^32
// unrelated fields.
float gradient_noise(const Eigen::Vector3d& p, std::uint32_t seed);

// The sum of `octaves` fields of gradient noise. Octave k has the frequency 2^k and the weight
// gain^k, k = 0, 1, ... Each octave is rotated and shifted, so that the lattice is not visible.
float fractal_noise(const Eigen::Vector3d& p, std::uint32_t seed, int octaves, float gain);

// Rotates and shifts a point, by a fixed rotation and a fixed vector. fractal_noise() applies it,
// and a doubling of the frequency, between two octaves.
Eigen::Vector3d turn_octave(const Eigen::Vector3d& p);

// 0 for x <= a, 1 for x >= b, and a cubic that rises smoothly in between. Precondition: a < b.
float smooth_step(float a, float b, float x);

// A pseudo-random number, uniform in [0, 1), that depends only on `seed` and `index`. Numbers of
// different (seed, index) are unrelated.
double uniform(std::uint64_t seed, std::uint64_t index);

}  // namespace axial::simulate
