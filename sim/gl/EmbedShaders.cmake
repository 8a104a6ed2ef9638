# Run by the build as `cmake -DFOLDER=... -DFILES=a,b -DOUTPUT=... -P`: writes the C++ file that holds the shaders' text.
# Raw string literals are limited to 64 KiB by the standard; a shader that long has other problems.
string(REPLACE "," ";" FILES "${FILES}")
set(cases "")
foreach(file IN LISTS FILES)
  file(READ "${FOLDER}/${file}" text)
  string(APPEND cases "  if (name == \"${file}\") return R\"glsl(${text})glsl\";\n")
endforeach()
file(WRITE "${OUTPUT}" "#include \"sim/gl/embedded_shaders.h\"

namespace insonate::gl {

std::string_view embedded_shader(std::string_view name) {
${cases}  return {};
}

}  // namespace insonate::gl
")
