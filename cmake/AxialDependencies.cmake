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
find_package(TinyGLTF REQUIRED)
# These packages have no CMake files.
find_path(MAXFLOW_INCLUDE_DIR maxflow/graph.h PATH_SUFFIXES maxflow-3.0 REQUIRED)
find_library(MAXFLOW_LIBRARY maxflow REQUIRED)
find_path(STB_INCLUDE_DIR stb/stb_rect_pack.h REQUIRED)  # used as header-only library
if(AXIAL_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck REQUIRED)
  find_package(benchmark REQUIRED)
  include(GoogleTest)
endif()
