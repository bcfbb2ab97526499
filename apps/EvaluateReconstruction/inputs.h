// SPDX-License-Identifier: GPL-3.0-or-later
// The files that the options name: the reconstruction, and the cameras.
#pragma once

#include <optional>
#include <vector>

#include "axial/scene_images.h"
#include "base/context.h"
#include "base/naming.h"
#include "evaluate/alignment.h"
#include "evaluate/point_uncertainty.h"
#include "evaluate/views.h"
#include "io/colmap/colmap.h"
#include "options.h"
#include "scene/local_frame.h"
#include "scene/point_cloud.h"

namespace axial::apps {

// The reconstruction: a mesh if the file has faces, else a cloud.
struct Input {
  PointCloud cloud;
  evaluate::PointUncertainty uncertainty;  // of the cloud's points
  std::optional<Mesh> mesh;
  std::optional<TexturedMesh> texture;  // of `mesh`; its own mesh is empty

  std::span<const Eigen::Vector3f> positions() const {
    return mesh ? mesh->vertices : cloud.positions;
  }
  void move(const evaluate::Similarity& by) {
    if (mesh)
      evaluate::apply(by, *mesh);
    else
      evaluate::apply(by, cloud);
  }
};

// The local frames that float coordinates refer to: of the truth and its cameras, and of the input
// before alignment.
struct Frames {
  LocalFrame truth, input;
};

// The given models, and their frames. The reference model has the truth's frame.
struct Models {
  io::ColmapModel reference, estimated;
  Frames frames;
};

// Warns of float coordinates far from their origin: they had lost digits when the file was written.
Models read_models(const Options& options, const Context& context);

// Reads the reconstruction with positions in `frame`. Textures are read only if views are to be
// rendered.
Input read_input(const Options& options, const LocalFrame& frame, const Context& context);

// The cameras of `models.reference` behind the ports of the housing file; empty without --cameras.
std::vector<evaluate::View> read_views(const Options& options, const Models& models,
                                       const Context& context);

}  // namespace axial::apps
