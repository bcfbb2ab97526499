// SPDX-License-Identifier: GPL-3.0-or-later
// What a file of MapSurface or CompareSurveys shows, as the file itself states it.
#pragma once

#include <filesystem>
#include <string>

namespace axial::map {

// The values of the metadata item AXIALMVS_KIND of GeoTIFF files (docs/formats.md), and of the
// description of GeoJSON files and of the layers of GeoPackages.
namespace kinds {
inline constexpr const char* kHeights = "map.dem";
inline constexpr const char* kColors = "map.ortho";
inline constexpr const char* kCounts = "map.views";
inline constexpr const char* kErrors = "map.sigma";
inline constexpr const char* kShades = "map.hillshade";
inline constexpr const char* kContours = "map.contours";
inline constexpr const char* kProfiles = "map.profiles";
inline constexpr const char* kDifference = "change.difference";
inline constexpr const char* kSignificant = "change.significant";
inline constexpr const char* kSigma = "change.sigma";
}  // namespace kinds

// The item of a GeoTIFF that is a copy: the name of the file of which it is one. Copies state the
// kind of their map, too.
inline constexpr const char* kCopyItem = "AXIALMVS_COPY_OF";

// The item that states the kind, in GeoTIFF, GeoJSON and GeoPackage files.
inline constexpr const char* kKindItem = "AXIALMVS_KIND";

// The kind that the GeoTIFF, GeoJSON (extension .geojson) or GeoPackage (extension .gpkg) states.
// Empty if it states none, if it does not exist, and if it cannot be read.
std::string stated_kind(const std::filesystem::path& path);

// The value of kCopyItem of a GeoTIFF; empty as for stated_kind().
std::string stated_source(const std::filesystem::path& path);

}  // namespace axial::map
