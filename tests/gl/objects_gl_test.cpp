#include <catch2/catch.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include "sim/files/files.h"
#include "sim/gl/objects.h"
#include "sim/gl/program.h"
#include "sim/gl/streamed_buffer.h"
#include "tests/core/temporary_folder.h"
#include "tests/gl/test_context.h"

using namespace insonate;

TEST_CASE("a buffer of texels is kept where it has the size and format that are asked for") {
  const test::TestContext context;
  gl::TexelBuffer buffer;
  buffer.resize(GL_R32F, 4);
  const GLuint first = buffer.values().name();
  CHECK(first != 0);
  buffer.resize(GL_R32F, 4);
  CHECK(buffer.values().name() == first);
  buffer.resize(GL_R32F, 5);
  const GLuint longer = buffer.values().name();
  CHECK(longer != first);
  buffer.resize(GL_RG32F, 5);
  CHECK(buffer.values().name() != longer);
}

// Some drivers leave thin parts of a 3D texture as they were when asked to clear them.
TEST_CASE("a texture written inside has its margin on every side") {
  const test::TestContext context;
  constexpr int kWidth = 7, kHeight = 6, kDepth = 5;
  gl::Texture texture =
      gl::Texture::make_3d(GL_RG16_SNORM, kWidth, kHeight, kDepth, gl::Filter::linear, gl::Wrap::edge);
  texture.write(GL_RG, GL_SHORT, std::vector<std::int16_t>(std::size_t(2 * kWidth * kHeight * kDepth), 1).data());
  std::vector<std::array<std::int16_t, 2>> inside;
  for (int i = 0; i < (kWidth - 2) * (kHeight - 2) * (kDepth - 2); ++i)
    inside.push_back({std::int16_t(100 + i), std::int16_t(-100 - i)});
  texture.write_inside(GL_RG, GL_SHORT, inside.data(), {-1000, -6000});

  std::vector<std::array<std::int16_t, 2>> got(std::size_t(kWidth * kHeight * kDepth));
  texture.read(GL_RG, GL_SHORT, got.data(), got.size() * sizeof(got.front()));
  auto next = inside.begin();
  for (int z = 0; z < kDepth; ++z)
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool is_margin = x == 0 || y == 0 || z == 0 || x == kWidth - 1 || y == kHeight - 1 || z == kDepth - 1;
        const std::array<std::int16_t, 2> expected = is_margin ? std::array<std::int16_t, 2>{-1000, -6000} : *next++;
        INFO(x << ", " << y << ", " << z);
        CHECK(got[std::size_t((z * kHeight + y) * kWidth + x)] == expected);
      }
  CHECK(glGetError() == GL_NO_ERROR);
}

// Some drivers let a dispatch see what is written to its buffer while the dispatch is still waiting for its turn.
TEST_CASE("each dispatch sees what was streamed last before it") {
  const test::TestContext context;
  const TemporaryFolder folder;
  write_file(folder.path / "imaging/clutter_tail.comp", R"(
    layout(local_size_x = 64) in;
    layout(std140, binding = 0) uniform Given { int place, value; };
    layout(std430, binding = 0) buffer Kept { int kept[]; };
    void main() {
      int busy = 0;
      for (int i = 0; i < 1000; ++i) busy = (busy * 5 + value + i) & 1023;
      if (gl_GlobalInvocationID.x == 0) kept[place] = busy < 0 ? 0 : value;
    })");
  const gl::Program program(gl::ShaderSources(folder.path), {"imaging/clutter_tail.comp"});
  constexpr int kDispatches = 100;
  std::vector<int> kept(kDispatches, -1);
  const gl::Buffer buffer(kept.size() * sizeof(int), kept.data());
  gl::StreamedBuffer given;
  for (int i = 0; i < kDispatches; ++i) {
    const std::array<int, 4> parameters{i, 7 * i, 0, 0};
    given.write(parameters.data(), sizeof parameters);
    given.bind_uniform(0);
    buffer.bind_storage(0);
    program.dispatch(i % 10 == 0 ? 6400 : 64, 1);
  }
  buffer.read(kept.data(), kept.size() * sizeof(int));
  for (int i = 0; i < kDispatches; ++i) CHECK(kept[std::size_t(i)] == 7 * i);
  CHECK(given.storages() <= gl::StreamedBuffer::kMaxStorages);
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("what is streamed may grow and shrink") {
  const test::TestContext context;
  gl::StreamedBuffer streamed;
  for (const std::size_t count : {3, 1000, 2, 500, 2000}) {
    const std::vector<int> values(count, int(count));
    streamed.write(values.data(), values.size() * sizeof(int));
    streamed.bind_storage(0);
    GLint name = 0;
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 0, &name);
    std::vector<int> got(count);
    glGetNamedBufferSubData(GLuint(name), 0, GLsizeiptr(count * sizeof(int)), got.data());
    CHECK(got == values);
  }
}
