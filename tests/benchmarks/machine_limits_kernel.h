// SPDX-License-Identifier: GPL-3.0-or-later
// The measuring loops of machine_limits.h, for the instruction set of the translation unit that
// includes this file. Only the translation units of the instruction sets may include it. Every name
// contains the instruction set in a type, so that the linker does not mix code of different
// instruction sets.
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
  // Independent chains of each operation: enough to hide latencies, few enough for the registers.
  static constexpr std::size_t kChains = 6;
  static constexpr std::size_t kRounds = 20000;
  static constexpr std::size_t kWords = 4096;  // 16 KiB
  static constexpr std::size_t kIndices = 1024;
  static constexpr std::size_t kReadRounds = 300;
  static constexpr std::size_t kSums = 4;

 public:
  static MachineLimits measure() {
    constexpr auto kWordsRead = static_cast<double>(kReadRounds * kIndices);
    constexpr auto kOperations = static_cast<double>(kRounds * 2 * kChains * kWidth);
    MachineLimits limits;
#ifdef __AVX2__
    limits.gathered_words_per_ns = kWordsRead / best_ns(read_all<gather>);
#endif
    limits.loaded_words_per_ns = kWordsRead / best_ns(read_all<load>);
    limits.float_operations_per_ns = kOperations / best_ns(multiply_and_add);
    return limits;
  }

 private:
  // Returns the shortest time [ns] of many short runs, because runs may be disturbed.
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

  // Forces a vector to memory, so that the compiler does not know its content.
  template <class Vector>
  static void hide(Vector& vector) {
    asm volatile("" : "+m"(vector));
  }

#ifdef __AVX2__
  static Ints gather(const std::int32_t* base, const Ints& at) {
#ifdef __AVX512F__
    if constexpr (kWidth == 16)
      return Ints(_mm512_i32gather_epi32(static_cast<__m512i>(at), base, 4));
    else
#endif
      return Ints(_mm256_i32gather_epi32(base, static_cast<__m256i>(at), 4));
  }

  // Loads the four words at the positions `at`. Two positions at a time are taken from the
  // register.
  static __m128i load_four(const std::int32_t* base, __m128i at) {
    const auto first = static_cast<std::uint64_t>(_mm_cvtsi128_si64(at));
    const auto second = static_cast<std::uint64_t>(_mm_extract_epi64(at, 1));
    __m128i words = _mm_cvtsi32_si128(base[static_cast<std::uint32_t>(first)]);
    words = _mm_insert_epi32(words, base[first >> 32], 1);
    words = _mm_insert_epi32(words, base[static_cast<std::uint32_t>(second)], 2);
    return _mm_insert_epi32(words, base[second >> 32], 3);
  }

  static __m256i load_eight(const std::int32_t* base, __m256i at) {
    return _mm256_set_m128i(load_four(base, _mm256_extracti128_si256(at, 1)),
                            load_four(base, _mm256_castsi256_si128(at)));
  }
#endif

  static Ints load(const std::int32_t* base, const Ints& at) {
#ifdef __AVX512F__
    if constexpr (kWidth == 16) {
      const auto all = static_cast<__m512i>(at);
      const __m256i low = load_eight(base, _mm512_castsi512_si256(all));
      const __m256i high = load_eight(base, _mm512_extracti64x4_epi64(all, 1));
      return Ints(_mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1));
    } else
#elif defined(__AVX2__)
    if constexpr (kWidth == 8)
      return Ints(load_eight(base, static_cast<__m256i>(at)));
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

  template <Ints (*kRead)(const std::int32_t*, const Ints&)>
  static void read_all() {
    static const Image image;
    std::array<Ints, kSums> sums;
    sums.fill(Ints(0));
    for (std::size_t round = 0; round < kReadRounds; ++round) {
      asm volatile("" ::: "memory");  // otherwise one round could be used for all
      for (std::size_t i = 0; i < kIndices; i += kSums * kWidth)
        for (std::size_t k = 0; k < kSums; ++k)
          sums[k] ^= kRead(image.words.data(),
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
