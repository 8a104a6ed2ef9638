#include "sim/gl/objects.h"

#include <algorithm>
#include <string>
#include <vector>

namespace insonate::gl {
namespace {

Object<VertexArrayKind> empty_vertex_array() {
  GLuint name = 0;
  glCreateVertexArrays(1, &name);
  return Object<VertexArrayKind>(name);
}

std::string why_refused(int width, int height, int depth, int limit) {
  const std::string texture =
      "a texture of " + std::to_string(width) + " x " + std::to_string(height) + " x " + std::to_string(depth);
  return limit > 0 ? texture + " is above the device's limit of " + std::to_string(limit)
                   : "the device has no memory for " + texture;
}

// Errors reported so far do not concern the next call. A lost context reports errors without end, hence the limit.
void forget_errors() {
  for (int i = 0; i < 100 && glGetError() != GL_NO_ERROR; ++i) {
  }
}

// Returns the bytes per texel of the formats that TexelBuffer's constructor lists.
std::size_t texel_bytes(GLenum format) {
  switch (format) {
    case GL_R16:
      return 2;
    case GL_RG32F:
    case GL_RG32I:
    case GL_RGBA16:
    case GL_RGBA16F:
      return 8;
    case GL_RGBA32F:
    case GL_RGBA32I:
      return 16;
    default:
      return 4;
  }
}

bool out_of_memory() {
  return glGetError() == GL_OUT_OF_MEMORY;
}

// Lets what shaders have written to a buffer be copied to a texture. OpenGL asks for GL_PIXEL_BUFFER_BARRIER_BIT alone.
// With only that, NVIDIA's driver 580 on an H100 copied what the buffer held before.
void order_copy_after_writes() {
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

}  // namespace

TextureRefused::TextureRefused(int width, int height, int depth, int limit)
    : DeviceRefused(why_refused(width, height, depth, limit)), limit_(limit) {}

Buffer::Buffer(std::size_t bytes, const void* data) {
  if (bytes == 0) throw std::invalid_argument("a buffer of no bytes");
  GLuint name = 0;
  glCreateBuffers(1, &name);
  object_ = Object<BufferKind>(name);
  forget_errors();
  glNamedBufferStorage(name, GLsizeiptr(bytes), data, GL_DYNAMIC_STORAGE_BIT);
  if (out_of_memory()) throw DeviceRefused("the device has no memory for " + std::to_string(bytes) + " bytes more");
}

void Buffer::write(const void* data, std::size_t bytes) {
  glNamedBufferSubData(object_.name(), 0, GLsizeiptr(bytes), data);
}

void Buffer::read(void* data, std::size_t bytes, std::size_t offset) const {
  glGetNamedBufferSubData(object_.name(), GLintptr(offset), GLsizeiptr(bytes), data);
}

void Buffer::clear() {
  glClearNamedBufferData(object_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

Texture Texture::make(GLenum target, GLenum format, int width, int height, int depth, Filter filter, Wrap wrap,
                      Storage storage) {
  GLint limit = 0;
  glGetIntegerv(target == GL_TEXTURE_3D ? GL_MAX_3D_TEXTURE_SIZE : GL_MAX_TEXTURE_SIZE, &limit);
  if (std::max({width, height, depth}) > limit) throw TextureRefused(width, height, depth, limit);
  Texture texture;
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  texture.object_ = Object<TextureKind>(name);
  texture.format_ = format;
  texture.width_ = width;
  texture.height_ = height;
  texture.depth_ = depth;
  forget_errors();
  if (storage == Storage::of_screen) {
    // Only mutable storage has an order of bytes: that of the pixels which it is given first.
    GLint bound = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width, height, 0, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, nullptr);
    glBindTexture(GL_TEXTURE_2D, GLuint(bound));
  } else if (target != GL_TEXTURE_2D) {
    glTextureStorage3D(name, 1, format, width, height, depth);
  } else {
    glTextureStorage2D(name, 1, format, width, height);
  }
  if (out_of_memory()) throw TextureRefused(width, height, depth, 0);
  const GLint gl_filter = filter == Filter::linear ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, gl_filter);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, gl_filter);
  const GLint gl_wrap = wrap == Wrap::edge ? GL_CLAMP_TO_EDGE : GL_REPEAT;
  for (GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(name, axis, gl_wrap);
  return texture;
}

Texture Texture::make_2d(GLenum format, int width, int height, Filter filter, Wrap wrap) {
  return make(GL_TEXTURE_2D, format, width, height, 1, filter, wrap);
}

Texture Texture::make_picture(int width, int height, Filter filter) {
  return make(GL_TEXTURE_2D, GL_RGBA8, width, height, 1, filter, Wrap::edge, Storage::of_screen);
}

Texture Texture::make_3d(GLenum format, int width, int height, int depth, Filter filter, Wrap wrap) {
  return make(GL_TEXTURE_3D, format, width, height, depth, filter, wrap);
}

void Texture::write(GLenum layout, GLenum type, const void* pixels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  GLint target = 0;
  glGetTextureParameteriv(object_.name(), GL_TEXTURE_TARGET, &target);
  forget_errors();
  if (GLenum(target) != GL_TEXTURE_2D)
    glTextureSubImage3D(object_.name(), 0, 0, 0, 0, width_, height_, depth_, layout, type, pixels);
  else
    glTextureSubImage2D(object_.name(), 0, 0, 0, width_, height_, layout, type, pixels);
  if (out_of_memory()) throw TextureRefused(width_, height_, depth_, 0);
}

void Texture::write(GLenum layout, GLenum type, const Buffer& pixels) {
  order_copy_after_writes();
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, pixels.name());
  write(layout, type, static_cast<const void*>(nullptr));
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

void Texture::write_slices(GLenum layout, GLenum type, int first, int count, const Buffer& pixels) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  forget_errors();
  order_copy_after_writes();
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, pixels.name());
  glTextureSubImage3D(object_.name(), 0, 0, 0, first, width_, height_, count, layout, type, nullptr);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  if (out_of_memory()) throw TextureRefused(width_, height_, depth_, 0);
}

std::size_t Texture::largest_side() const {
  const auto area = [](int a, int b) { return std::size_t(a) * std::size_t(b); };
  return std::max({area(width_, height_), area(height_, depth_), area(width_, depth_)});
}

// Not by glClearTexSubImage: NVIDIA's driver 580 leaves such thin parts of a 3D texture as they were. Nor from floats,
// which it does not round to the nearest whole number.
void Texture::write_inside(GLenum layout, GLenum type, const void* pixels, const void* side) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  forget_errors();
  const auto write = [&](int x, int y, int z, int width, int height, int depth, const void* texels) {
    glTextureSubImage3D(object_.name(), 0, x, y, z, width, height, depth, layout, type, texels);
  };
  write(0, 0, 0, 1, height_, depth_, side);
  write(width_ - 1, 0, 0, 1, height_, depth_, side);
  write(0, 0, 0, width_, 1, depth_, side);
  write(0, height_ - 1, 0, width_, 1, depth_, side);
  write(0, 0, 0, width_, height_, 1, side);
  write(0, 0, depth_ - 1, width_, height_, 1, side);
  write(1, 1, 1, width_ - 2, height_ - 2, depth_ - 2, pixels);
  if (out_of_memory()) throw TextureRefused(width_, height_, depth_, 0);
}

void Texture::clear() {
  glClearTexImage(object_.name(), 0, GL_RED, GL_FLOAT, nullptr);
}

void Texture::read(GLenum layout, GLenum type, void* pixels, std::size_t bytes) const {
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(object_.name(), 0, layout, type, GLsizei(bytes), pixels);
}

std::size_t Texture::bytes() const {
  if (!object_) return 0;
  int bits = 0;
  for (const GLenum channel :
       {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE, GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE}) {
    int size = 0;
    glGetTextureLevelParameteriv(object_.name(), 0, channel, &size);
    bits += size;
  }
  return std::size_t(width_) * std::size_t(height_) * std::size_t(depth_) * std::size_t(bits) / 8;
}

void Texture::bind_image(GLuint unit, GLenum access) const {
  glBindImageTexture(unit, object_.name(), 0, GL_TRUE, 0, access, format_);  // all slices of a 3D texture
}

TexelBuffer::TexelBuffer(GLenum format, std::size_t texels, const void* values) : format_(format), texels_(texels) {
  const std::size_t bytes = texel_bytes(format);
  GLint64 most_bytes = 0;
  GLint most_texels = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most_bytes);
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most_texels);
  const std::size_t most = std::min(std::size_t(most_bytes) / bytes, std::size_t(most_texels));
  if (texels > most)
    throw DeviceRefused(std::to_string(texels) + " samples or pixels are above the device's limit of " +
                        std::to_string(most));
  buffer_ = Buffer(texels * bytes, values);
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
  texture_ = Object<TextureKind>(name);
  glTextureBuffer(name, format, buffer_.name());
}

void TexelBuffer::resize(GLenum format, std::size_t texels) {
  if (!texture_ || format != format_ || texels != texels_) *this = TexelBuffer(format, texels);
}

Framebuffer::Framebuffer(const Texture& colour) : Framebuffer({&colour}) {}

Framebuffer::Framebuffer(std::initializer_list<const Texture*> colours)
    : width_((*colours.begin())->width()), height_((*colours.begin())->height()) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  object_ = Object<FramebufferKind>(name);
  std::vector<GLenum> outputs;
  for (const Texture* colour : colours) {
    outputs.push_back(GL_COLOR_ATTACHMENT0 + GLenum(outputs.size()));
    glNamedFramebufferTexture(name, outputs.back(), colour->name(), 0);
  }
  glNamedFramebufferDrawBuffers(name, GLsizei(outputs.size()), outputs.data());
}

void Framebuffer::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, object_.name());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::copy_to(GLuint framebuffer, glm::ivec2 first, glm::ivec2 end) const {
  glBlitNamedFramebuffer(object_.name(), framebuffer, first.x, first.y, end.x, end.y, first.x, first.y, end.x, end.y,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

FullScreenTriangle::FullScreenTriangle() : object_(empty_vertex_array()) {}

void FullScreenTriangle::draw() const {
  glBindVertexArray(object_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

Points::Points() : object_(empty_vertex_array()) {}

void Points::draw(int count, float size_px) const {
  glPointSize(size_px);
  glBindVertexArray(object_.name());
  glDrawArrays(GL_POINTS, 0, count);
  glBindVertexArray(0);
  glPointSize(1);
}

Timer::Timer() {
  GLuint names[2] = {};
  glCreateQueries(GL_TIMESTAMP, 2, names);
  begin_ = Object<QueryKind>(names[0]);
  end_ = Object<QueryKind>(names[1]);
}

double Timer::milliseconds() const {
  GLuint64 begin = 0, end = 0;
  glGetQueryObjectui64v(begin_.name(), GL_QUERY_RESULT, &begin);
  glGetQueryObjectui64v(end_.name(), GL_QUERY_RESULT, &end);
  return double(end - begin) * 1e-6;
}

}  // namespace insonate::gl
