// SPDX-License-Identifier: GPL-3.0-or-later
// A cloud that is written as LAS.
#pragma once

#include "axial/base.h"
#include "options.h"

namespace axial::apps {

// Writes the cloud Options::input to Options::output, in world coordinates, and tells what was
// written. The file <cloud>.geo.json, which belongs to the scene of the same name, places a cloud
// that states no offset. Errors as for io::write_cloud_as_las() and map::crs_of_epsg(), and if the
// output is an input.
void write_as_las(const Options& options, const Context& context);

}  // namespace axial::apps
