# Runs after a test program is linked, and writes the file of its ctest entries: one for each suite, which saves the
# start of a process for each test. A suite whose name contains EACH has one entry for each test.
#
# ONLY, LONG, ROTATING: gtest filters, which may be empty. Tests that ONLY does not name have no entry. Those of LONG,
# and those of suites whose name ends in `Long`, get entries of their own with the labels `long` and `long-K`, K one of
# FIFTHS; all others have the label `short`. Those of ROTATING do a fifth of their work where the environment has
# ROPEWALK_FIFTH, and have the label `rotating` as well. TIMES is the file of usual times; ENVIRONMENT, which may be
# empty, is a variable for all entries.
cmake_minimum_required(VERSION 3.22)
include(${CMAKE_CURRENT_LIST_DIR}/test_part.cmake)

# Names of the tests that a filter names, as SUITE.TEST.
function(tests_of out filter)
  execute_process(COMMAND ${PROGRAM} --gtest_list_tests "--gtest_filter=${filter}" OUTPUT_VARIABLE listing
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE " *#[^\n]*" "" listing "${listing}")  # values of parameters and types, in any characters
  string(REGEX MATCHALL "[^\n]+" lines "${listing}")
  set(names "")
  set(suite "")
  foreach(line IN LISTS lines)
    if(line MATCHES "^([^ ].*\\.)$")
      set(suite ${CMAKE_MATCH_1})
    elseif(line MATCHES "^  (.+)$")
      list(APPEND names "${suite}${CMAKE_MATCH_1}")
    endif()
  endforeach()
  set(${out} "${names}" PARENT_SCOPE)
endfunction()

foreach(part ONLY LONG ROTATING)
  set(tests_${part} "")
  if(${part})
    tests_of(tests_${part} "${${part}}")
    if(NOT tests_${part})
      message(FATAL_ERROR "${PROGRAM}: the list ${part} of tests/CMakeLists.txt names no test: ${${part}}")
    endif()
  endif()
endforeach()
if(ONLY)
  set(all "${tests_ONLY}")
else()
  tests_of(all "*")
endif()
if(NOT all)
  message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()

# Entries in the order of the program, each with its tests.
set(order "")
foreach(test IN LISTS all)
  string(REGEX REPLACE "\\.[^.]*$" "" suite "${test}")
  set(part short)
  if(test IN_LIST tests_LONG OR suite MATCHES "Long(/|$)")
    set(part long)
  endif()
  set(entry "${LABEL}.${suite}")
  if(EACH AND suite MATCHES "${EACH}")
    set(entry "${LABEL}.${test}")
  elseif(test IN_LIST tests_ROTATING)
    set(entry "${LABEL}.${test}")
    set(part rotating)
  elseif(part STREQUAL long)
    string(APPEND entry ".Long")
  endif()
  if(test IN_LIST tests_ROTATING)
    set(part rotating)
  endif()
  if(NOT entry IN_LIST order)
    list(APPEND order "${entry}")
    set("part of ${entry}" ${part})
  endif()
  string(APPEND "tests of ${entry}" "${test}:")
endforeach()

set(entries "")
foreach(entry IN LISTS order)
  set(part "part of ${entry}")
  set(tests "tests of ${entry}")
  test_properties(properties "${entry}" "${LABEL}" "${${part}}" "${FIFTHS}" "${TIMES}" "${SLOWER}")
  string(APPEND entries "add_test([==[${entry}]==] [==[${MEASURE}]==] [==[${entry}]==] [==[${PROGRAM}]==] "
    "[==[--gtest_filter=${${tests}}]==])\n"
    "set_tests_properties([==[${entry}]==] PROPERTIES ${properties} ENVIRONMENT \"${ENVIRONMENT}\")\n")
endforeach()
file(WRITE ${OUTPUT} "${entries}")
