// SPDX-License-Identifier: GPL-3.0-or-later
// Which file holds the labels of which image of a scene.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace axial::io {

struct MaskRequest {
  std::filesystem::path image;  // absolute, as all paths here
  std::filesystem::path named;  // the mask that the scene names for it; empty: none
};

struct FoundMask {
  std::filesystem::path path;                 // empty: there is none
  std::vector<std::filesystem::path> others;  // that exist as well, in the order of the search
  std::string looked_for;                     // names and folders, for a message
};

// The masks of all images of a scene. That of `cam0/a.jpg` has one of the names a.mask.png
// (OpenMVS), a.jpg.png (COLMAP) and a_mask.png, in this order, in the same folder as its image,
// after the mask that the scene names.
//
// Where `folder` is not empty, masks lie there and nowhere else, and a.png is a name, too, the last
// one. They go by the ends of the images' paths, the longest first: `folder`/cam0/a.mask.png, then
// `folder`/a.mask.png. An end that several images share stands for none of them.
//
// Images of the scene are not taken for masks. Error if `folder` is none, or if two images would
// share a mask that no scene names.
std::vector<FoundMask> find_masks(std::span<const MaskRequest> images,
                                  const std::filesystem::path& folder = {});

// "<image without extension>.mask.png": the name under which programs write an image's mask.
std::filesystem::path mask_beside(const std::filesystem::path& image);

// The first of `masks` whose file and one of whose `others` hold different labels, and how many
// there are; `count` 0: none. Files that cannot be read differ.
struct RivalMasks {
  std::size_t count = 0;
  std::filesystem::path used, other;
};
RivalMasks rival_masks(std::span<const FoundMask> masks);

}  // namespace axial::io
