// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/map_archive.h"

#include <cpl_minixml.h>

#include <cmath>
#include <memory>

#include "base/atomic_file.h"
#include "base/error.h"
#include "private/gdal_calls.h"
#include "private/map_metadata.h"
#include "private/vector_output.h"

namespace axial::map {
namespace {

namespace fs = std::filesystem;

struct FreeNode {
  void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
};

// An element with attributes and elements.
class Element {
 public:
  explicit Element(CPLXMLNode* node) : node_(node) {}

  Element add(const char* name) const {
    return Element(CPLCreateXMLNode(node_, CXT_Element, name));
  }
  // Attributes come before the text.
  Element with(const char* name, const std::string& value) const {
    CPLAddXMLAttributeAndValue(node_, name, value.c_str());
    return *this;
  }
  void says(const std::string& text) const { CPLCreateXMLNode(node_, CXT_Text, text.c_str()); }
  void says(double number) const { says(fmt::format("{}", number)); }

 private:
  CPLXMLNode* node_;
};

void add_inputs(const Element& root, const ArchiveFacts& facts) {
  const Element lineage = root.add("lineage");
  for (const auto& [role, file] : facts.inputs)
    lineage.add("source").with("role", role).says(file.filename().string());
  for (const auto& [port, count] : facts.ports)
    lineage.add("photographs").with("port", port).says(std::to_string(count));
}

void add_place(const Element& root, GDALDatasetH map, const fs::path& heights) {
  const MapGrid grid = grid_of(map);
  root.add("referenceSystem").says(GDALGetProjectionRef(map));
  root.add("spatialResolution").with("unit", "m").says(grid.pixel);
  const Element size = root.add("size").with("unit", "px");
  size.add("columns").says(grid.columns);
  size.add("rows").says(grid.rows);
  const Element extent = root.add("extent").with("unit", "m");
  extent.add("west").says(grid.left);
  extent.add("east").says(grid.left + grid.columns * grid.pixel);
  extent.add("south").says(grid.top - grid.rows * grid.pixel);
  extent.add("north").says(grid.top);
  const std::optional<WorldAxes> axes = axes_in(map, heights);
  if (!axes) return;
  const auto rows = axes->axes.reshaped<Eigen::RowMajor>();
  const Element stated = root.add("axes");
  stated.add("rotation").says(fmt::format("{}", fmt::join(rows.begin(), rows.end(), " ")));
  stated.add("offset")
      .with("unit", "m")
      .says(fmt::format("{}", fmt::join(axes->offset.begin(), axes->offset.end(), " ")));
}

// Nothing if no place has an expected error.
void add_errors(const Element& root, const fs::path& errors_map, double image_noise) {
  if (errors_map.empty()) return;
  const GdalErrors errors;
  const GdalSetting no_side_files("GDAL_PAM_ENABLED", "NO");
  const DatasetPtr map = open_map(errors_map, errors);
  double least = 0, most = 0, mean = 0, spread = 0;
  {
    const GdalErrors without_values;  // GDAL's error for a map without values
    if (GDALComputeRasterStatistics(GDALGetRasterBand(map.get(), 1), FALSE, &least, &most, &mean,
                                    &spread, nullptr, nullptr) != CE_None)
      return;
  }
  const Element accuracy = root.add("expectedHeightError").with("unit", "m");
  accuracy.add("imageNoise").with("unit", "px").says(image_noise);
  accuracy.add("mean").says(fmt::format("{:.6f}", mean));
  accuracy.add("rms").says(fmt::format("{:.6f}", std::hypot(mean, spread)));
  accuracy.add("largest").says(fmt::format("{:.6f}", most));
}

}  // namespace

void write_archive_description(const MapFiles& maps, const ArchiveFacts& facts,
                               const std::vector<fs::path>& files, const fs::path& path) {
  const std::unique_ptr<CPLXMLNode, FreeNode> begin(CPLCreateXMLNode(nullptr, CXT_Element, "?xml"));
  Element(begin.get()).with("version", "1.0").with("encoding", "UTF-8");
  CPLAddXMLSibling(begin.get(), CPLCreateXMLNode(nullptr, CXT_Element, "mapArchive"));
  const Element root(begin->psNext);
  root.with("version", "1");
  root.add("title").says(facts.title);
  root.add("program").says(facts.program);
  add_inputs(root, facts);
  const GdalErrors errors;
  const DatasetPtr map = open_map(maps.heights, errors);
  add_place(root, map.get(), maps.heights);
  add_errors(root, maps.errors, facts.image_noise);
  const Element list = root.add("files");
  for (const fs::path& file : files) list.add("file").says(file.filename().string());
  const std::unique_ptr<char, decltype(&VSIFree)> text(CPLSerializeXMLTree(begin.get()), VSIFree);
  write_atomically(path, text.get());
}

}  // namespace axial::map
