#include <catch2/catch.hpp>

#include "sim/imaging/simulator.h"
#include "sim/imaging/upload.h"
#include "tests/gl/test_context.h"
#include "tests/imaging/test_body.h"

using namespace insonate;
using namespace insonate::gl;

namespace {

int side_limit() {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limit);
  return limit;
}

}  // namespace

TEST_CASE("a texture that the device cannot hold is refused, and the next one is made as ever") {
  test::TestContext context;
  const int limit = side_limit();
  try {
    Texture::make_3d(GL_R8, limit + 1, 2, 2, Filter::nearest, Wrap::edge);
    FAIL("a side above the limit was taken");
  } catch (const TextureRefused& refused) {
    CHECK(refused.limit() == limit);
  }
  // Terabytes on a device with a large limit, and more than Mesa's software renderer allows for one texture.
  try {
    Texture::make_3d(GL_RGBA32F, limit, limit, limit, Filter::nearest, Wrap::edge);
    WARN("skipped: this driver finds memory when a texture is written");
    return;
  } catch (const TextureRefused& refused) {
    CHECK(refused.limit() == 0);
  }
  CHECK(glGetError() == GL_NO_ERROR);

  // OpenGL keeps the first error until it is read. An earlier error must not hide the lack of memory.
  glEnable(GL_RGBA);
  context.forget_errors();
  CHECK_THROWS_AS(Texture::make_3d(GL_RGBA32F, limit, limit, limit, Filter::nearest, Wrap::edge), TextureRefused);
  CHECK_NOTHROW(Texture::make_3d(GL_R8, 4, 4, 4, Filter::nearest, Wrap::edge));
}

TEST_CASE("more than shaders can have of the device is refused, and what fits is given") {
  const test::TestContext context;
  GLint64 limit = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limit);
  const std::size_t most = std::size_t(limit) / 16;
  CHECK_THROWS_WITH(TexelBuffer(GL_RGBA32F, most + 1), Catch::Contains("above the device's limit"));
  CHECK_THROWS_WITH(TexelBuffer(GL_R32F, std::size_t(-1) / 2), Catch::Contains("above the device's limit"));
  CHECK(bool(TexelBuffer(GL_RGBA32F, 1000)));
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("a volume that the device refuses leaves the simulator with the one before") {
  const test::TestContext context;
  const TissueTable table = read_tissue_table(INSONATE_ASSETS_FOLDER "/tissues.toml");
  Simulator simulator;
  simulator.set_volume(test::test_body(), table);
  simulator.set_probe(probes().front(), 160);
  const GLuint before = simulator.volume_texture().name();
  const glm::dmat4 place = simulator.texture_from_patient();
  simulator.image();
  const long runs = simulator.runs().front();

  AcousticVolume wide;
  wide.grid.size = {side_limit() + 1, 2, 2};
  wide.voxels.resize(wide.grid.count());
  CHECK_THROWS_AS(simulator.set_volume(wide, table), TextureRefused);
  CHECK(simulator.volume_texture().name() == before);
  CHECK(simulator.volume_texture().width() == test::test_body().grid.size.x + 2);
  CHECK(simulator.texture_from_patient() == place);
  simulator.image();
  CHECK(simulator.runs().front() == runs);
}

TEST_CASE("a CT that does not fit is refused with its file, the limit and what to do") {
  Grid grid;
  grid.size = {600, 512, 512};
  grid.spacing = {0.4, 0.4, 0.45};
  const auto refusal = [&](int limit) {
    try {
      upload_ct("thorax.nii.gz", grid, [&] { throw TextureRefused(600, 512, 512, limit); });
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  // The volume has one voxel of air on either side of each axis.
  CHECK(refusal(514) ==
        "thorax.nii.gz: 600 x 512 x 512 voxels of 0.4 x 0.4 x 0.45 mm are more than the 512 a side that the graphics "
        "card takes; resample it to at most 512 voxels along each axis, or crop it.");
  CHECK(refusal(0) ==
        "thorax.nii.gz: the graphics card has no memory for 600 x 512 x 512 voxels of 0.4 x 0.4 x 0.45 mm; resample it "
        "to larger voxels, or crop it.");
}
