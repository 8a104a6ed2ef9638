// Shader files: edited while the program runs, and named where they are wrong.

#include <catch2/catch.hpp>

#include <filesystem>

#include "sim/core/files.h"
#include "sim/gl/headless_context.h"
#include "sim/gl/program.h"

using namespace insonate;
namespace fs = std::filesystem;

TEST_CASE("a shader that does not build keeps the last good program and names file and line") {
  const gl::HeadlessContext context;
  const fs::path folder = fs::temp_directory_path() / ("insonate-shaders-" + std::to_string(::getpid()));
  const gl::ShaderSources sources(folder);
  gl::Program program(sources, {"clutter.comp"});
  const GLuint good = program.name();

  write_file(folder / "clutter.comp",
             "layout(local_size_x = 1) in;\n#include \"shared/broken.glsl\"\nvoid main() {}\n");
  write_file(folder / "shared" / "broken.glsl", "// fine\nfloat a = undefined_name;\n");
  const auto problem = program.reload(sources);
  REQUIRE(problem);
  INFO(*problem);
  CHECK(problem->find("undefined_name") != std::string::npos);
  CHECK(problem->find("10002") != std::string::npos);
  CHECK(problem->find("line 10001 is line 1 of shared/broken.glsl") != std::string::npos);
  CHECK(program.name() == good);

  write_file(folder / "shared" / "broken.glsl", "const float a = 1.0;\n");
  CHECK_FALSE(program.reload(sources));
  CHECK(program.name() != good);
  fs::remove_all(folder);
}
