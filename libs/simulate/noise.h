// SPDX-License-Identifier: GPL-3.0-or-later
// Procedural noise from integer hashes: no tables, no transcendental functions, so the same bits
// on every thread and machine with IEEE arithmetic.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace axial::simulate {

// Gradient noise with unit lattice spacing: smooth (C2), zero mean, standard deviation about 0.19,
// most energy at wavelengths near 1.5. `seed` picks one of 2^32 unrelated fields.
float gradient_noise(const Eigen::Vector3d& p, std::uint32_t seed);

// Sum of `octaves` fields at p, 2p, 4p... with weights 1, gain, gain^2...; each octave is turned
// and shifted so that no lattice shows through.
float fractal_noise(const Eigen::Vector3d& p, std::uint32_t seed, int octaves, float gain);

// The rotation and shift by which `fractal_noise` passes from one octave to the next, without the
// doubling.
Eigen::Vector3d turn_octave(const Eigen::Vector3d& p);

// 0 below a, 1 above b, a cubic between.
float smooth_step(float a, float b, float x);

// Independent uniform numbers in [0, 1), keyed by (seed, index).
double uniform(std::uint64_t seed, std::uint64_t index);

}  // namespace axial::simulate
