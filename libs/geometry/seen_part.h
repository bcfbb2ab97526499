// SPDX-License-Identifier: GPL-3.0-or-later
// What the cameras of a survey see of its mesh: from which side, and which faces lie far away from
// everything that they see. A sample of the faces suffices, so this is fast for large meshes, too.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "base/context.h"
#include "geometry/face_sights.h"
#include "scene/mesh.h"

namespace axial::geometry {

struct SeenPartOptions {
  std::size_t faces = 4000;   // largest number of faces in the sample
  std::size_t cameras = 200;  // largest number of cameras that look at the sample
  bool strays = true;         // find SeenPart::strays
};

struct SeenPart {
  // The numbers of faces in the sample that more cameras see from the front than from the back, and
  // of the other faces that cameras see.
  std::size_t front = 0, back = 0;
  // The mean, weighted by area, of the unit normals of these faces on the side that more cameras
  // see: the direction towards the cameras. Zero if no face of the sample is seen.
  Eigen::Vector3d facing = Eigen::Vector3d::Zero();
  // The faces that no camera sees and whose corners all lie far outside what the sample shows: by
  // more than half of the longest side of the bounding box of the seen faces. In ascending order.
  std::vector<std::uint32_t> strays = {};

  // True if the cameras see most faces from the back: of the seen faces, more than two thirds.
  bool is_inside_out() const { return back > 2 * front; }
};

// Looks at the mesh. The faces of the sample have equal distances in the list of faces, and the
// cameras that look at them have equal distances in `cameras`. All cameras look at faces that may
// be strays. The result does not depend on the number of threads. Error for a mesh that Surface
// refuses (geometry/surface.h).
SeenPart find_seen_part(const Mesh& mesh, std::span<const PosedCamera> cameras,
                        const SeenPartOptions& options = {});

// Logs a warning if the mesh of the file `mesh` is inside out. It tells how to mend the mesh.
void warn_if_inside_out(const SeenPart& part, const std::filesystem::path& mesh,
                        const Context& context);

// Logs a warning if the mesh of the file `mesh`, which has `faces` faces, has strays: that they are
// left out.
void warn_of_strays(const SeenPart& part, const std::filesystem::path& mesh, std::size_t faces,
                    const Context& context);

// Removes the elements with the given indices, which are in ascending order.
template <class T>
void erase_at(std::span<const std::uint32_t> indices, std::vector<T>& values) {
  std::size_t next = 0, kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (next < indices.size() && indices[next] == i)
      ++next;
    else
      values[kept++] = values[i];
  }
  values.resize(kept);
}

}  // namespace axial::geometry
