// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of the records of python/axialmvs/records.py as dictionaries.
#pragma once

#include "axial/scene.h"
#include "axial/scene_images.h"
#include "src/arrays.h"
#include "src/camera.h"

namespace axial::python {

py::dict fields_of(DepthMap map);
py::dict fields_of(PointCloud cloud, const LocalFrame& frame);
py::dict fields_of(Mesh mesh, const LocalFrame& frame);
py::dict fields_of(TexturedMesh mesh, const LocalFrame& frame);
py::dict fields_of(const Scene& scene, const LocalFrame& frame);

// Throw a TypeError or a ValueError that names the field, and Errors for cameras.
DepthMap to_depth_map(const py::dict& fields);
PointCloud to_cloud(const py::dict& fields);
Mesh to_mesh(const py::dict& fields);
// Without `uv`: a mesh without textures.
TexturedMesh to_textured_mesh(const py::dict& fields);
Scene to_scene(const py::dict& fields);
LocalFrame frame_of(const py::dict& fields);  // of the field `origin`

// Changes the frame of `positions`.
void move_positions(const LocalFrame& from, const LocalFrame& to,
                    std::vector<Eigen::Vector3f>& positions);

}  // namespace axial::python
