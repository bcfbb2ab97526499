// SPDX-License-Identifier: BSD-3-Clause
// The forward projection through a flat port as a root of a polynomial of degree 12. It is a
// reference for tests, slower and less accurate than FlatPortCamera::project().
//
// The equation to solve is t (d_a + d_g/q_g + z/q_w) = rho, where z is z_water and the symbols are
// those of flat_port_solver.h. Let t0 be the paraxial root of the equation and t = t0/u. With
// rho/t0 as the unit of length, let a = d_a, g = d_g/mu_g and w = z/mu_w. Let e = t0^2
// (mu^2 - 1)/mu^2 for glass (e_g) and for water (e_w). Then
//
//     a + g + w = 1,    p = q_g^2/mu_g^2 = 1 + e_g/u^2,    q = q_w^2/mu_w^2 = 1 + e_w/u^2
//     u - a = g/sqrt(p) + w/sqrt(q)
//
// Squaring twice removes the square roots. Let P = u^2 + e_g and Q = u^2 + e_w. Multiplied by
// powers of u, the equation becomes
//
//     [(u - a)^2 P Q - u^2 (g^2 Q + w^2 P)]^2 - 4 g^2 w^2 u^4 P Q = 0
//
// For every port this polynomial is monic and has degree 12. Its roots are of the order of 1 or
// less, so that its companion matrix needs no balancing. The wanted root lies in (a, 1]. Without
// glass, squaring once is sufficient: (u - a)^2 Q - w^2 u^2 = 0. Squaring twice would then make
// the wanted root a double root.
#pragma once

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "refractive/flat_port_camera.h"

namespace axial::refractive {

namespace polynomial {

// The coefficients of a polynomial, the constant term first.
template <class T, std::size_t N>
using Polynomial = std::array<T, N>;

// a * b.
template <class T, std::size_t N, std::size_t M>
Polynomial<T, N + M - 1> product(const Polynomial<T, N>& a, const Polynomial<T, M>& b) {
  Polynomial<T, N + M - 1> c{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < M; ++j) c[i + j] += a[i] * b[j];
  return c;
}

// a + scale * u^shift * b. The degree of the second term must not exceed the degree of a.
template <std::size_t shift, class T, std::size_t N, std::size_t M>
Polynomial<T, N> plus(Polynomial<T, N> a, const T& scale, const Polynomial<T, M>& b) {
  static_assert(M + shift <= N);
  for (std::size_t j = 0; j < M; ++j) a[j + shift] += scale * b[j];
  return a;
}

// The complex roots of a monic polynomial, computed as the eigenvalues of its companion matrix.
// `monic`: the coefficients, the constant term first. Precondition: degree from 1 to 12. All
// degrees share one matrix type, because matrices of fixed size are no faster and double the
// compile time.
template <class T>
auto roots(std::span<const T> monic) {
  constexpr int kMostRoots = 12;
  using Companion =
      Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostRoots, kMostRoots>;
  const Eigen::Index degree = static_cast<Eigen::Index>(monic.size()) - 1;
  Companion companion = Companion::Zero(degree, degree);
  for (Eigen::Index k = 0; k < degree; ++k) {
    if (k > 0) companion(k, k - 1) = T(1);
    companion(k, degree - 1) = -monic[static_cast<std::size_t>(k)];
  }
  return Eigen::EigenSolver<Companion>(companion, false).eigenvalues().eval();
}

}  // namespace polynomial

// The in-air tangent t of the ray that reaches the distance `rho` [m] from the axis at the height
// `z_water` [m] above the outer plane (axis frame). t is computed directly from an eigenvalue of
// the companion matrix. Empty if no such t exists: total reflection, z_water <= 0, rho < 0, or an
// argument that is not finite. `T` is float or double.
template <class T>  // NOLINTNEXTLINE(readability-function-size): one derivation, half of it names
std::optional<T> tangent_by_polynomial(const FlatPortOptics<T>& optics, const T& rho,
                                       const T& z_water) {
  using namespace polynomial;
  if (!(z_water > T(0)) || !(rho >= T(0)) || !std::isfinite(rho) || !std::isfinite(z_water))
    return std::nullopt;
  if (rho == T(0)) return T(0);
  const T secant = optics.paraxial_secant(z_water);
  const T t0 = rho / secant;
  const T a = optics.distance / secant;
  const T g = optics.thickness * optics.glass.inv_mu / secant;
  const T w = z_water * optics.water.inv_mu / secant;
  const T e_g = optics.glass.c / optics.glass.b * t0 * t0;
  const T e_w = optics.water.c / optics.water.b * t0 * t0;

  // Chooses the real root with the smallest residual in the equation before squaring. A nearly
  // double root may have a small imaginary part.
  std::optional<T> best;
  T least(0);
  const auto consider = [&](const auto& candidates) {
    for (const auto& root : candidates) {
      const T u = root.real();
      if (std::abs(root.imag()) > T(1e-3) * std::abs(u) || !(u > T(0)) || u < a * T(0.999))
        continue;
      const T p = T(1) + e_g / (u * u);
      const T q = T(1) + e_w / (u * u);
      const T residual = std::abs(u - a - g / std::sqrt(p) - w / std::sqrt(q)) / u;
      if (!best || residual < least) {
        best = t0 / u;
        least = residual;
      }
    }
  };

  const Polynomial<T, 3> P{e_g, T(0), T(1)};
  const Polynomial<T, 3> Q{e_w, T(0), T(1)};
  const Polynomial<T, 3> A2{a * a, T(-2) * a, T(1)};
  if (g == T(0)) {
    const auto monic = plus<2>(product(A2, Q), T(-w * w), Polynomial<T, 1>{T(1)});
    consider(roots<T>(monic));
  } else {
    const Polynomial<T, 5> PQ = product(P, Q);
    const Polynomial<T, 7> inner = plus<2>(plus<2>(product(A2, PQ), T(-g * g), Q), T(-w * w), P);
    const auto monic = plus<4>(product(inner, inner), T(T(-4) * g * g * w * w), PQ);
    consider(roots<T>(monic));
  }
  // Squaring adds roots that solve the equation with the opposite sign of a term. Such a root is no
  // solution.
  if (best && least > T(1e-3)) return std::nullopt;
  return best;
}

// Forward projection of X [camera frame] by the polynomial. X is visible if it lies beyond the
// port, if a ray reaches it (no total reflection), and if the ray comes from in front of the lens.
// The image rectangle is not tested. The pixel of a point that is not visible is (0, 0).
template <class T>
Projection<T> project_by_polynomial(const FlatPortCamera<T>& camera, const Vector3<T>& X) {
  const Vector3<T>& n = camera.port().normal;
  const T height = n.dot(X);
  const Vector3<T> across = X - height * n;
  const T rho = across.norm();
  const std::optional<T> t =
      tangent_by_polynomial(camera.optics(), rho, T(height - camera.optics().outer()));
  const Projection<T> none{Vector2<T>(T(0), T(0)), false};
  if (!t) return none;
  const Vector3<T> bearing = rho > T(0) ? Vector3<T>(n + across * (*t / rho)) : n;
  if (!(bearing.z() > T(0))) return none;
  return {camera.lens().pixel(bearing), true};
}

}  // namespace axial::refractive
