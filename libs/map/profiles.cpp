// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/profiles.h"

#include <ogr_api.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "map/geotiff.h"
#include "map/stated_kind.h"
#include "private/csv.h"
#include "private/map_metadata.h"
#include "private/vector_file.h"
#include "private/vector_output.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct ProfilePoint {
  double distance;  // along the line [m]
  Eigen::Vector2d place;
  double height;  // NaN: unknown
};

ProfileLine line_of(OGRGeometryH shape, std::string name, const fs::path& file) {
  ProfileLine line{std::move(name), {}};
  for (int k = 0; k < OGR_G_GetPointCount(shape); ++k) {
    const Eigen::Vector2d corner(OGR_G_GetX(shape, k), OGR_G_GetY(shape, k));
    if (!corner.allFinite())
      fail_in(file, "line '{}' has a coordinate that is not finite", line.name);
    if (line.corners.empty() || corner != line.corners.back()) line.corners.push_back(corner);
  }
  if (line.corners.size() < 2) fail_in(file, "line '{}' has no length", line.name);
  return line;
}

void add_lines(const FoundFeature& found, const fs::path& file, std::vector<ProfileLine>& lines) {
  if (plain_type(found.shape) == wkbLineString) {
    lines.push_back(line_of(found.shape, found.name, file));
    return;
  }
  const int count = OGR_G_GetGeometryCount(found.shape);
  if (count == 0) fail_in(file, "line '{}' is empty", found.name);
  for (int i = 0; i < count; ++i)
    lines.push_back(line_of(OGR_G_GetGeometryRef(found.shape, i),
                            count == 1 ? found.name : fmt::format("{} {}", found.name, i + 1),
                            file));
}

double length_of(const ProfileLine& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.corners.size(); ++i)
    length += (line.corners[i] - line.corners[i - 1]).norm();
  return length;
}

// The map is a rectangle, so that a line with its corners on the map is on the map.
void require_on_map(const ProfileLine& line, const MapGrid& grid, const fs::path& file) {
  const double right = grid.left + grid.columns * grid.pixel;
  const double bottom = grid.top - grid.rows * grid.pixel;
  for (const Eigen::Vector2d& at : line.corners)
    if (!(at.x() >= grid.left && at.x() <= right && at.y() >= bottom && at.y() <= grid.top))
      fail_in(
          file,
          "line '{}' is not on the map at ({:.3f}, {:.3f}): the map has x from {:.3f} to {:.3f} "
          "and y from {:.3f} to {:.3f}",
          line.name, at.x(), at.y(), grid.left, right, bottom, grid.top);
}

// More would need much memory for the table.
void require_few_points(std::span<const ProfileLine> lines, double pixel, const fs::path& file) {
  constexpr double kMost = 1e6;
  double points = 0;
  for (const ProfileLine& line : lines)
    points += length_of(line) / pixel + static_cast<double>(line.corners.size());
  if (points > kMost)
    fail_in(file, "its lines have {:.0f} points at pixels of {:.4g} m, at most {:.0f} are possible",
            points, pixel, kMost);
}

// The heights of a map, read where they are needed.
class Heights {
 public:
  Heights(GDALDatasetH map, const MapGrid& grid) : band_(GDALGetRasterBand(map, 1)), grid_(grid) {}

  double at(const Eigen::Vector2d& place) const {
    const auto [column, right] = between((place.x() - grid_.left) / grid_.pixel, grid_.columns);
    const auto [row, down] = between((grid_.top - place.y()) / grid_.pixel, grid_.rows);
    const int width = std::min(2, grid_.columns), height = std::min(2, grid_.rows);
    std::array<float, 4> h{};
    if (GDALRasterIO(band_, GF_Read, column, row, width, height, h.data(), width, height,
                     GDT_Float32, 0, 0) != CE_None)
      return kUnknown;
    const auto value = [&](int y, int x) {
      return double{
          h[static_cast<std::size_t>(std::min(y, height - 1) * width + std::min(x, width - 1))]};
    };
    for (const int k : {0, 1, 2, 3})
      if (value(k / 2, k % 2) == double{kNoHeight}) return kUnknown;
    return std::lerp(std::lerp(value(0, 0), value(0, 1), right),
                     std::lerp(value(1, 0), value(1, 1), right), down);
  }

 private:
  // The pixel before the place, and the share of the way to the centre of the next pixel. `at`:
  // from the border of the map [px].
  static std::pair<int, double> between(double at, int count) {
    const double centre = std::clamp(at - 0.5, 0.0, std::max(0.0, count - 1.0));
    const int first = std::clamp(static_cast<int>(centre), 0, std::max(0, count - 2));
    return {first, centre - first};
  }

  GDALRasterBandH band_;
  MapGrid grid_;
};

std::vector<ProfilePoint> points_of(const ProfileLine& line, double step, const Heights& heights) {
  std::vector<ProfilePoint> points{{0, line.corners[0], heights.at(line.corners[0])}};
  double begin = 0;
  for (std::size_t i = 1; i < line.corners.size(); ++i) {
    const Eigen::Vector2d from = line.corners[i - 1], to = line.corners[i];
    const double length = (to - from).norm(), end = begin + length;
    // Not beside a corner: coordinates have rounding errors.
    const double margin = 1e-6 * step;
    for (double k = std::floor((begin + margin) / step) + 1; k * step < end - margin; ++k) {
      const Eigen::Vector2d place = from + (to - from) * ((k * step - begin) / length);
      points.push_back({k * step, place, heights.at(place)});
    }
    points.push_back({end, to, heights.at(to)});
    begin = end;
  }
  return points;
}

void add_rows(const ProfileLine& line, std::span<const ProfilePoint> points, std::string& table) {
  for (const ProfilePoint& point : points) {
    table += fmt::format("{},{:.4f},{:.4f},{:.4f},", quoted(line.name), point.distance,
                         point.place.x(), point.place.y());
    if (std::isfinite(point.height)) table += fmt::format("{:.4f}", point.height);
    table += '\n';
  }
}

// The pieces of a profile with known heights. Null: there is none.
Geometry shape_of(std::span<const ProfilePoint> points) {
  Geometry pieces(OGR_G_CreateGeometry(wkbMultiLineString25D));
  for (auto at = points.begin(); at != points.end();) {
    const auto is_known = [](const ProfilePoint& p) { return std::isfinite(p.height); };
    const auto begin = std::find_if(at, points.end(), is_known);
    const auto end = std::find_if_not(begin, points.end(), is_known);
    at = end;
    if (end - begin < 2) continue;
    const OGRGeometryH piece = OGR_G_CreateGeometry(wkbLineString25D);
    for (auto p = begin; p != end; ++p)
      OGR_G_AddPoint(piece, p->place.x(), p->place.y(), p->height);
    OGR_G_AddGeometryDirectly(pieces.get(), piece);
  }
  return OGR_G_IsEmpty(pieces.get()) ? Geometry() : std::move(pieces);
}

bool add_feature(OGRLayerH layer, const ProfileLine& line, std::span<const ProfilePoint> points) {
  const Feature feature(OGR_F_Create(OGR_L_GetLayerDefn(layer)));
  OGR_F_SetFieldString(feature.get(), 0, line.name.c_str());
  OGR_F_SetFieldDouble(feature.get(), 1, points.back().distance);
  if (const Geometry shape = shape_of(points)) OGR_F_SetGeometry(feature.get(), shape.get());
  return OGR_L_CreateFeature(layer, feature.get()) == OGRERR_NONE;
}

}  // namespace

std::vector<ProfileLine> read_lines(const fs::path& file, const std::string& crs) {
  std::vector<ProfileLine> lines;
  for_each_feature(file, crs, Shapes::lines,
                   [&](const FoundFeature& found) { add_lines(found, file, lines); });
  return lines;
}

std::vector<ProfileLine> read_lines(const fs::path& file, const std::string& crs,
                                    const MapGrid& grid) {
  std::vector<ProfileLine> lines = read_lines(file, crs);
  for (const ProfileLine& line : lines) require_on_map(line, grid, file);
  require_few_points(lines, grid.pixel, file);
  return lines;
}

void write_profiles(const fs::path& heights, std::span<const ProfileLine> lines,
                    const ProfileFiles& files) {
  const GdalErrors errors;
  const FixedDate date;
  const DatasetPtr map = open_map(heights, errors);
  const MapGrid grid = grid_of(map.get());
  DatasetPtr package = make_vector_file("GPKG", files.package, errors);
  const GdalOptions options{{"DESCRIPTION", fmt::format("{} {}", kKindItem, kinds::kProfiles)}};
  const OGRLayerH layer =
      GDALDatasetCreateLayer(package.get(), "profiles", GDALGetSpatialRef(map.get()),
                             wkbMultiLineString25D, options.list());
  errors.require_written(layer != nullptr, files.package);
  bool works = add_field(layer, "name", OFTString) && add_field(layer, "length_m", OFTReal);
  std::string table = "profile,distance_m,x,y,height_m\n";
  for (const ProfileLine& line : lines) {
    const auto points = points_of(line, grid.pixel, Heights(map.get(), grid));
    add_rows(line, points, table);
    works = works && add_feature(layer, line, points);
  }
  package.reset();
  errors.require_written(works, files.package);
  write_drawing(files.package, "profiles", files.drawing);
  write_atomically(files.table, table);
}

}  // namespace axial::map
