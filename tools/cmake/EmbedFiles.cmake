# Run by the build as `cmake -DFOLDER=... -DFILES=a,b -DHEADER=... -DFUNCTION=... -DOUTPUT=... -P`: writes the C++ file
# that holds the files' text (insonate_embed in InsonateRoom.cmake).
# The standard guarantees 64 KiB for a raw string literal, more than any of these files should have.
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
