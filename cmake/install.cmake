# Places of installed files: programs in bin, data in share/ropewalk, headers in include/ropewalk, and in lib the files
# of find_package(Ropewalk). Components: ropewalk (the simulator, its data, man pages, completions), calibrate (with
# validate), lammps (GPL-2), development, python (installed by mdem/python).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS ropewalk RUNTIME COMPONENT ropewalk)
install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/ropewalk COMPONENT ropewalk)
install(FILES README.md CHANGELOG.md LICENSE THIRD_PARTY.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT ropewalk)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/docs COMPONENT ropewalk PATTERN site EXCLUDE)
if(TARGET ropewalk-calibrate)
  install(TARGETS ropewalk-calibrate ropewalk-validate RUNTIME COMPONENT calibrate)
endif()
if(TARGET lmp-ropewalk)
  install(TARGETS lmp-ropewalk RUNTIME COMPONENT lammps)
  install(TARGETS ropewalk-lammps-plugin LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/ropewalk COMPONENT lammps)
endif()

# Each program writes its own man page and completions.
set(programs ropewalk)
if(TARGET ropewalk-calibrate)
  list(APPEND programs ropewalk-calibrate ropewalk-validate)
endif()
foreach(program ${programs})
  set(component ropewalk)
  if(NOT program STREQUAL ropewalk)
    set(component calibrate)
  endif()
  set(made ${CMAKE_CURRENT_BINARY_DIR}/made/${program})
  add_custom_command(OUTPUT ${made}.1 ${made}.bash ${made}.zsh ${made}.fish VERBATIM DEPENDS ${program}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/made
    COMMAND ${program} describe man > ${made}.1
    COMMAND ${program} describe bash > ${made}.bash
    COMMAND ${program} describe zsh > ${made}.zsh
    COMMAND ${program} describe fish > ${made}.fish)
  list(APPEND made_files ${made}.1)
  install(FILES ${made}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component})
  install(FILES ${made}.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program}
          COMPONENT ${component})
  install(FILES ${made}.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _${program}
          COMPONENT ${component})
  install(FILES ${made}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
          RENAME ${program}.fish COMPONENT ${component})
endforeach()
if(CMAKE_BUILD_TYPE STREQUAL Sanitize)
  add_custom_target(ropewalk_made_pages DEPENDS ${made_files})  # nothing is installed from there
else()
  add_custom_target(ropewalk_made_pages ALL DEPENDS ${made_files})
endif()

# The libraries, for programs of your own: Ropewalk::campaign brings all those below it, and Ropewalk::program has the whole
# of `ropewalk`, with its main().
set(libraries model sim observe io atoms report scene plan run campaign bench exchange cli commands program)
foreach(library ${libraries})
  set_target_properties(ropewalk_${library} PROPERTIES EXPORT_NAME ${library})
  list(APPEND library_targets ropewalk_${library})
endforeach()
set(config_directory ${CMAKE_INSTALL_LIBDIR}/cmake/Ropewalk)
install(TARGETS ${library_targets} EXPORT RopewalkTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/ropewalk
        COMPONENT development)
install(DIRECTORY mdem/ DESTINATION include/ropewalk COMPONENT development FILES_MATCHING PATTERN "*.hpp" REGEX "/model/.*\\.h$"
        PATTERN bench EXCLUDE PATTERN commands EXCLUDE PATTERN lammps EXCLUDE PATTERN python EXCLUDE)
install(EXPORT RopewalkTargets NAMESPACE Ropewalk:: DESTINATION ${config_directory} COMPONENT development)
set(ROPEWALK_INSTALLED_DATA ${CMAKE_INSTALL_DATADIR}/ropewalk)
configure_package_config_file(cmake/RopewalkConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/RopewalkConfig.cmake
  INSTALL_DESTINATION ${config_directory} PATH_VARS ROPEWALK_INSTALLED_DATA)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/RopewalkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/RopewalkConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/RopewalkConfigVersion.cmake
        cmake/installed_data.cpp DESTINATION ${config_directory} COMPONENT development)

# cpack -G DEB: a package for each component.
set(CPACK_PACKAGE_NAME ropewalk)
set(CPACK_PACKAGE_VENDOR "Ropewalk")
if(DEFINED ENV{DEBEMAIL})  # as for Debian's own tools
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
else()
  set(CPACK_PACKAGE_CONTACT "Ropewalk developers <ropewalk@localhost>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ROPEWALK_PACKAGE_NAME ropewalk)
set(CPACK_DEBIAN_CALIBRATE_PACKAGE_NAME ropewalk-calibrate)
set(CPACK_DEBIAN_LAMMPS_PACKAGE_NAME ropewalk-lammps)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libropewalk-dev)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-ropewalk)
set(CPACK_DEBIAN_CALIBRATE_PACKAGE_DEPENDS "ropewalk (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_LAMMPS_PACKAGE_DEPENDS "ropewalk (= ${PROJECT_VERSION}), openmpi-bin")  # not one rank starts without
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "ropewalk (= ${PROJECT_VERSION}), libeigen3-dev, libfmt-dev, nlohmann-json3-dev, libtomlplusplus-dev, libqhull-dev, zlib1g-dev")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "ropewalk (= ${PROJECT_VERSION}), python3-numpy")
if(Python3_VERSION_MAJOR)
  # An extension module is for one version of Python.
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    ", python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_minor})")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "ropewalk-calibrate")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_ROPEWALK_PACKAGE_RECOMMENDS "librsvg2-bin, lammps")
set(CPACK_DEBIAN_CALIBRATE_PACKAGE_RECOMMENDS "lammps, lammps-data")
include(CPack)
