// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of items in one array, one list after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::geometry {

template <class Item = std::uint32_t, class Index = std::uint32_t>
struct Lists {
  std::vector<Index> begin;  // list k is at [begin[k], begin[k + 1]) of `items`
  std::vector<Item> items;

  // The items of one list.
  std::span<const Item> of(std::size_t list) const {
    return std::span(items).subspan(begin[list], begin[list + 1] - begin[list]);
  }
};

// Makes `count` lists. for_each(add) calls add(list, item) with all items. It is called twice, and
// must do the same both times. The items of a list keep their order.
template <class Item = std::uint32_t, class Index = std::uint32_t, class ForEach>
Lists<Item, Index> lists_of(std::size_t count, const ForEach& for_each) {
  Lists<Item, Index> result;
  result.begin.assign(count + 1, 0);
  for_each([&](std::size_t list, const Item&) { ++result.begin[list + 1]; });
  for (std::size_t k = 0; k < count; ++k) result.begin[k + 1] += result.begin[k];
  result.items.resize(result.begin.back());
  std::vector<Index> next(result.begin.begin(), result.begin.end() - 1);
  for_each([&](std::size_t list, const Item& item) { result.items[next[list]++] = item; });
  return result;
}

// The faces of each vertex, in ascending order. Precondition: the vertices of the faces exist.
inline Lists<> faces_of_vertices(const Mesh& mesh) {
  return lists_of(mesh.vertices.size(), [&](const auto& add) {
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
      for (const std::uint32_t v : mesh.faces[f]) add(v, f);
  });
}

}  // namespace axial::geometry
