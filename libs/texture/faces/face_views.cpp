// SPDX-License-Identifier: GPL-3.0-or-later
#include "texture/faces/face_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/plane_cross.h"
#include "geometry/posed_camera.h"
#include "geometry/vertex_normals.h"
#include "scene/bilinear.h"
#include "scene/camera_model.h"

namespace axial::texture {
namespace {

// A sight, without the view that the list of a view has in common.
struct SeenFace {
  std::uint32_t face;
  float quality;
  std::array<std::uint8_t, 3> color;
  bool whole;
};

// Counts unusable pixels in rectangles.
class UnusablePixels {
 public:
  explicit UnusablePixels(const cv::Mat1b& usable) : usable_(usable) {
    if (usable.empty()) return;
    cv::Mat1b unusable;
    cv::compare(usable, 0, unusable, cv::CMP_EQ);
    unusable /= 255;
    cv::integral(unusable, sums_, CV_32S);
  }

  // Whether a pixel that the face needs is unusable: one that is nearer to it than a pixel.
  bool touch(const std::array<Eigen::Vector2f, 3>& corners) const {
    if (sums_.empty()) return false;
    const Eigen::Vector2f low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Eigen::Vector2f high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    const int x0 = std::max(0, static_cast<int>(std::floor(low.x())));
    const int y0 = std::max(0, static_cast<int>(std::floor(low.y())));
    const int x1 = std::min(usable_.cols - 1, static_cast<int>(std::ceil(high.x())));
    const int y1 = std::min(usable_.rows - 1, static_cast<int>(std::ceil(high.y())));
    const int sum = sums_(y1 + 1, x1 + 1) - sums_(y0, x1 + 1) - sums_(y1 + 1, x0) + sums_(y0, x0);
    if (sum == 0) return false;
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x)
        if (usable_(y, x) == 0 && near(corners, {static_cast<float>(x), static_cast<float>(y)}))
          return true;
    return false;
  }

 private:
  static bool near(const std::array<Eigen::Vector2f, 3>& corners, const Eigen::Vector2f& pixel) {
    const float turn =
        plane_cross(corners[1] - corners[0], corners[2] - corners[0]) < 0 ? -1.0f : 1.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2f edge = corners[(k + 1) % 3] - corners[k];
      constexpr float kReach = 1.42f;  // the diagonal of a pixel: all pixels of bilinear()
      if (turn * plane_cross(edge, pixel - corners[k]) < -kReach * edge.norm()) return false;
    }
    return true;
  }

  cv::Mat1b usable_;
  cv::Mat1i sums_;
};

enum class Sees : std::uint8_t { unknown, yes, no, outside };

// A vertex in the image of a view.
struct ProjectedVertex {
  Eigen::Vector2f pixel;
  Sees state;
};

template <class Camera>
std::vector<ProjectedVertex> project_vertices(const Mesh& mesh, const Camera& camera,
                                              const View& view) {
  std::vector<ProjectedVertex> vertices(mesh.vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto image = camera.project(view.pose.to_camera(mesh.vertices[i].cast<double>()));
    const bool inside = image.visible && geometry::is_in_image(view.camera, image.pixel, 0);
    vertices[i] = {image.pixel.template cast<float>(), inside ? Sees::unknown : Sees::outside};
  }
  return vertices;
}

bool any_face_inside(const Mesh& mesh, std::span<const ProjectedVertex> vertices) {
  return std::ranges::any_of(mesh.faces, [&](const std::array<std::uint32_t, 3>& face) {
    return std::ranges::none_of(
        face, [&](std::uint32_t corner) { return vertices[corner].state == Sees::outside; });
  });
}

// The faces that are looked at, and what their sights depend on.
struct Scenery {
  const Mesh& mesh;
  std::span<const Eigen::Vector3f> normals;  // one per vertex of `mesh`
  const geometry::Surface& surface;          // of the whole mesh
};

// What one view sees.
template <class Camera>
class Observer {
 public:
  // `vertices`: the result of project_vertices().
  Observer(const Scenery& scenery, const VisibilityOptions& options, const Camera& camera,
           const View& view, const ViewImage& image, std::vector<ProjectedVertex> vertices)
      : mesh_(scenery.mesh),
        normals_(scenery.normals),
        surface_(scenery.surface),
        options_(options),
        camera_(camera),
        view_(view),
        image_(image),
        unusable_(image.usable),
        vertices_(std::move(vertices)) {}

  std::vector<SeenFace> seen() {
    std::vector<SeenFace> result;
    for (std::uint32_t face = 0; face < mesh_.faces.size(); ++face) {
      if (!mesh_.unseen.empty() && mesh_.unseen[face]) continue;
      if (const std::optional<Sight> s = look_at(face))
        result.push_back({face, s->quality, s->color, s->whole});
    }
    return result;
  }

 private:
  Eigen::Vector3d position(std::size_t vertex) const {
    return mesh_.vertices[vertex].cast<double>();
  }

  // Where the light from a pixel enters the water [world].
  Eigen::Vector3d exit(const Eigen::Vector2f& pixel) const {
    return view_.pose.to_world(camera_.exit_point(pixel.cast<double>()));
  }

  bool hidden(const Eigen::Vector3d& point, const Eigen::Vector2f& pixel) const {
    return surface_.between(exit(pixel), point, 0, options_.tolerance);
  }

  bool sees_vertex(std::uint32_t i) {
    ProjectedVertex& vertex = vertices_[i];
    if (vertex.state == Sees::unknown)
      vertex.state = hidden(position(i), vertex.pixel) ? Sees::no : Sees::yes;
    return vertex.state == Sees::yes;
  }

  std::optional<Sight> look_at(std::uint32_t face) {
    const auto& [a, b, c] = mesh_.faces[face];
    for (const std::uint32_t corner : {a, b, c})
      if (vertices_[corner].state == Sees::outside) return {};
    const std::array<Eigen::Vector2f, 3> corners{vertices_[a].pixel, vertices_[b].pixel,
                                                 vertices_[c].pixel};
    const Eigen::Vector2f middle = (corners[0] + corners[1] + corners[2]) / 3;
    const Eigen::Vector3d point = (position(a) + position(b) + position(c)) / 3;
    const Eigen::Vector3d to_camera = (exit(middle) - point).normalized();
    const Eigen::Vector3f smooth = (normals_[a] + normals_[b] + normals_[c]).normalized();
    const double cosine = smooth.cast<double>().dot(to_camera);
    const Eigen::Vector2f u = corners[1] - corners[0], v = corners[2] - corners[0];
    const float area = 0.5f * (u.y() * v.x() - u.x() * v.y());  // y down: positive from outside
    const bool front =
        area > 0 && (position(b) - position(a)).cross(position(c) - position(a)).dot(to_camera) > 0;
    if ((!front && !(cosine > 0)) || area == 0 || unusable_.touch(corners)) return {};
    Sight sight;
    sight.quality = static_cast<float>(std::abs(area) * std::pow(std::max(1e-3, cosine), 2));
    sight.whole = front && sees_vertex(a) && sees_vertex(b) && sees_vertex(c) &&
                  look_inside(face, corners, area, sight);
    if (!sight.whole && hidden(point, middle)) return {};
    return sight;
  }

  // Looks at points inside the face, about every 6 pixels, and finds its mean colour. Returns false
  // if one of them is hidden. The inside of a face of a few pixels is seen if its corners are.
  bool look_inside(std::uint32_t face, const std::array<Eigen::Vector2f, 3>& corners, float area,
                   Sight& sight) const {
    constexpr float kSmall = 16, kStep = 6;
    const int n = area < kSmall ? 1 : 2 + static_cast<int>(std::sqrt(2 * area) / kStep);
    const auto& f = mesh_.faces[face];
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int count = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j, ++count) {
        const float s = (static_cast<float>(i) + 1 / 3.0f) / static_cast<float>(n);
        const float t = (static_cast<float>(j) + 1 / 3.0f) / static_cast<float>(n);
        const Eigen::Vector2f pixel = (1 - s - t) * corners[0] + s * corners[1] + t * corners[2];
        const Eigen::Vector3d point =
            (1 - s - t) * position(f[0]) + s * position(f[1]) + t * position(f[2]);
        if (n > 1 && hidden(point, pixel)) return false;
        sum += bilinear(image_.color, pixel);
      }
    if (n == 1) {
      for (const Eigen::Vector2f& corner : corners) sum += bilinear(image_.color, corner);
      count += 3;
    }
    for (int k = 0; k < 3; ++k)
      sight.color[static_cast<std::size_t>(k)] =
          static_cast<std::uint8_t>(sum[k] / static_cast<float>(count) + 0.5f);
    return true;
  }

  const Mesh& mesh_;
  std::span<const Eigen::Vector3f> normals_;
  const geometry::Surface& surface_;
  const VisibilityOptions& options_;
  const Camera& camera_;
  const View& view_;
  const ViewImage& image_;
  UnusablePixels unusable_;
  std::vector<ProjectedVertex> vertices_;
};

// Removes sights of a part of a face where a view sees all of it.
void prefer_whole(FaceViews& views) {
  std::uint64_t next = 0, from = 0;
  for (std::size_t f = 0; f < views.faces(); ++f) {
    const std::uint64_t to = views.begin[f + 1];
    const auto seen = std::span(views.sights).subspan(from, to - from);
    const bool any = std::ranges::any_of(seen, &Sight::whole);
    views.begin[f] = next;
    for (const Sight& sight : seen)
      if (sight.whole || !any) views.sights[next++] = sight;
    from = to;
  }
  views.begin.back() = next;
  views.sights.resize(next);
}

FaceViews by_face(std::size_t faces, std::vector<std::vector<SeenFace>>& of_views) {
  FaceViews result;
  result.begin.assign(faces + 1, 0);
  for (const auto& seen : of_views)
    for (const SeenFace& s : seen) ++result.begin[s.face + 1];
  for (std::size_t f = 0; f < faces; ++f) result.begin[f + 1] += result.begin[f];
  result.sights.resize(result.begin.back());
  std::vector<std::uint64_t> next(result.begin.begin(), result.begin.end() - 1);
  for (std::uint32_t v = 0; v < of_views.size(); ++v) {
    for (const SeenFace& s : of_views[v])
      result.sights[next[s.face]++] = {v, s.quality, s.color, s.whole};
    std::vector<SeenFace>().swap(of_views[v]);
  }
  prefer_whole(result);
  return result;
}

// The memory [bytes] for each view in work.
std::uint64_t bytes_of_view(const Mesh& mesh, std::span<const View> views,
                            std::uint64_t image_bytes) {
  // Pixels and state of the vertices; the list of what the view sees, which grows; the complement
  // of the usable pixels, and its sums.
  return image_bytes + mesh.vertices.size() * 12 + mesh.faces.size() * 2 * sizeof(SeenFace) +
         geometry::most_pixels(views) * (1 + sizeof(int));
}

// Collects what the views see, as long as there is memory for it, and counts it in any case.
class SeenFaces {
 public:
  // `fixed`: the memory [bytes] that is in use as long as views are in work.
  SeenFaces(const Mesh& mesh, std::span<const View> views, const ViewMemory& memory,
            std::uint64_t fixed, const ProgressSink& progress)
      : faces_(mesh.faces.size()),
        budget_(memory.budget),
        progress_(progress),
        of_view_(views.size()) {
    const std::uint64_t each = bytes_of_view(mesh, views, memory.image_bytes);
    budget_.require(fixed + each, fmt::format("finding the views of {} faces", faces_));
    // Half of the memory is for what the views see.
    in_flight_ = std::clamp<std::uint64_t>((budget_.left() - fixed) / 2 / each, 1, thread_count());
    in_work_ = fixed + in_flight_ * each;
  }

  std::size_t in_flight() const { return in_flight_; }

  void add(std::size_t view, std::vector<SeenFace> seen) {
    seen.shrink_to_fit();
    const std::lock_guard lock(mutex_);
    count_ += seen.size();
    if (bytes() <= budget_.left())
      of_view_[view] = std::move(seen);
    else
      std::vector<std::vector<SeenFace>>(of_view_.size()).swap(of_view_);
    if (progress_) progress_(++done_, of_view_.size());
  }

  std::vector<std::vector<SeenFace>>& of_view() {
    budget_.require(bytes(), fmt::format("a list of {} views of {} faces", count_, faces_));
    return of_view_;
  }

 private:
  // While views are in work, or while their lists are sorted by faces.
  std::uint64_t bytes() const {
    const std::uint64_t seen = count_ * sizeof(SeenFace);
    return std::max(in_work_ + seen,
                    seen + count_ * sizeof(Sight) + faces_ * 2 * sizeof(std::uint64_t));
  }

  std::size_t faces_;
  MemoryBudget budget_;
  const ProgressSink& progress_;
  std::size_t in_flight_ = 1;
  std::uint64_t in_work_ = 0;  // [bytes]
  std::mutex mutex_;
  std::vector<std::vector<SeenFace>> of_view_;
  std::size_t count_ = 0, done_ = 0;
};

void look(const Scenery& scenery, std::span<const View> views, const ImageSource& images,
          const VisibilityOptions& options, SeenFaces& seen) {
  for_each_in_flight(views.size(), seen.in_flight(), [&](std::size_t v) {
    std::visit(
        [&](const auto& camera) {
          auto vertices = project_vertices(scenery.mesh, camera, views[v]);
          if (!any_face_inside(scenery.mesh, vertices)) {
            seen.add(v, {});
            return;
          }
          const ViewImage image = images(v);
          seen.add(v,
                   Observer(scenery, options, camera, views[v], image, std::move(vertices)).seen());
        },
        make_camera<double>(views[v].camera));
  });
}

}  // namespace

Surroundings::Surroundings(const Mesh& mesh)
    : surface(mesh), normals(geometry::vertex_normals(mesh)) {}

std::uint64_t bytes_of_surroundings(const Mesh& mesh) {
  return geometry::bytes_of_surface(mesh) + mesh.vertices.size() * sizeof(Eigen::Vector3f);
}

FaceViews find_face_views(const Mesh& mesh, std::span<const View> views, const ImageSource& images,
                          const VisibilityOptions& options, const ProgressSink& progress,
                          const ViewMemory& memory) {
  SeenFaces seen(mesh, views, memory, bytes_of_surroundings(mesh), progress);
  {
    const Surroundings whole(mesh);
    look({mesh, whole.normals, whole.surface}, views, images, options, seen);
  }
  return by_face(mesh.faces.size(), seen.of_view());
}

FaceViews find_face_views(const MeshPart& part, const Surroundings& whole,
                          std::span<const View> views, const ImageSource& images,
                          const VisibilityOptions& options, const ProgressSink& progress,
                          const ViewMemory& memory) {
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(part.vertices.size());
  for (const std::uint32_t v : part.vertices) normals.push_back(whole.normals[v]);
  SeenFaces seen(part.mesh, views, memory, normals.size() * sizeof(normals[0]), progress);
  look({part.mesh, normals, whole.surface}, views, images, options, seen);
  return by_face(part.mesh.faces.size(), seen.of_view());
}

}  // namespace axial::texture
