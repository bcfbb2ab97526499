// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/machine_limits_kernel.h"

namespace axial::benchmarks::detail {

MachineLimits scalar_limits() {
  return LimitKernel<stdx::simd_abi::scalar>::measure();
}

MachineLimits baseline_limits() {
  return LimitKernel<stdx::simd_abi::native<float>>::measure();
}

}  // namespace axial::benchmarks::detail
