// SPDX-License-Identifier: GPL-3.0-or-later
// Writes masks in the form of COLMAP.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "axial/base.h"
#include "base/progress.h"

namespace axial::io {

// What write_colmap_masks() reads and writes. All paths are absolute.
struct ColmapMasks {
  std::filesystem::path images;  // folder of the photographs
  std::filesystem::path masks;   // folder of the masks (find_masks in images/masks.h), or the file
                                 // of one mask for all photographs
  int label = 0;                 // of the pixels to leave out
  std::filesystem::path output;  // folder for COLMAP's masks
  // Messages call the fields masks, label and output the settings "mask_folder",
  // "ignore_mask_label" and "output".
};

// Writes a mask for every photograph of `images` and of its subfolders; links to folders are not
// entered, as by COLMAP, and files that are no images are skipped. The mask of `images`/dive/a.jpg
// is `output`/dive/a.jpg.png: grey, 8 bits, in the size of the photograph, 0 (no features) at
// pixels whose nearest label is `label`, else 255. This is COLMAP's form (ImageReader.mask_path),
// and find_masks() with the folder `output` and the label 0 gives the same pixels. Returns the
// number of masks. Warns through `context` if no mask has the label, and tells it the share of the
// pixels that are left out.
//
// Error if `images` has no photograph, a photograph has no mask, a mask cannot be read or has
// another aspect ratio than its photograph, a mask that is read would be replaced, or `output` is
// `images` or a folder in it: COLMAP and this function would take the masks for photographs.
std::size_t write_colmap_masks(const ColmapMasks& masks, const ProgressSink& progress = {},
                               const Context& context = {});

}  // namespace axial::io
