// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/map_store.h"

#include <algorithm>

#include "base/parallel.h"

namespace axial::cloud {

MapStore::MapStore(std::vector<std::vector<std::size_t>> needed, std::size_t slots, Limits limits,
                   Load load)
    : needed_(std::move(needed)),
      uses_(slots),
      limits_(limits),
      load_(std::move(load)),
      maps_(slots) {
  for (std::size_t step = needed_.size(); step-- > 0;)
    for (const std::size_t slot : needed_[step]) uses_[slot].push_back(step);
}

void MapStore::begin_step(std::size_t step) {
  std::vector<std::size_t> wanted;
  for (const std::size_t slot : needed_[step])
    if (!maps_[slot]) wanted.push_back(slot);
  make_room(step, wanted.size());
  for_each_in_flight(wanted.size(), limits_.loads,
                     [&](std::size_t i) { maps_[wanted[i]] = load_(wanted[i]); });
  loaded_.insert(loaded_.end(), wanted.begin(), wanted.end());
}

void MapStore::end_step(std::size_t step) {
  for (const std::size_t slot : needed_[step]) {
    uses_[slot].pop_back();
    if (uses_[slot].empty()) drop(slot);
  }
}

void MapStore::make_room(std::size_t step, std::size_t wanted) {
  while (loaded_.size() + wanted > limits_.maps && !loaded_.empty()) {
    const auto last = std::max_element(
        loaded_.begin(), loaded_.end(),
        [&](std::size_t a, std::size_t b) { return uses_[a].back() < uses_[b].back(); });
    if (uses_[*last].back() == step) return;
    drop(*last);
  }
}

void MapStore::drop(std::size_t slot) {
  maps_[slot].reset();
  std::erase(loaded_, slot);
}

}  // namespace axial::cloud
