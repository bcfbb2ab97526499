// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/las/cloud_to_las.h"

#include <functional>
#include <limits>
#include <optional>

#include "base/error.h"
#include "io/frames/lost_offset.h"
#include "io/openmvs/point_source.h"
#include "io/ply/ply.h"
#include "las/private/las_writer.h"
#include "ply/private/ply_rows.h"
#include "ply/private/ply_stream.h"

namespace axial::io {
namespace {

namespace fs = std::filesystem;

// Reads a cloud from its begin to its end, several times.
class Passes {
 public:
  Passes(const fs::path& ply, std::size_t passes, const Context& context)
      : ply_(ply), passes_(passes), progress_(context.stage("Converted points")) {}

  // Calls `use` for each row of the file.
  void pass(const std::function<void(const VertexRows&)>& use) {
    constexpr std::size_t kEach = 1 << 16;
    PlyStream stream(ply_);
    const PlyElement& vertices = vertex_element(stream);
    if (vertices.count == 0) fail_in(ply_, "has no points");
    VertexRows rows(vertices, ply_.string(), {});
    if (rows_read_ == 0) progress_(0, vertices.count);
    for_each_vertex(stream, [&](PlyBody& body) {
      rows.read(body);
      use(rows);
      const std::size_t done = ++rows_read_ / passes_;
      if (rows_read_ % kEach == 0 || done == vertices.count) progress_(done, vertices.count);
      return true;
    });
  }

 private:
  fs::path ply_;
  std::size_t passes_, rows_read_ = 0;  // rows of all passes
  ProgressSink progress_;
};

struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
};

Box box_of(Passes& passes, const LocalFrame& stored) {
  Box box;
  passes.pass([&](const VertexRows& rows) {
    const Eigen::Vector3d x = stored.to_world(rows.stored_position());
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  });
  return box;
}

LasLayout layout_of(const fs::path& ply) {
  const PlyStream stream(ply);
  const VertexRows rows(vertex_element(stream), ply.string(), {});
  return {rows.has_colors(), rows.has_normals(), rows.has_views(), rows.has_errors()};
}

LasPoint point_of(const VertexRows& rows, const LasLayout& layout, const LocalFrame& stored,
                  const fs::path& ply) {
  LasPoint point{stored.to_world(rows.stored_position())};
  if (layout.colors) point.color = rows.color();
  if (layout.normals) point.normal = rows.stored_normal().cast<float>();
  if (layout.errors) {
    point.error = static_cast<float>(rows.error());
    point.confidence = static_cast<float>(rows.confidence());
  }
  if (!layout.views) return point;
  if (rows.view_count() > std::numeric_limits<std::uint16_t>::max())
    fail_in(ply, "a point has {} views, but LAS counts at most 65535", rows.view_count());
  point.views = static_cast<std::uint16_t>(rows.view_count());
  return point;
}

LasGrid grid_of(const Box& box, const fs::path& ply) {
  const std::optional<LasGrid> grid = las_grid(box.low, box.high);
  if (!grid)
    fail_in(ply, "its points are {:.4g} apart, and LAS has room for 4.2e+06 in steps of 0.001",
            (box.high - box.low).maxCoeff());
  return *grid;
}

}  // namespace

LasReport write_cloud_as_las(const fs::path& ply, const fs::path& las, const LocalFrame& frame,
                             const std::string& crs, const Context& context) {
  if (ply_has_faces(ply)) fail_in(ply, "is a mesh, and LAS holds clouds");
  if (crs.size() > LasHeader::kMostCrs)
    fail("the coordinate reference system has {} bytes, and LAS holds {}", crs.size(),
         LasHeader::kMostCrs);
  const LocalFrame stored = frame_of_positions(frame, ply);
  const LasLayout layout = layout_of(ply);
  Passes passes(ply, 2, context);
  LasWriter writer(las, layout, grid_of(box_of(passes, stored), ply), crs);
  passes.pass([&](const VertexRows& rows) { writer.add(point_of(rows, layout, stored, ply)); });
  writer.finish();
  const LasHeader header = writer.header();
  return {header.points, header.grid.scale, header.low, header.high};
}

}  // namespace axial::io
