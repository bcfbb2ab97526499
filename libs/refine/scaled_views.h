// SPDX-License-Identifier: GPL-3.0-or-later
// The views at one resolution of the refinement, and the images of a mesh's vertices in these
// views.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "axial/refine.h"
#include "base/shared_cache.h"
#include "refine/raster.h"
#include "refine/visibility.h"

namespace axial::refine {

// The views, resized to one resolution.
class ScaledViews {
 public:
  // `factor`: the image size relative to that of `views`, above 0 and at most 1. `pictures` must
  // outlive the object.
  ScaledViews(std::span<const PosedCamera> views, const Pictures& pictures, double factor);

  // All functions below take indices into the `views` of the constructor.
  std::size_t count() const { return views_.size(); }
  bool used(std::size_t view) const { return views_[view].camera.width > 0; }
  const PosedCamera& view(std::size_t i) const { return views_[i]; }  // with the resized camera
  cv::Size size(std::size_t view) const;                              // of the resized image [px]

  struct Pixels {
    cv::Mat1f grey;  // 0 to 255
    cv::Mat1b mask;  // empty, or 0 where pixels are not used
  };
  // The pixels of a view, resized to size(view). A resized pixel is used only if all pixels that it
  // covers are used.
  Pixels pixels(std::size_t view) const;

 private:
  std::vector<PosedCamera> views_;
  const Pictures& pictures_;
};

// The images of a mesh's vertices in each view. They are computed on request, and kept for the
// `capacity` most recently requested views.
class MeshImages {
 public:
  // `mesh` and `views` must outlive the object. `capacity`: at least 1. If vertices move, images
  // that are kept do not change.
  MeshImages(const Mesh& mesh, const ScaledViews& views, std::size_t capacity)
      : cache_([&](std::size_t view) { return vertex_images(mesh.vertices, views.view(view)); },
               capacity) {}

  // The images in the view with the index `view`, one per vertex.
  std::shared_ptr<const std::vector<VertexImage>> get(std::size_t view) { return cache_.get(view); }

 private:
  SharedCache<std::vector<VertexImage>> cache_;
};

// Finds the vertices that each view sees (mark_seen() of visibility.h). Unused views see none.
// `shape`: of `mesh`. `images`: the images of the vertices of `mesh` in `views`.
Visibility find_visibility(const Mesh& mesh, const Shape& shape, const ScaledViews& views,
                           MeshImages& images);

// Returns for each face of `mesh` whether the area of its image is larger than `limit` [px^2] in at
// least two views that see all three corners of the face. `visibility` and `images`: of the
// vertices of `mesh` in `views`.
std::vector<bool> larger_than(double limit, const Mesh& mesh, const ScaledViews& views,
                              const Visibility& visibility, MeshImages& images);

}  // namespace axial::refine
