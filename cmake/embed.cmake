# Writes OUTPUT, a C++ source file with the text of each entry of FILES ("name=path|name=path,path") as a constant `name`
# that HEADER declares.
# A name without a path gets an empty text. Several paths are modules of JavaScript that become one script: each stands before
# those that import from it, and the lines and words by which they import and export are left out.
file(WRITE "${OUTPUT}.new" "// Written by cmake/embed.cmake.\n#include \"${HEADER}\"\n\nnamespace ropewalk {\n\n")
string(REPLACE "|" ";" FILES "${FILES}")
foreach(entry ${FILES})
  string(REGEX MATCH "^([^=]*)=(.*)$" entry "${entry}")
  set(name "${CMAKE_MATCH_1}")
  string(REPLACE "," ";" paths "${CMAKE_MATCH_2}")
  list(LENGTH paths count)
  file(APPEND "${OUTPUT}.new" "const char* const ${name} =\n")
  foreach(path ${paths})
    file(READ "${path}" text)
    if(count GREATER 1)
      string(REGEX REPLACE "\nimport [^;]*;" "" text "\n${text}")
      string(REGEX REPLACE "\nexport " "\n" text "${text}")
    endif()
    file(APPEND "${OUTPUT}.new" "    R\"~~~~(${text})~~~~\"\n")
  endforeach()
  file(APPEND "${OUTPUT}.new" "    \"\";\n\n")
endforeach()
file(APPEND "${OUTPUT}.new" "}  // namespace ropewalk\n")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
