# The Python package, where Python, numpy and pybind11 are. Debian's Python, unless Python3_EXECUTABLE names another one,
# since it is the one that has Debian's numpy and pybind11.
if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python3_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
if(Python3_FOUND)
  find_package(pybind11 QUIET CONFIG)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import numpy" RESULT_VARIABLE no_numpy ERROR_QUIET)
endif()
if(Python3_FOUND AND pybind11_FOUND AND NOT no_numpy)
  add_subdirectory(mdem/python)
elseif(ROPEWALK_PYTHON STREQUAL AUTO)
  message(STATUS "The Python package is not built. To have it: apt-get install pybind11-dev python3-dev python3-numpy")
else()
  message(FATAL_ERROR "The Python package needs pybind11, numpy and the headers of Python: apt-get install pybind11-dev "
                      "python3-dev python3-numpy")
endif()
