// SPDX-License-Identifier: GPL-3.0-or-later
// Shrinks the images of a scene.
#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <vector>

#include "scene/scene.h"

namespace axial::apps {

// An image to shrink.
struct SmallImage {
  std::filesystem::path source;
  std::filesystem::path name;  // of the smaller image, below the folder of all smaller images
  cv::Size size;               // of the smaller image
};

// Finds the images whose longer side exceeds `max_resolution` [px]: these will be reduced to this
// length in `folder`. Sets their paths and cameras in `scene` to those of the smaller images. Reads
// the headers of the image files, and writes no file. The path of a smaller image in `folder` is
// the image's path below the deepest common folder of all images. JPEG files with 8 bits stay JPEG,
// other files become PNG. All other images and all masks stay where they are. Error for an image
// whose header cannot be read or that has transparent pixels, if two smaller images
// would have one name, and if a smaller image would replace an image of the scene.
std::vector<SmallImage> find_large_images(unsigned max_resolution,
                                          const std::filesystem::path& folder, Scene& scene);

// Writes the smaller images to `folder`, and keeps its other files. No file of `folder` changes
// before all images are shrunk. Error for an image that cannot be read, and for a file that cannot
// be written.
void write_small_images(const std::vector<SmallImage>& images, const std::filesystem::path& folder);

}  // namespace axial::apps
