# SPDX-License-Identifier: Apache-2.0
# cmake -DOUT=FILE -DFOLDER=DIR -DEXTENSION=EXT -P embed_text.cmake
# Writes every DIR/*.EXT as { "stem", "text" } rows. One literal a line: compilers bound the length of one literal.
file(GLOB files ${FOLDER}/*.${EXTENSION})
list(SORT files)
set(rows "")
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME_WE)
  file(READ ${file} text)
  string(REPLACE "\r" "" text "${text}")
  string(REPLACE "\\" "\\\\" text "${text}")
  string(REPLACE "\"" "\\\"" text "${text}")
  string(REPLACE "\n" "\\n\"\n   \"" text "${text}")
  string(APPEND rows "  {\"${name}\",\n   \"${text}\"},\n")
endforeach()
file(WRITE ${OUT} "${rows}")
