// SPDX-License-Identifier: GPL-3.0-or-later
// The change since an earlier survey.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/context.h"
#include "map/area_table.h"
#include "scene/mesh.h"
#include "settings.h"

namespace axial::apps {

// A survey: its mesh in the coordinates of the map minus an origin, and its measures.
struct MeasuredSurvey {
  const Mesh& mesh;
  std::vector<map::MeasuredArea>& areas;
};

// Adds the change of each polygon to `later.areas`. `origin`: of both meshes. Error if the surveys
// do not overlap in a polygon, and errors of compare::compare_surveys().
void add_changes(const Settings& settings, const Eigen::Vector3d& origin,
                 const MeasuredSurvey& earlier, const MeasuredSurvey& later,
                 const Context& context);

}  // namespace axial::apps
