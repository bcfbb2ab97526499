// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/hash.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace axial {
namespace {

// The expected digests are those of xxhsum -H2 for the same bytes.
TEST(Fingerprint, IsTheXxh3OfItsParts) {
  EXPECT_EQ(Fingerprint().hex(), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(Fingerprint().add("abc").add(std::uint64_t{7}).add(0.5).hex(),
            "d235b222b749848ac3edf0ab8a40a790");
}

TEST(Fingerprint, TellsPartsApart) {
  const auto two = [](std::string_view a, std::string_view b) {
    return Fingerprint().add(a).add(b).hex();
  };
  EXPECT_NE(two("ab", "c"), two("a", "bc"));
  EXPECT_NE(two("", "a"), two("a", ""));
  EXPECT_NE(Fingerprint().add(1.0).hex(), Fingerprint().add(std::nextafter(1.0, 2.0)).hex());
  EXPECT_NE(Fingerprint().add(std::uint64_t{1}).hex(), Fingerprint().add(1.0).hex());
}

TEST(Fingerprint, CanBeReadWhileItGrows) {
  Fingerprint a, b;
  a.add("x");
  const std::string early = a.hex();
  EXPECT_EQ(a.hex(), early);
  EXPECT_EQ(a.add("y").hex(), b.add("x").add("y").hex());
  EXPECT_NE(a.hex(), early);
}

TEST(Scramble, IsSplitmix64) {
  // The first outputs of the published generator with the seed 0. Its state grows by 2^64 divided
  // by the golden ratio.
  EXPECT_EQ(scramble(0), 0xE220A8397B1DCDAFu);
  EXPECT_EQ(scramble(0x9e3779b97f4a7c15u), 0x6E789E6AA1B965F4u);
}

TEST(UnitFloat, IsUniformInTheHalfOpenInterval) {
  EXPECT_EQ(unit_float(0), 0.0f);
  EXPECT_LT(unit_float(~std::uint64_t{0}), 1.0f);
  constexpr int kCount = 100000;
  double sum = 0, squares = 0;
  std::set<float> values;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const auto value = static_cast<double>(unit_float(scramble(i)));
    sum += value;
    squares += value * value;
    values.insert(static_cast<float>(value));
  }
  // Six standard deviations of the mean of uniform numbers, and of the mean of their squares.
  EXPECT_NEAR(sum / kCount, 1.0 / 2, 6 * std::sqrt(1.0 / 12 / kCount));
  EXPECT_NEAR(squares / kCount, 1.0 / 3, 6 * std::sqrt(4.0 / 45 / kCount));
  EXPECT_GT(values.size(), kCount * 0.99);  // of 2^24 possible values, 0.3 % coincide by chance
}

}  // namespace
}  // namespace axial
