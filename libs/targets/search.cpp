// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/search.h"

#include <algorithm>

#include "base/first_error.h"
#include "base/parallel.h"
#include "io/images/image.h"
#include "targets/finders/find_targets.h"

namespace axial::targets {
namespace {

Photograph search(const NamedPhotograph& photograph, std::span<const Family> families) {
  io::Photograph read = io::read_photograph(photograph.file);
  if (!read.opaque.empty()) read.pixels.setTo(0, read.opaque == 0);
  return {photograph.name, read.pixels.size(), find_targets(read.pixels, families)};
}

std::uint64_t bytes_of(const NamedPhotograph& photograph) {
  const io::ImageHeader header = io::read_image_header(photograph.file);
  return io::bytes_needed(header) + bytes_of_search(header.size);
}

}  // namespace

std::vector<Photograph> search_photographs(std::span<const NamedPhotograph> photographs,
                                           std::span<const Family> families,
                                           const Context& context) {
  std::uint64_t largest = 0;
  for (const NamedPhotograph& photograph : photographs)
    largest = std::max(largest, bytes_of(photograph));
  const std::size_t in_flight = context.memory().items(largest, thread_count(), "a photograph");
  std::vector<Photograph> found(photographs.size());
  ProgressCounter done(context.stage("Searched photographs"), photographs.size());
  FirstError error;
  for_each_in_flight(photographs.size(), in_flight, [&](std::size_t i) {
    error.run(i, [&] { found[i] = search(photographs[i], families); });
    done.add();
  });
  error.rethrow();
  return found;
}

}  // namespace axial::targets
