// SPDX-License-Identifier: GPL-3.0-or-later
// A cloud that is read in portions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "io/ply/ply.h"

namespace axial::mesh {

// Reads a cloud and passes it to the sink, portion by portion. Each call passes the same points.
using CloudSource = std::function<void(const io::CloudPortionSink& sink)>;

// Returns the positions of every k-th point, beginning with the first. k is the least number for
// which at most `most` positions are returned. Precondition: `most` is at least 1.
std::vector<Eigen::Vector3f> some_positions(const CloudSource& cloud, std::size_t most);

}  // namespace axial::mesh
