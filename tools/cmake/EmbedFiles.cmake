# Run by the build as `cmake -DFOLDER=... -DFILES=a,b -DHEADER=... -DFUNCTION=... -DOUTPUT=... -P`: writes the C++ file
# that holds the files' text (insonate_embed in InsonateRoom.cmake).
# The standard limits a raw string literal to 64 KiB; a file that long has other problems.
string(REPLACE "," ";" FILES "${FILES}")
set(cases "")
foreach(file IN LISTS FILES)
  file(READ "${FOLDER}/${file}" text)
  string(APPEND cases "  if (name == \"${file}\") return R\"embedded(${text})embedded\";\n")
endforeach()
file(WRITE "${OUTPUT}" "#include \"${HEADER}\"

std::string_view ${FUNCTION}(std::string_view name) {
${cases}  return {};
}
")
