// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): keeps maps in memory. The order in which maps are needed is known in advance. So
// the store can evict the map whose next use is farthest in the future.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cloud/fusion_map.h"

namespace axial::cloud {

class MapStore {
 public:
  struct Limits {
    std::size_t maps;   // maps in memory at the same time, but never fewer than a step needs
    std::size_t loads;  // calls of `load` at the same time
  };
  using Load = std::function<FusionMap(std::size_t slot)>;

  // Step i needs the maps of the slots needed[i]. Precondition: the slots of a step are below
  // `slots` and differ from each other. `load` makes the map of a slot.
  MapStore(std::vector<std::vector<std::size_t>> needed, std::size_t slots, Limits limits,
           Load load);

  // Loads the missing maps of this step. If there are too many maps, first evicts maps that this
  // step does not need. Call begin_step() and end_step() in turn, for the steps in ascending order.
  void begin_step(std::size_t step);

  // Removes the maps that no later step needs.
  void end_step(std::size_t step);

  // Precondition: the current step needs the map.
  const FusionMap& map(std::size_t slot) const { return *maps_[slot]; }

  // Whether a step that has not ended needs the map.
  bool needed_later(std::size_t slot) const { return !uses_[slot].empty(); }

 private:
  void make_room(std::size_t step, std::size_t wanted);
  void drop(std::size_t slot);

  std::vector<std::vector<std::size_t>> needed_;
  std::vector<std::vector<std::size_t>> uses_;  // per slot: steps that need it, the last one first
  Limits limits_;
  Load load_;
  std::vector<std::optional<FusionMap>> maps_;
  std::vector<std::size_t> loaded_;  // slots whose maps are in memory
};

}  // namespace axial::cloud
