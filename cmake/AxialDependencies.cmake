# SPDX-License-Identifier: GPL-3.0-or-later
# All external libraries of the project, in the versions of Debian 12.
find_package(Eigen3 REQUIRED)
find_package(OpenCV REQUIRED COMPONENTS core imgproc imgcodecs calib3d aruco)
find_package(JPEG REQUIRED)  # libjpeg-turbo
find_package(PNG REQUIRED)
find_package(TIFF REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(nanoflann REQUIRED)
find_package(embree 3 REQUIRED)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)  # used as header-only library
find_package(Boost REQUIRED COMPONENTS program_options)
find_package(Ceres REQUIRED)
# CGAL's headers use gmp and mpfr. Its target CGAL::CGAL is not linked, because it would give its
# compile options to every target that links a library with CGAL; see axial_source_options() in
# libs/mesh.
find_path(CGAL_INCLUDE_DIR CGAL/version.h REQUIRED)
find_path(MAXFLOW_INCLUDE_DIR maxflow.h PATH_SUFFIXES maxflow-3.0 REQUIRED)
foreach(library gmp mpfr maxflow)
  string(TOUPPER ${library} upper)
  find_library(${upper}_LIBRARY ${library} REQUIRED)
  add_library(${library} INTERFACE IMPORTED GLOBAL)
  target_link_libraries(${library} INTERFACE ${${upper}_LIBRARY})
endforeach()
target_include_directories(maxflow SYSTEM INTERFACE ${MAXFLOW_INCLUDE_DIR})
if(AXIAL_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
  find_package(benchmark REQUIRED)
  include(GoogleTest)
endif()
