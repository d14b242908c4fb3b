# Runs after a test program is linked, and writes the file of its ctest entries: one for each suite, which saves the
# start of a process for each test. A suite whose name contains EACH has one entry for each test. FILTER is the gtest
# filter of all entries, ENVIRONMENT a variable for them; both may be empty.
set(left_out "")
if(FILTER)
  set(left_out --gtest_filter=${FILTER})
endif()
execute_process(COMMAND ${PROGRAM} --gtest_list_tests ${left_out} OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " *#[^\n]*" "" listing "${listing}")  # values of parameters and types, in any characters
string(REGEX MATCHALL "[^\n]+" lines "${listing}")
string(REGEX MATCH "-.*" without "${FILTER}")

set(entries "")
function(add_entry name pattern)
  string(APPEND entries "add_test([==[${name}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${pattern}${without}]==])\n"
    "set_tests_properties([==[${name}]==] PROPERTIES LABELS ${LABEL} COST ${COST} TIMEOUT 3600 ENVIRONMENT \"${ENVIRONMENT}\")\n")
  set(entries "${entries}" PARENT_SCOPE)
endfunction()

foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ].*)\\.$")
    set(suite ${CMAKE_MATCH_1})
    set(each FALSE)
    if(EACH AND suite MATCHES "${EACH}")
      set(each TRUE)
    else()
      add_entry("${LABEL}.${suite}" "${suite}.*")
    endif()
  elseif(line MATCHES "^  (.+)$" AND each)
    add_entry("${LABEL}.${suite}.${CMAKE_MATCH_1}" "${suite}.${CMAKE_MATCH_1}")
  endif()
endforeach()
if(NOT entries)
  message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()
file(WRITE ${OUTPUT} "${entries}")
