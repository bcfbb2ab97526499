// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/local_coordinates.h"

#include "base/error.h"

namespace axial::map {

void warn_of_local_coordinates(int epsg, const std::filesystem::path& file,
                               const Context& context) {
  if (epsg > 0)
    context.warning(
        "{} {}: the coordinates of {} are within 1 km of the origin: are they local coordinates? "
        "The system is stated all the same",
        setting("epsg"), epsg, file.string());
}

}  // namespace axial::map
