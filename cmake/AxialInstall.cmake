# SPDX-License-Identifier: GPL-3.0-or-later
# cmake --install: programs, their man pages and documents (component "programs"); libraries, headers
# (not those of private/) and the CMake package AxialMVS (component "development"). cpack -G DEB makes
# a package of the programs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Programs.
install(TARGETS ${AXIAL_PROGRAMS} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs)
foreach(script reconstruct colmap-model)
  install(PROGRAMS apps/pipeline/${script} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs RENAME axial-${script})
endforeach()
# The package of these scripts, which they look for in this folder of the prefix.
install(DIRECTORY apps/pipeline/axial_pipeline DESTINATION share/axialmvs COMPONENT programs
  FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE)
install(FILES apps/pipeline/Snakefile DESTINATION share/axialmvs COMPONENT programs)
install(DIRECTORY apps/pipeline/profiles DESTINATION share/axialmvs COMPONENT programs)
install(FILES README.md LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs
  PATTERN "*.py" EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN paper EXCLUDE)

# Man pages, from --help.
find_program(AXIAL_HELP2MAN help2man)
mark_as_advanced(AXIAL_HELP2MAN)
if(AXIAL_HELP2MAN AND NOT AXIAL_SANITIZE)
  foreach(program IN LISTS AXIAL_PROGRAMS)
    set(page ${PROJECT_BINARY_DIR}/man/${program}.1)
    add_custom_command(OUTPUT ${page} DEPENDS ${program}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/man
      COMMAND ${AXIAL_HELP2MAN} --no-info --manual AxialMVS
        --name "program of AxialMVS, dense 3D reconstruction under water and in air"
        --output ${page} $<TARGET_FILE:${program}>
      COMMENT "Writing the man page of ${program}" VERBATIM)
    list(APPEND pages ${page})
  endforeach()
  add_custom_target(man ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT programs)
endif()

# Libraries.
set(include_dir ${CMAKE_INSTALL_INCLUDEDIR}/axialmvs)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/AxialMVS)
foreach(library IN LISTS AXIAL_LIBRARIES)
  set_target_properties(axial_${library} PROPERTIES EXPORT_NAME ${library})
  target_include_directories(axial_${library} INTERFACE $<INSTALL_INTERFACE:${include_dir}>)
  install(TARGETS axial_${library} EXPORT AxialMVSTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  if(library STREQUAL "refractive")
    set(headers refractive)
  else()
    set(headers libs/${library})
  endif()
  install(DIRECTORY ${headers} DESTINATION ${include_dir} COMPONENT development
    FILES_MATCHING PATTERN "*.h" PATTERN LICENSE PATTERN private EXCLUDE)
endforeach()
install(EXPORT AxialMVSTargets NAMESPACE Axial:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(cmake/AxialMVSConfig.cmake.in ${PROJECT_BINARY_DIR}/AxialMVSConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/AxialMVSConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/AxialMVSConfig.cmake ${PROJECT_BINARY_DIR}/AxialMVSConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT development)

# The Debian package.
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
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The scripts run python3 and colmap.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3, colmap")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "snakemake, slurm-client")  # for axial-reconstruct --cluster
include(CPack)
