#pragma once

#include <epoxy/gl.h>

#include <array>
#include <cstddef>
#include <stdexcept>
#include <utility>

/// OpenGL's objects as move-only values: each is deleted by its one owner, with the context it was made in current.
namespace insonate::gl {

/// The name of an OpenGL object and how to delete it.
template <typename Kind>
class Object {
public:
  Object() = default;
  explicit Object(GLuint name) : name_(name) {}
  Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  ~Object() {
    if (name_) Kind::destroy(name_);
  }
  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

private:
  GLuint name_ = 0;
};

struct BufferKind {
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};

/// Bytes on the device.
class Buffer {
public:
  Buffer() = default;
  /// Storage of fixed size, filled from `data` when there is any. Throws std::invalid_argument for no bytes, which
  /// OpenGL refuses, and DeviceRefused when the device has no memory for as many.
  Buffer(std::size_t bytes, const void* data);

  /// Replaces the first `bytes` bytes.
  void write(const void* data, std::size_t bytes);
  /// Reads `bytes` bytes from `offset` on. Waits for the device.
  void read(void* data, std::size_t bytes, std::size_t offset = 0) const;
  /// Sets every byte to 0.
  void clear();
  void bind_uniform(GLuint binding) const { glBindBufferBase(GL_UNIFORM_BUFFER, binding, object_.name()); }
  void bind_storage(GLuint binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, object_.name()); }
  GLuint name() const { return object_.name(); }

private:
  Object<BufferKind> object_;
};

struct TextureKind {
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};

/// The device does not hold what it was asked to; what() says how much that is, and the limit.
class DeviceRefused : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device does not take a texture: a side is above its limit, or it has no memory for it.
class TextureRefused : public DeviceRefused {
public:
  TextureRefused(int width, int height, int depth, int limit);
  /// The longest side that the device takes, when that is what is wrong; 0 when it is the memory.
  int limit() const { return limit_; }

private:
  int limit_;
};

enum class Filter { nearest, linear };

/// What a texture gives outside [0, 1].
enum class Wrap { edge, repeat };

/// A 2D or 3D texture with one level and immutable storage.
class Texture {
public:
  Texture() = default;

  /// Throws TextureRefused.
  /// @param format  sized internal format, such as GL_RGBA32F
  static Texture make_2d(GLenum format, int width, int height, Filter filter, Wrap wrap = Wrap::edge);
  static Texture make_3d(GLenum format, int width, int height, int depth, Filter filter, Wrap wrap);

  /// Sets everything to 0.
  void clear();
  /// Uploads everything; `pixels` are tightly packed values of `type` in `layout` (GL_RG, GL_SHORT, ...). Throws
  /// TextureRefused: a device may look for memory no sooner than here.
  void write(GLenum layout, GLenum type, const void* pixels);
  /// The same from a buffer that shaders have written.
  void write(GLenum layout, GLenum type, const Buffer& pixels);
  /// Some slices of a 3D texture from such a buffer.
  void write_slices(GLenum layout, GLenum type, int first, int count, const Buffer& pixels);
  /// The same as write() for all of a 3D texture but a margin of one texel on every side, which becomes `margin`
  /// (RGBA).
  void write_inside(GLenum layout, GLenum type, const void* pixels, const std::array<float, 4>& margin);
  /// Reads everything back, tightly packed.
  void read(GLenum layout, GLenum type, void* pixels, std::size_t bytes) const;

  void bind(GLuint unit) const { glBindTextureUnit(unit, object_.name()); }
  void bind_image(GLuint unit, GLenum access) const;
  /// The same texels in another format of as many bytes, such as GL_R32UI for GL_RGBA8: of a 2D texture. It may outlive
  /// this one.
  Texture seen_as(GLenum format) const;

  int width() const { return width_; }
  int height() const { return height_; }
  int depth() const { return depth_; }
  /// What it takes of the device's memory, as the device tells of the format that it chose.
  std::size_t bytes() const;
  GLuint name() const { return object_.name(); }
  explicit operator bool() const { return bool(object_); }

private:
  static Texture make(GLenum target, GLenum format, int width, int height, int depth, Filter filter, Wrap wrap);

  Object<TextureKind> object_;
  GLenum format_ = 0;
  int width_ = 0, height_ = 0, depth_ = 0;
};

/// A table, or what one stage hands to the next: written as values of a buffer, read as texels of it (samplerBuffer).
/// That is how a software renderer is fastest: storing to an image takes it several times as long, and gathering values
/// or a texture's texels takes longer than gathering these.
class TexelBuffer {
public:
  TexelBuffer() = default;
  /// So many texels, filled from `values` when there are any. Throws std::runtime_error when shaders cannot have that
  /// many on the device, or it has no memory for them.
  /// @param format  GL_R16, GL_R32F, GL_R32UI, GL_RG16, GL_RG16F, GL_RG32F, GL_RGBA16, GL_RGBA16F, GL_RGBA32F or
  ///                GL_RGBA32I
  TexelBuffer(GLenum format, std::size_t texels, const void* values = nullptr);

  void bind(GLuint unit) const { glBindTextureUnit(unit, texture_.name()); }
  void bind_storage(GLuint binding) const { buffer_.bind_storage(binding); }
  const Buffer& values() const { return buffer_; }
  void clear() { buffer_.clear(); }
  void read(void* values, std::size_t bytes) const { buffer_.read(values, bytes); }
  explicit operator bool() const { return bool(texture_); }

private:
  Buffer buffer_;
  Object<TextureKind> texture_;
};

struct FramebufferKind {
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};

/// A texture to draw into.
class Framebuffer {
public:
  Framebuffer() = default;
  /// @param colour  outlives the framebuffer
  explicit Framebuffer(const Texture& colour);
  /// Binds it and sets the viewport to the whole of it.
  void bind() const;

private:
  Object<FramebufferKind> object_;
  int width_ = 0, height_ = 0;
};

struct VertexArrayKind {
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};

/// Draws a triangle that covers the viewport; the vertex shader makes its corners from gl_VertexID.
class FullScreenTriangle {
public:
  FullScreenTriangle();
  void draw() const;

private:
  Object<VertexArrayKind> object_;
};

struct QueryKind {
  static void destroy(GLuint name) { glDeleteQueries(1, &name); }
};

/// Times what the device does between begin() and end().
///
/// By two time stamps with a flush behind the first: Mesa's software renderer draws tile by tile, and its elapsed-time
/// query knows only the last tile.
class Timer {
public:
  Timer();
  void begin() {
    glQueryCounter(begin_.name(), GL_TIMESTAMP);
    glFlush();
  }
  void end() { glQueryCounter(end_.name(), GL_TIMESTAMP); }
  /// Waits for the device. Milliseconds.
  double milliseconds() const;

private:
  Object<QueryKind> begin_, end_;
};

}  // namespace insonate::gl
