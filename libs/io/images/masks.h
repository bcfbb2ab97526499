// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the mask files, which hold the labels, of a scene's images.
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
  std::filesystem::path path;                 // empty: none was found
  std::vector<std::filesystem::path> others;  // other candidates that exist, in search order
  std::string looked_for;                     // names and folders that were searched, for a message
};

// Finds the masks of all images of a scene.
//
// Without `folder`, the candidates for cam0/a.jpg are, in this order, the mask that the scene
// names, and in the folder of the image a.mask.png (OpenMVS), a.jpg.png (COLMAP) and a_mask.png.
//
// With `folder`, masks are searched only there, and a.png is a fourth name. Subfolders that match
// the end of the image's path are searched first, the longest end first: `folder`/cam0/a.mask.png,
// then `folder`/a.mask.png. A name that several images of the scene share is not used.
//
// Images of the scene never count as masks. Error if `folder` is not a folder, or if two images
// would share a mask that the scene does not name.
std::vector<FoundMask> find_masks(std::span<const MaskRequest> images,
                                  const std::filesystem::path& folder = {});

// "<image without extension>.mask.png": the name under which programs write an image's mask.
std::filesystem::path mask_beside(const std::filesystem::path& image);

// Compares each mask, which is used, with the other candidates (`others`), which are ignored.
// `used` and `other` are the first pair of files with different labels; `count` is the number of
// images that have such a pair. A file that cannot be read counts as different.
struct IgnoredMasks {
  std::size_t count = 0;
  std::filesystem::path used, other;
};
IgnoredMasks ignored_masks(std::span<const FoundMask> masks);

}  // namespace axial::io
