# Writes OUTPUT, a C++ source file that registers the texts of cases: FILES ("path|path"), named from FOLDER on.
file(WRITE "${OUTPUT}.new" "// Written by validate/embed_texts.cmake.\n#include \"core/case_text.hpp\"\n\n"
  "namespace ropewalk::validate {\nnamespace {\n\nconst RegisteredText texts[] = {\n")
string(REPLACE "|" ";" FILES "${FILES}")
foreach(path ${FILES})
  file(READ "${path}" text)
  file(RELATIVE_PATH name "${FOLDER}" "${path}")
  file(APPEND "${OUTPUT}.new" "    {\"${name}\", R\"~~~~(${text})~~~~\"},\n")
endforeach()
file(APPEND "${OUTPUT}.new" "};\n\n}  // namespace\n}  // namespace ropewalk::validate\n")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
