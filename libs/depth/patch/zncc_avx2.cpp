// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled for AVX2. No function defined here may be shared with other translation units.
#include <immintrin.h>

#include "depth/patch/zncc.h"
#include "depth/patch/zncc_reduce.h"

namespace axial::depth::detail {
namespace {

inline __m256 byte_of(__m256i words, int shift) {
  return _mm256_cvtepi32_ps(
      _mm256_and_si256(_mm256_srli_epi32(words, shift), _mm256_set1_epi32(0xFF)));
}

inline __m256 lerp(__m256 a, __m256 b, __m256 t) {
  return _mm256_add_ps(a, _mm256_mul_ps(t, _mm256_sub_ps(b, a)));
}

inline __m256 inside(__m256 v, __m256 high) {
  return _mm256_and_ps(_mm256_cmp_ps(v, _mm256_set1_ps(1.0f), _CMP_GE_OQ),
                       _mm256_cmp_ps(v, high, _CMP_LE_OQ));
}

}  // namespace

float zncc_avx2(const ReferencePatch& patch, const QuadImage& source, const TexelPositions& at) {
  const __m256 max_x = _mm256_set1_ps(static_cast<float>(source.width() - 2));
  const __m256 max_y = _mm256_set1_ps(static_cast<float>(source.height() - 2));
  __m256 ok = _mm256_castsi256_ps(_mm256_set1_epi32(-1));
  for (std::size_t k = 0; k < kPaddedTexels; k += 8) {
    ok = _mm256_and_ps(ok, inside(_mm256_load_ps(at.x.data() + k), max_x));
    ok = _mm256_and_ps(ok, inside(_mm256_load_ps(at.y.data() + k), max_y));
  }
  if (_mm256_movemask_ps(ok) != 0xFF) return zncc_of_part(patch, source, at);

  const __m256i stride = _mm256_set1_epi32(source.width());
  const auto* words = reinterpret_cast<const int*>(source.words());
  const __m256 offset = _mm256_set1_ps(patch.mean);
  __m256 mean = _mm256_setzero_ps();
  __m256 square = _mm256_setzero_ps();
  __m256 cross = _mm256_setzero_ps();
  for (std::size_t k = 0; k < kPaddedTexels; k += 8) {
    const __m256 x = _mm256_load_ps(at.x.data() + k);
    const __m256 y = _mm256_load_ps(at.y.data() + k);
    const __m256i column = _mm256_cvttps_epi32(x);
    const __m256i row = _mm256_cvttps_epi32(y);
    const __m256 fx = _mm256_sub_ps(x, _mm256_cvtepi32_ps(column));
    const __m256 fy = _mm256_sub_ps(y, _mm256_cvtepi32_ps(row));
    const __m256i index = _mm256_add_epi32(_mm256_mullo_epi32(row, stride), column);
    const __m256i word = _mm256_i32gather_epi32(words, index, 4);
    const __m256 top = lerp(byte_of(word, 0), byte_of(word, 8), fx);
    const __m256 bottom = lerp(byte_of(word, 16), byte_of(word, 24), fx);
    const __m256 value = _mm256_sub_ps(lerp(top, bottom, fy), offset);
    const __m256 weighted = _mm256_mul_ps(_mm256_load_ps(patch.weight.data() + k), value);
    mean = _mm256_add_ps(mean, weighted);
    square = _mm256_add_ps(square, _mm256_mul_ps(weighted, value));
    cross = _mm256_add_ps(cross, _mm256_mul_ps(_mm256_load_ps(patch.deviation.data() + k), value));
  }
  ZnccSums sums;
  _mm256_store_ps(sums.mean.data(), mean);
  _mm256_store_ps(sums.square.data(), square);
  _mm256_store_ps(sums.cross.data(), cross);
  return correlation(sums, patch.variance);
}

}  // namespace axial::depth::detail
