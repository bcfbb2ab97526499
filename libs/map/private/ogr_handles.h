// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/map: objects of GDAL's vector files that end with their owner.
#pragma once

#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <memory>
#include <type_traits>

namespace axial::map {

template <auto Destroy>
struct Destroyer {
  template <class Handle>
  void operator()(Handle* handle) const {
    Destroy(handle);
  }
};
template <class Handle, auto Destroy>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Destroyer<Destroy>>;
using System = Owned<OGRSpatialReferenceH, OSRDestroySpatialReference>;
using Conversion = Owned<OGRCoordinateTransformationH, OCTDestroyCoordinateTransformation>;
using Feature = Owned<OGRFeatureH, OGR_F_Destroy>;
using Geometry = Owned<OGRGeometryH, OGR_G_DestroyGeometry>;

// Adds a field to a layer. False if that fails.
inline bool add_field(OGRLayerH layer, const char* name, OGRFieldType type) {
  const Owned<OGRFieldDefnH, OGR_Fld_Destroy> field(OGR_Fld_Create(name, type));
  return OGR_L_CreateField(layer, field.get(), TRUE) == OGRERR_NONE;
}

}  // namespace axial::map
