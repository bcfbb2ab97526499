// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/frames/lost_offset.h"

#include "io/ply/ply.h"
#include "io/textured/textured_mesh.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// True if the origin of the stored coordinates is nearer than that of the frame. `stored`: without
// an offset.
bool is_near(const LocalFrame& frame, const Eigen::Vector3d& stored) {
  return stored.norm() < frame.to_local(stored).norm();
}

}  // namespace

bool is_without_offset(const LocalFrame& frame, const fs::path& path) {
  if (frame.is_world()) return false;
  const MeshPlace place = mesh_place(path);
  return place.frame.is_world() && is_near(frame, place.first_vertex);
}

LocalFrame frame_of_positions(const LocalFrame& frame, const fs::path& ply) {
  const PlyPlace place = ply_place(ply);
  return is_without_offset(frame, ply) ? frame : place.frame;
}

void tell_lost_offset(const fs::path& file, const LocalFrame& frame, const Context& context) {
  context.info(
      "{}: states no offset; its coordinates count from the scene's offset {:.0f} {:.0f} {:.0f}",
      file.string(), frame.origin.x(), frame.origin.y(), frame.origin.z());
}

}  // namespace axial::io
