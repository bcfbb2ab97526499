// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/images/bit_depth.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "base/error.h"
#include "base/first_error.h"
#include "base/memory.h"
#include "base/parallel.h"

namespace axial::io {

namespace fs = std::filesystem;

namespace {

std::size_t decodes_that_fit(std::span<const ImageHeader> headers) {
  std::uint64_t largest = 1;
  for (const ImageHeader& header : headers) largest = std::max(largest, bytes_needed(header));
  return std::clamp<std::uint64_t>(available_memory() / 4 / largest, 1, thread_count());
}

int largest_bits(std::span<const fs::path> photographs, std::size_t at_once) {
  std::atomic<int> bits = 8;
  FirstError error;
  for_each_in_flight(photographs.size(), at_once, [&](std::size_t i) {
    error.run(i, [&] {
      const int used = bits_used(read_photograph(photographs[i]).pixels);
      for (int now = bits; now < used && !bits.compare_exchange_weak(now, used);) {
      }
    });
  });
  error.rethrow();
  return bits;
}

}  // namespace

void declare_bit_depth(OptionList& list, int& bit_depth) {
  list.add_with_default("bit-depth", &bit_depth,
                        "number of bits that the values of 16-bit images use, 8 to 16 (0: as many "
                        "as the largest value in all images needs)")
      .zero_or(8, 16);
}

int common_bit_depth(std::span<const fs::path> photographs, std::span<const ImageHeader> headers,
                     int asked, const Context& context) {
  std::vector<fs::path> wide;
  for (std::size_t i = 0; i < photographs.size(); ++i)
    if (headers[i].bits > 8) wide.push_back(photographs[i]);
  if (wide.empty()) {
    if (asked != 0)
      context.warning("{} {}: is not used: no image has 16 bits", setting("bit_depth"), asked);
    return 16;
  }
  if (asked != 0) return asked;
  const int bits = largest_bits(wide, decodes_that_fit(headers));
  context.info("The values of {} images of 16 bits use {} bits (see {})", wide.size(), bits,
               setting("bit_depth"));
  return bits;
}

}  // namespace axial::io
