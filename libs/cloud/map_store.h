// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of fuse(): which maps are in memory. What is needed when is known beforehand, so the map
// that leaves is the one that is needed again last.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cloud/fusion_map.h"

namespace axial::cloud {

class MapStore {
 public:
  struct Limits {
    std::size_t maps;   // in memory at a time, but never fewer than a step needs
    std::size_t loads;  // at the same time
  };
  using Load = std::function<FusionMap(std::size_t slot)>;

  // Step i needs the maps of needed[i], each of which is below `slots` and occurs once.
  MapStore(std::vector<std::vector<std::size_t>> needed, std::size_t slots, Limits limits,
           Load load);

  // Sees to it that the maps of this step are there. Steps come in order, each with an end_step.
  void begin_step(std::size_t step);

  // Drops what no later step needs.
  void end_step(std::size_t step);

  // Precondition: needed by the present step.
  const FusionMap& map(std::size_t slot) const { return *maps_[slot]; }

  // Whether a step that has not ended needs the map.
  bool needed_later(std::size_t slot) const { return !uses_[slot].empty(); }

 private:
  void make_room(std::size_t step, std::size_t wanted);
  void drop(std::size_t slot);

  std::vector<std::vector<std::size_t>> needed_;
  std::vector<std::vector<std::size_t>> uses_;  // of each slot: the steps to come, the last first
  Limits limits_;
  Load load_;
  std::vector<std::optional<FusionMap>> maps_;
  std::vector<std::size_t> loaded_;  // slots
};

}  // namespace axial::cloud
