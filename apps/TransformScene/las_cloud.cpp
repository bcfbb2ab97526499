// SPDX-License-Identifier: GPL-3.0-or-later
#include "las_cloud.h"

#include <array>
#include <filesystem>

#include "axial/map.h"
#include "base/atomic_file.h"
#include "base/log.h"
#include "base/output_lock.h"
#include "base/same_file.h"
#include "io/cameras/geo_offset.h"
#include "io/frames/lost_offset.h"
#include "io/las/cloud_to_las.h"
#include "io/openmvs/point_source.h"
#include "map/local_coordinates.h"

namespace axial::apps {
namespace {

namespace fs = std::filesystem;

void tell(const Options& options, const io::LasReport& report) {
  log_info(
      "{}: {} points, x {:.3f} to {:.3f}, y {:.3f} to {:.3f}, z {:.3f} to {:.3f}, in steps of {}",
      options.output.string(), report.points, report.low.x(), report.high.x(), report.low.y(),
      report.high.y(), report.low.z(), report.high.z(), report.step);
}

}  // namespace

void write_as_las(const Options& options, const Context& context) {
  const std::string crs = options.epsg > 0 ? map::crs_of_epsg(options.epsg) : "";
  const fs::path geo = io::geo_offset_beside(options.input);
  require_not_an_input(options.output, std::array{options.input, geo}, "--output-file");
  const OutputLock lock = lock_output(options.output);
  require_writable(options.output);
  const LocalFrame frame = io::read_geo_offset_beside(options.input).value_or(LocalFrame{});
  if (io::is_without_offset(frame, options.input))
    io::tell_lost_offset(options.input, frame, context);
  const io::LasReport report =
      io::write_cloud_as_las(options.input, options.output, frame, crs, context);
  tell(options, report);
  constexpr double kNear = 1000;  // as for the offset of a scene
  if (((report.low + report.high) / 2).norm() < kNear)
    map::warn_of_local_coordinates(options.epsg, options.input, context);
}

}  // namespace axial::apps
