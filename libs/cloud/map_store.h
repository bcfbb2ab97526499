// SPDX-License-Identifier: GPL-3.0-or-later
// Part of fuse(): keeps maps in memory. If there are too many, the store evicts the map whose next
// use is farthest in the future. This is possible because the order of all uses is known in
// advance. A map is named by its slot, a number from 0.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cloud/fusion_map.h"

namespace axial::cloud {

// Holds the maps of fuse(). Not thread-safe.
class MapStore {
 public:
  struct Limits {
    std::size_t maps;   // maps in memory at the same time; more if a single step needs more
    std::size_t loads;  // calls of `load` at the same time; 0 counts as 1
  };
  using Load = std::function<FusionMap(std::size_t slot)>;

  // Step i needs the maps of the slots needed[i]. `slots`: the number of slots. `load` makes the
  // map of a slot; its exceptions reach the caller of begin_step(). Precondition: the slots of a
  // step are below `slots` and differ from each other.
  MapStore(std::vector<std::vector<std::size_t>> needed, std::size_t slots, Limits limits,
           Load load);

  // Loads the missing maps of the step. If Limits::maps would be exceeded, first evicts maps that
  // the step does not need. Call begin_step() and end_step() in turn, for the steps in ascending
  // order.
  void begin_step(std::size_t step);

  // Ends the step. Removes the maps that no later step needs.
  void end_step(std::size_t step);

  // The map of a slot. Precondition: the current step, between begin_step() and end_step(), needs
  // it. The reference is valid until end_step().
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
