// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/icp.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "evaluate/shapes.h"
#include "geometry/sampling.h"

namespace axial::geometry {
namespace {

using namespace evaluate;  // shapes

std::vector<Eigen::Vector3f> transformed(const std::vector<Eigen::Vector3f>& points,
                                         const Similarity& by) {
  std::vector<Eigen::Vector3f> result;
  for (const auto& x : points) result.push_back(by(x.cast<double>()).cast<float>());
  return result;
}

Similarity small_offset() {
  Similarity offset;
  offset.rotation =
      Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  offset.translation = {0.01, -0.02, 0.015};
  return offset;
}

TEST(RefineRigid, RecoversASmallOffset) {
  const Mesh mesh = height_field(50, 2, ripples);
  const Surface surface(mesh);
  const auto points = sample_surface(height_field(50, 1.8, ripples), 5000, 2);
  const auto reference = distances_to(surface, points);
  const IcpResult result = refine_rigid(transformed(points, small_offset()), surface);
  EXPECT_TRUE(result.converged);
  const Similarity left = result.transform.after(small_offset());
  // The facets of the two meshes differ by some tenths of a millimetre, without bias.
  EXPECT_LT(left.translation.norm(), 3e-4);
  EXPECT_LT((left.rotation - Eigen::Matrix3d::Identity()).norm(), 3e-4);
  EXPECT_GT(result.median_before, 0.005);
  EXPECT_LT(result.median_after, 3e-4);
  EXPECT_EQ(left.scale, 1);
}

TEST(RefineRigid, IsExactWhereTheSurfaceIs) {
  const Mesh mesh = height_field(30, 2, ripples);
  const auto points = sample_surface(mesh, 4000, 2);
  const IcpResult result = refine_rigid(transformed(points, small_offset()), Surface(mesh));
  const Similarity left = result.transform.after(small_offset());
  // The float coordinates of the transformed points limit the accuracy.
  EXPECT_LT(left.translation.norm(), 1e-6);
  EXPECT_LT((left.rotation - Eigen::Matrix3d::Identity()).norm(), 1e-6);
}

TEST(RefineRigid, OutliersDoNotPull) {
  const Mesh mesh = height_field(30, 2, ripples);
  auto points = transformed(sample_surface(mesh, 4000, 2), small_offset());
  for (std::size_t i = 0; i < points.size(); i += 10) points[i].z() += 0.5f;
  const IcpResult result = refine_rigid(points, Surface(mesh));
  EXPECT_LT(result.transform.after(small_offset()).translation.norm(), 1e-5);
}

TEST(RefineRigid, DoesNotSlideOnAPlane) {
  const Mesh plane = flat_square(4, 0);
  auto points = sample_surface(flat_square(1, 0.03), 2000, 1);
  const IcpResult result = refine_rigid(points, Surface(plane));
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(result.transform.translation.z(), -0.03, 1e-6);
  EXPECT_LT(result.transform.translation.head<2>().norm(), 1e-6);
}

TEST(RefineRigid, GivesTheSameTwice) {
  const Mesh mesh = height_field(30, 2, ripples);
  const auto points = transformed(sample_surface(mesh, 30000, 2), small_offset());
  EXPECT_EQ(refine_rigid(points, Surface(mesh)).transform.matrix(),
            refine_rigid(points, Surface(mesh)).transform.matrix());
}

TEST(RefineRigid, RefusesTooFewPoints) {
  const std::vector<Eigen::Vector3f> few(5, Eigen::Vector3f::Zero());
  EXPECT_THROW(refine_rigid(few, Surface(flat_square(1, 0))), Error);
  const std::vector<Eigen::Vector3f> same(50, Eigen::Vector3f::Zero());
  EXPECT_THROW(refine_rigid(same, Surface(flat_square(1, 0))), Error);
}

}  // namespace
}  // namespace axial::geometry
