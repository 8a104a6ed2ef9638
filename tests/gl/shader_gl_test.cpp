// Shader files: edited while the program runs, and named where they are wrong.

#include <catch2/catch.hpp>

#include <filesystem>
#include <set>

#include "sim/core/files.h"
#include "sim/gl/program.h"
#include "tests/gl/test_context.h"

using namespace insonate;
namespace fs = std::filesystem;

TEST_CASE("a shader that does not build keeps the last good program and names file and line") {
  const test::TestContext context;
  const fs::path folder = fs::temp_directory_path() / ("insonate-shaders-" + std::to_string(::getpid()));
  const gl::ShaderSources sources(folder);
  gl::Program program(sources, {"clutter_tail.comp"});
  const GLuint good = program.name();

  write_file(folder / "clutter_tail.comp",
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

TEST_CASE("a program goes back to defines it was built for without building, until its files change") {
  const test::TestContext context;
  const fs::path folder = fs::temp_directory_path() / ("insonate-variants-" + std::to_string(::getpid()));
  const auto write_shader = [&](const std::string& body) {
    write_file(folder / "clutter.comp", "layout(local_size_x = SIZE) in;\n" + body + "void main() {}\n");
  };
  const auto of_size = [](std::size_t size) { return gl::Defines{{"SIZE", std::to_string(size)}}; };
  write_shader("");
  const gl::ShaderSources sources(folder);
  gl::Program program(sources, {"clutter.comp"}, of_size(1));
  std::set<GLuint> names = {program.name()};
  for (std::size_t size = 2; size <= gl::Program::kMostKept; ++size) {
    program.define(sources, of_size(size));
    names.insert(program.name());
  }
  CHECK(names.size() == gl::Program::kMostKept);

  write_shader("undefined_name a;\n");  // nothing can be built any more
  for (const std::size_t size : {std::size_t(1), gl::Program::kMostKept, std::size_t(2)}) {
    CHECK_NOTHROW(program.define(sources, of_size(size)));
    GLint group[3] = {};
    glGetProgramiv(program.name(), GL_COMPUTE_WORK_GROUP_SIZE, group);
    CHECK(std::size_t(group[0]) == size);
  }
  const GLuint second = program.name();
  CHECK_THROWS_AS(program.define(sources, of_size(50)), std::runtime_error);
  CHECK(program.name() == second);

  write_shader("");
  program.define(sources, of_size(50));  // which takes the place of 3, used longest ago
  write_shader("undefined_name a;\n");
  CHECK_THROWS_AS(program.define(sources, of_size(3)), std::runtime_error);
  CHECK_NOTHROW(program.define(sources, of_size(4)));

  write_shader("");
  REQUIRE_FALSE(program.reload(sources));
  write_shader("undefined_name a;\n");
  CHECK_THROWS_AS(program.define(sources, of_size(1)), std::runtime_error);  // built from the files before
  fs::remove_all(folder);
}
