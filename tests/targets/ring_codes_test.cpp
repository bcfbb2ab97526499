// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/codes/ring_codes.h"

#include <gmock/gmock.h>

#include <bit>
#include <set>

namespace axial::targets {
namespace {

TEST(RingCodes, FourteenBitsGiveThePublishedNumberOfCodes) {
  EXPECT_EQ(ring_codes(14).size(), 516u);
}

class RingCodesOf : public testing::TestWithParam<int> {};

TEST_P(RingCodesOf, AreValidAndDiffer) {
  const int bits = GetParam();
  std::set<std::uint32_t> turned;
  for (const std::uint32_t code : ring_codes(bits)) {
    EXPECT_EQ(std::popcount(code) % 2, 0);
    bool opposite = false;
    for (int i = 0; i < bits / 2; ++i)
      opposite |= ((code >> i) & 1u) && ((code >> (i + bits / 2)) & 1u);
    EXPECT_TRUE(opposite) << code;
    EXPECT_TRUE(turned.insert(smallest_rotation(code, bits)).second) << code;
  }
}

TEST_P(RingCodesOf, AreReadFromEverySegment) {
  const int bits = GetParam();
  const auto codes = ring_codes(bits);
  for (std::size_t i = 0; i < codes.size(); i += 7)
    for (int turn = 0; turn < bits; ++turn) {
      const std::uint32_t all = (1u << bits) - 1;
      const std::uint32_t value = ((codes[i] << turn) | (codes[i] >> (bits - turn))) & all;
      EXPECT_EQ(ring_number(value, bits, codes), i + 1);
    }
}

INSTANTIATE_TEST_SUITE_P(Bits, RingCodesOf, testing::Values(12, 14, 16, 20));

TEST(RingCodes, InvalidRingsHaveNoNumber) {
  const auto codes = ring_codes(12);
  EXPECT_FALSE(ring_number(0, 12, codes));
  EXPECT_FALSE(ring_number(0b111, 12, codes));          // odd
  EXPECT_FALSE(ring_number(0b11, 12, codes));           // no opposite pair
  EXPECT_TRUE(ring_number(0b000001000001, 12, codes));  // two opposite segments
}

}  // namespace
}  // namespace axial::targets
