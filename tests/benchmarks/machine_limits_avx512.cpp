// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for AVX-512 alone: nothing here may be shared with other translation units.
#include "benchmarks/machine_limits_kernel.h"

namespace axial::benchmarks::detail {

MachineLimits avx512_limits() {
  return LimitKernel<stdx::simd_abi::native<float>>::measure();
}

}  // namespace axial::benchmarks::detail
