# SPDX-License-Identifier: GPL-3.0-or-later
# The Debian packages of the programs and of the Python package. packaging/debian has the files that Debian's rules ask
# for: licenses, changes, and the rules of lintian that do not apply, with the reasons.
set(changelog ${PROJECT_BINARY_DIR}/packaging/changelog.gz)
if(AXIAL_GZIP)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/packaging)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS packaging/debian/changelog)
  execute_process(COMMAND ${AXIAL_GZIP} -9nc ${PROJECT_SOURCE_DIR}/packaging/debian/changelog
    OUTPUT_FILE ${changelog} COMMAND_ERROR_IS_FATAL ANY)
endif()
function(axial_install_debian_files package component)
  set(folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package})
  install(FILES packaging/debian/copyright DESTINATION ${folder} COMPONENT ${component})
  install(FILES ${changelog} DESTINATION ${folder} COMPONENT ${component} OPTIONAL)
  install(FILES packaging/debian/${package}.lintian-overrides DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/lintian/overrides
    COMPONENT ${component} RENAME ${package})
endfunction()

axial_install_debian_files(axialmvs programs)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME axialmvs)
set(CPACK_PACKAGE_VENDOR AxialMVS)
set(CPACK_PACKAGE_CONTACT "AxialMVS developers <axialmvs@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "dense 3D reconstruction for cameras behind flat or dome ports")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL programs)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME axialmvs)
# Lines of at most 80 characters.
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "AxialMVS makes dense clouds, textured meshes and maps from photographs that
were taken under water. It computes the exact path of each ray through glass
and water. It uses the files and options of OpenMVS, and COLMAP for poses.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The scripts run python3 and colmap. The programs load the image codecs of OpenCV when they first need them
# (libs/io/images/opencv_codecs.cpp). Debian's package has the name of the library: libopencv-imgcodecs406.
get_target_property(codecs opencv_imgcodecs IMPORTED_SONAME_RELEASE)
string(REGEX REPLACE "^(.+)_(.+)[.]so[.](.+)$" "\\1-\\2\\3" codecs "${codecs}")
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3, colmap, ${codecs}")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "snakemake, slurm-client")  # for axial-reconstruct --cluster
if(AXIAL_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-axialmvs)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The module axialmvs gives cameras behind flat and dome ports on arrays of
numpy, the files of AxialMVS, and its stages from photographs to a mesh.")
  axial_install_debian_files(python3-axialmvs python)
  # The module is for one version of Python.
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "${codecs}, python3-numpy, python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next})")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
endif()
include(CPack)
