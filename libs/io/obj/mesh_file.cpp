// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/obj/mesh_file.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <iterator>
#include <limits>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_extension.h"
#include "base/program/output_name.h"
#include "io/openmvs/scene_files.h"
#include "io/ply/ply.h"
#include "textured/private/gltf_file.h"

namespace axial::io {
namespace {

// Coordinates have nine significant digits, so that reading gives the same float.
void write_mesh_obj(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  const Eigen::Vector3d& o = frame.origin;
  if (!frame.is_world()) fmt::format_to(out, "# geo_offset {} {} {}\n", o.x(), o.y(), o.z());
  for (const Eigen::Vector3f& v : mesh.vertices)
    fmt::format_to(out, "v {:.9g} {:.9g} {:.9g}\n", v.x(), v.y(), v.z());
  for (const auto& face : mesh.faces)
    fmt::format_to(out, "f {} {} {}\n", face[0] + 1, face[1] + 1, face[2] + 1);
  write_atomically(path, {text.data(), text.size()});
}

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");
static_assert(sizeof(Eigen::Vector3f) == 12 && sizeof(Mesh{}.faces[0]) == 12);

constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2;

struct Bounds {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f high = -low;
};

Bounds bounds_of(const Mesh& mesh, const std::string& file) {
  Bounds bounds;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!mesh.vertices[v].allFinite()) fail_in(file, "vertex {} is not finite", v);
    bounds.low = bounds.low.cwiseMin(mesh.vertices[v]);
    bounds.high = bounds.high.cwiseMax(mesh.vertices[v]);
  }
  return bounds;
}

template <class Vector>
std::string list(const Vector& v) {
  return fmt::format("[{},{},{}]", v.x(), v.y(), v.z());
}

// The text is padded with blanks to a multiple of four bytes, as glTF wants it.
std::string json_of(const Mesh& mesh, const Bounds& bounds, const LocalFrame& frame) {
  const std::size_t vertices = mesh.vertices.size(), faces = mesh.faces.size();
  const std::string extras =
      frame.is_world() ? "" : fmt::format(R"(,"extras":{{"geo_offset":{}}})", list(frame.origin));
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"AxialMVS"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0{}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},)"
      R"("indices":1,"mode":4}}]}}],"accessors":[{{"bufferView":0,"componentType":5126,)"
      R"("count":{},"type":"VEC3","min":{},"max":{}}},{{"bufferView":1,"componentType":5125,)"
      R"("count":{},"type":"SCALAR"}}],"bufferViews":[{{"buffer":0,"byteOffset":0,)"
      R"("byteLength":{},"target":34962}},{{"buffer":0,"byteOffset":{},"byteLength":{},)"
      R"("target":34963}}],"buffers":[{{"byteLength":{}}}]}})",
      extras, vertices, list(bounds.low.cast<double>()), list(bounds.high.cast<double>()),
      3 * faces, 12 * vertices, 12 * vertices, 12 * faces, 12 * (vertices + faces));
  json.resize((json.size() + 3) / 4 * 4, ' ');
  return json;
}

void append(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

void append(std::string& bytes, std::uint32_t number) {
  append(bytes, &number, sizeof number);
}

void write_mesh_glb(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame) {
  if (mesh.faces.empty()) fail_in(path, "the mesh has no faces");
  const std::string json = json_of(mesh, bounds_of(mesh, path.string()), frame);
  const std::uint64_t binary = 12 * (std::uint64_t{mesh.vertices.size()} + mesh.faces.size());
  const std::uint64_t whole = 12 + 8 + json.size() + 8 + binary;
  if (whole > std::numeric_limits<std::uint32_t>::max())
    fail_in(path, "a GLB holds at most 4 GiB, but the mesh has {} MB", whole / 1'000'000);
  std::string bytes;
  bytes.reserve(whole);
  for (const std::uint64_t number : {std::uint64_t{kMagic}, std::uint64_t{kVersion}, whole,
                                     std::uint64_t{json.size()}, std::uint64_t{kGlbJson}})
    append(bytes, static_cast<std::uint32_t>(number));
  bytes += json;
  append(bytes, static_cast<std::uint32_t>(binary));
  append(bytes, kGlbBinary);
  append(bytes, mesh.vertices.data(), 12 * mesh.vertices.size());
  append(bytes, mesh.faces.data(), 12 * mesh.faces.size());
  write_atomically(path, bytes);
}

bool is_written(const std::string& type) {
  return type == "ply" || type == "obj" || type == "glb";
}

// The type that the user gave, or that the extension of the output asks for.
std::string type_of(const MeshFile& file) {
  const std::string given = lower_case(file.type);
  if (!is_written(given)) fail("{} {}: must be one of ply, obj, glb", setting("type"), file.type);
  const std::string extension = known_extension(file.output);
  if (file.type_given || extension.empty() || extension == ".mvs") return given;
  if (!is_written(extension.substr(1)))
    fail("{} {}: must end in .ply, .obj or .glb", setting("output"), file.output.string());
  return extension.substr(1);
}

}  // namespace

std::filesystem::path mesh_file(const MeshFile& file, const Context& context) {
  refuse_other_format(file.output, setting("output"));
  const std::string type = type_of(file);
  return mesh_beside(file.scene, file.output, file.ending, type == "ply", context) += "." + type;
}

void write_mesh(const std::filesystem::path& path, const Mesh& mesh, const LocalFrame& frame) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj")
    write_mesh_obj(path, mesh, frame);
  else if (extension == ".glb")
    write_mesh_glb(path, mesh, frame);
  else
    write_mesh_ply(path, mesh, {frame});
}

}  // namespace axial::io
