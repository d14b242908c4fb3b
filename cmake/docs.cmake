# The documentation as a site: `cmake --build --preset release --target docs` leaves BUILD/docs/html/index.html.
# Doxygen lists the headers, stage.py lays out the pages and makes the reference, Sphinx sets them.
find_program(SPHINX_BUILD sphinx-build)
find_program(DOXYGEN doxygen)
find_program(ROPEWALK_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)  # the one that has Debian's Sphinx
if(SPHINX_BUILD AND DOXYGEN AND ROPEWALK_PYTHON AND TARGET ropewalk-calibrate)
  set(docs_build ${PROJECT_BINARY_DIR}/docs)
  configure_file(docs/site/Doxyfile.in ${docs_build}/Doxyfile @ONLY)
  add_custom_target(docs VERBATIM
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${docs_build}/html
    COMMAND ${CMAKE_COMMAND} -E make_directory ${docs_build}/html
    COMMAND ${DOXYGEN} ${docs_build}/Doxyfile
    COMMAND ${ROPEWALK_PYTHON} -B ${PROJECT_SOURCE_DIR}/docs/site/stage.py ${docs_build}/pages ${PROJECT_BINARY_DIR}
            ${docs_build}/api.tags
    COMMAND ${SPHINX_BUILD} -q -n -W --keep-going -d ${docs_build}/doctrees ${docs_build}/pages ${docs_build}/html
    COMMENT "Site in ${docs_build}/html/index.html")
  add_dependencies(docs ropewalk ropewalk-calibrate ropewalk-validate)
else()
  message(STATUS "The documentation as a site needs Sphinx and more. To have it: .ci/install documentation")
endif()
