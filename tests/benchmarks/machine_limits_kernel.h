// SPDX-License-Identifier: GPL-3.0-or-later
// The loops behind machine_limits.h, for one instruction set. To be included by its translation
// unit alone; every name carries the set in a type.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <experimental/simd>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "benchmarks/machine_limits.h"

namespace axial::benchmarks {

namespace stdx = std::experimental;

template <class Abi>
class LimitKernel {
  using Floats = stdx::simd<float, Abi>;
  using Ints = stdx::rebind_simd_t<std::int32_t, Floats>;
  static constexpr std::size_t kWidth = Floats::size();
  static constexpr std::size_t kChains = 6;  // of either kind: hides latencies, fits registers
  static constexpr std::size_t kRounds = 20000;
  static constexpr std::size_t kWords = 4096;  // 16 KiB
  static constexpr std::size_t kIndices = 1024;
  static constexpr std::size_t kGatherRounds = 300;
  static constexpr std::size_t kSums = 4;

 public:
  static MachineLimits measure() {
    constexpr auto kGathered = static_cast<double>(kGatherRounds * kIndices);
    constexpr auto kOperations = static_cast<double>(kRounds * 2 * kChains * kWidth);
    return {kGathered / best_ns(gather_all), kOperations / best_ns(multiply_and_add)};
  }

 private:
  // The best of many short runs: the others were disturbed.
  static double best_ns(void (*run)()) {
    double best = 1e30;
    for (int i = 0; i < 25; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      run();
      const std::chrono::duration<double, std::nano> spent =
          std::chrono::steady_clock::now() - begin;
      best = std::min(best, spent.count());
    }
    return best;
  }

  // Keeps a vector where it is, and the compiler from knowing what is in it.
  template <class Vector>
  static void hide(Vector& vector) {
    asm volatile("" : "+m"(vector));
  }

  static Ints gather(const std::int32_t* base, const Ints& at) {
#ifdef __AVX512F__
    if constexpr (kWidth == 16)
      return Ints(_mm512_i32gather_epi32(static_cast<__m512i>(at), base, 4));
    else
#elif defined(__AVX2__)
    if constexpr (kWidth == 8)
      return Ints(_mm256_i32gather_epi32(base, static_cast<__m256i>(at), 4));
    else
#endif
      return Ints([&](auto k) { return base[at[k]]; });
  }

  struct alignas(64) Image {
    std::array<std::int32_t, kWords> words{};
    std::array<std::int32_t, kIndices> indices;

    Image() {
      for (std::size_t i = 0; i < kIndices; ++i)
        indices[i] = static_cast<std::int32_t>(i * 2654435761u % kWords);
    }
  };

  static void gather_all() {
    static const Image image;
    std::array<Ints, kSums> sums;
    sums.fill(Ints(0));
    for (std::size_t round = 0; round < kGatherRounds; ++round) {
      asm volatile("" ::: "memory");  // or one round would do for all
      for (std::size_t i = 0; i < kIndices; i += kSums * kWidth)
        for (std::size_t k = 0; k < kSums; ++k)
          sums[k] ^= gather(image.words.data(),
                            Ints(image.indices.data() + i + k * kWidth, stdx::vector_aligned));
    }
    hide(sums);
  }

  static void multiply_and_add() {
    std::array<Floats, kChains> product, sum;
    product.fill(Floats(1.5f));
    sum.fill(Floats(0.5f));
    Floats factor(0.9999999f), term(1e-7f);
    hide(factor);
    hide(term);
    for (std::size_t round = 0; round < kRounds; ++round) {
      for (std::size_t k = 0; k < kChains; ++k) product[k] *= factor;
      for (std::size_t k = 0; k < kChains; ++k) sum[k] += term;
    }
    hide(product);
    hide(sum);
  }
};

}  // namespace axial::benchmarks
