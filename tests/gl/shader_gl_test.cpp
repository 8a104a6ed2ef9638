// Tests shader files that are edited while the program runs, and the locations in their error messages.

#include <catch2/catch.hpp>

#include <array>
#include <filesystem>
#include <set>
#include <vector>

#include "sim/files/files.h"
#include "sim/gl/program.h"
#include "sim/imaging/simulator.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_body.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

/// A folder of shaders that differ from the program's own.
class EditedShaders {
public:
  ~EditedShaders() { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const { write_file(folder_ / name, text); }
  gl::ShaderSources read() const { return gl::ShaderSources(folder_); }

private:
  fs::path folder_ = fs::temp_directory_path() / ("insonate-shaders-" + std::to_string(::getpid()));
};

}  // namespace

TEST_CASE("a shader that does not build keeps the last good program and names file and line") {
  const test::TestContext context;
  const EditedShaders shaders;
  gl::Program program(shaders.read(), {"imaging/clutter_tail.comp"});
  const GLuint good = program.name();
  const auto reload = [&] { return gl::Program::reload(std::array{&program}, shaders.read()); };

  shaders.write("imaging/clutter_tail.comp",
                "layout(local_size_x = 1) in;\n#include \"shared/broken.glsl\"\nvoid main() {}\n");
  shaders.write("shared/broken.glsl", "// fine\nfloat a = undefined_name;\n");
  const auto problem = reload();
  REQUIRE(problem);
  INFO(*problem);
  CHECK(problem->find("undefined_name") != std::string::npos);
  CHECK(problem->find("10002") != std::string::npos);
  CHECK(problem->find("line 10001 is line 1 of shared/broken.glsl") != std::string::npos);
  CHECK(program.name() == good);

  shaders.write("shared/broken.glsl", "const float a = 1.0;\n");
  CHECK_FALSE(reload());
  CHECK(program.name() != good);
}

TEST_CASE("of programs that belong together none is taken when one does not build, and every problem is reported") {
  const test::TestContext context;
  const EditedShaders shaders;
  gl::Program first(shaders.read(), {"imaging/clutter.comp"}, {{"GROUP", "8"}, {"WAVES", "0"}}),
      second(shaders.read(), {"imaging/clutter_tail.comp"}), third(shaders.read(), {"imaging/maximum.comp"});
  const std::array programs = {&first, &second, &third};
  const auto names = [&] { return std::array{first.name(), second.name(), third.name()}; };
  const auto before = names();

  shaders.write("imaging/clutter.comp", "layout(local_size_x = 1) in;\nvoid main() {}\n");
  shaders.write("imaging/clutter_tail.comp", "no_shader;\n");
  shaders.write("imaging/maximum.comp", "none_either;\n");
  const auto problem = gl::Program::reload(programs, shaders.read());
  REQUIRE(problem);
  CHECK(problem->find("clutter_tail.comp does not compile") != std::string::npos);
  CHECK(problem->find("maximum.comp does not compile") != std::string::npos);
  CHECK(names() == before);

  for (const char* name : {"imaging/clutter_tail.comp", "imaging/maximum.comp"})
    shaders.write(name, "layout(local_size_x = 1) in;\nvoid main() {}\n");
  CHECK_FALSE(gl::Program::reload(programs, shaders.read()));
  for (std::size_t i = 0; i < before.size(); ++i) CHECK(names()[i] != before[i]);
}

TEST_CASE("a program goes back to defines it was built for without building, until its files change") {
  const test::TestContext context;
  const EditedShaders shaders;
  const auto write_shader = [&](const std::string& body) {
    shaders.write("imaging/clutter.comp", "layout(local_size_x = SIZE) in;\n" + body + "void main() {}\n");
  };
  const auto of_size = [](std::size_t size) { return gl::Defines{{"SIZE", std::to_string(size)}}; };
  write_shader("#if SIZE == 50\nundefined_name a;\n#endif\n");
  gl::Program program(shaders.read(), {"imaging/clutter.comp"}, of_size(1));
  std::vector<GLuint> names = {0, program.name()};
  for (std::size_t size = 2; size <= gl::Program::kMaxKept; ++size) {
    program.define(of_size(size));
    names.push_back(program.name());
  }
  CHECK(std::set(names.begin(), names.end()).size() == 1 + gl::Program::kMaxKept);

  for (const std::size_t size : {std::size_t(1), gl::Program::kMaxKept, std::size_t(2)}) {
    program.define(of_size(size));
    CHECK(program.name() == names[size]);
    GLint group[3] = {};
    glGetProgramiv(program.name(), GL_COMPUTE_WORK_GROUP_SIZE, group);
    CHECK(std::size_t(group[0]) == size);
  }
  CHECK_THROWS_AS(program.define(of_size(50)), std::runtime_error);
  CHECK(program.name() == names[2]);

  write_shader("undefined_name a;\n");  // does not affect a program that was built before
  program.define(of_size(51));          // replaces 3, which was used longest ago
  CHECK_FALSE(glIsProgram(names[3]));
  program.define(of_size(4));
  CHECK(program.name() == names[4]);

  write_shader("");
  REQUIRE_FALSE(gl::Program::reload(std::array{&program}, shaders.read()));
  CHECK_FALSE(glIsProgram(names[1]));  // built from the previous files
  CHECK_NOTHROW(program.define(of_size(50)));
}

TEST_CASE("a simulator whose shaders are being edited goes on with those it has, whatever is asked of it meanwhile") {
  const test::TestContext context;
  const EditedShaders shaders;
  const TissueTable tissues = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  const auto picture = [](gl::Simulator& simulator) { return simulator.read_stages().grey.pixels; };
  Settings settings = trainer_settings(3.5, 110);
  const auto make = [&](const gl::ShaderSources& sources) {
    gl::Simulator simulator(sources);
    simulator.set_volume(test::test_body(), tissues);
    simulator.set_probe(*find_probe("curvilinear"), 110);
    simulator.set_pose(test::on_the_skin(0, 9, 0));
    simulator.set_settings(settings);
    return simulator;
  };
  gl::Simulator edited = make(shaders.read());
  const std::vector<std::uint8_t> before = picture(edited);

  // One edit that would make the picture black, and one that does not compile.
  shaders.write("imaging/scan_convert.comp", "layout(local_size_x = 1) in;\nvoid main() {}\n");
  shaders.write("imaging/fuse.comp", "no_shader;\n");
  const auto problem = edited.reload(shaders.read());
  REQUIRE(problem);
  CHECK(problem->find("imaging/fuse.comp") != std::string::npos);
  const auto runs = edited.runs();
  CHECK(picture(edited) == before);
  CHECK(edited.runs() == runs);

  // Other window sizes, and effects that were off before: all of these are compile-time options.
  settings.image_width = 400;
  settings.image_height = 300;
  settings.electronic_noise = !settings.electronic_noise;
  settings.reverberation = !settings.reverberation;
  settings.slice_planes = 3;
  REQUIRE_NOTHROW(edited.set_settings(settings));
  const std::vector<std::uint8_t> other = picture(edited);
  gl::Simulator anew = make({});
  CHECK(other == picture(anew));
}
