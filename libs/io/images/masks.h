// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the mask files of a scene's images. A mask file is an image that holds labels.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace axial::io {

// An image whose mask is wanted.
struct MaskRequest {
  std::filesystem::path image;  // absolute, as all paths in this file
  std::filesystem::path named;  // the mask that the scene names for the image; empty: none
};

// The mask of one image.
struct FoundMask {
  std::filesystem::path path;                 // empty: none was found
  std::vector<std::filesystem::path> others;  // other candidates that exist, in search order
  std::string looked_for;                     // the names and folders searched, for a message
};

// Finds the masks of all images of a scene. Entry i of the result belongs to images[i]. The mask of
// an image is the first of its candidates that exists. Files are not opened.
//
// Without `folder` (an empty path), the candidates for the image cam0/a.jpg are, in this order: the
// mask that the scene names, then a.mask.png (OpenMVS), a.jpg.png (COLMAP) and a_mask.png in the
// folder of the image.
//
// With `folder`, masks are searched only in `folder`, and the mask that the scene names does not
// count. The file names are the three above and a.png. Let an end be one or more of the last
// components of the path of the image's folder, for example cam0. The subfolders of `folder` whose
// path relative to `folder` is an end are searched first, the longest end first, and `folder`
// itself last. In the example all names are searched in `folder`/cam0, then in `folder`. If a file
// in one of these folders would be the mask of several images of the scene by its name, it is not
// used.
//
// Without `folder`, images of the scene do not count as masks unless the scene names them as masks.
// With `folder`, they never count. Error if `folder` is not a folder, or if two images would share
// a mask that the scene does not name.
std::vector<FoundMask> find_masks(std::span<const MaskRequest> images,
                                  const std::filesystem::path& folder = {});

// Returns the path under which programs write the mask of an image:
// "<image without extension>.mask.png".
std::filesystem::path mask_beside(const std::filesystem::path& image);

// Tells of masks that are used although other candidates (FoundMask::others) with different labels
// exist. `count` is the number of images with such a candidate. `used` and `other` are the mask and
// the candidate of the first such image; empty if `count` is 0.
struct IgnoredMasks {
  std::size_t count = 0;
  std::filesystem::path used, other;
};

// Compares the labels of each mask with those of its other candidates, pixel by pixel. Masks of
// different sizes are different. If a file cannot be read, its labels count as different.
IgnoredMasks ignored_masks(std::span<const FoundMask> masks);

}  // namespace axial::io
