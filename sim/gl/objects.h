#pragma once

#include <epoxy/gl.h>
#include <glm/vec2.hpp>

#include <array>
#include <cstddef>
#include <initializer_list>
#include <stdexcept>
#include <utility>
#include <vector>

/// OpenGL's objects as move-only values. One owner deletes each of them, and the context that created it must be
/// current then.
namespace insonate::gl {

/// Owns the name of an OpenGL object; Kind::destroy() deletes it.
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

/// Owns bytes in the device's memory.
class Buffer {
public:
  Buffer() = default;
  /// Allocates storage of fixed size and fills it from `data` unless that is null. Throws std::invalid_argument for 0
  /// bytes, which OpenGL refuses, and DeviceRefused if the device has not enough memory.
  Buffer(std::size_t bytes, const void* data);

  /// Replaces the first `bytes` bytes, which the device must no longer read (StreamedBuffer).
  void write(const void* data, std::size_t bytes);
  /// Reads `bytes` bytes from `offset` on. Blocks until the device has finished.
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

/// The device cannot hold what was asked for; what() states how much that is, and the limit.
class DeviceRefused : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device does not accept a texture: a side is above its limit, or its memory does not suffice.
class TextureRefused : public DeviceRefused {
public:
  TextureRefused(int width, int height, int depth, int limit);
  /// Returns the longest side that the device accepts if a side is too long; 0 if memory does not suffice.
  int limit() const { return limit_; }

private:
  int limit_;
};

enum class Filter { nearest, linear };

/// What a texture returns outside [0, 1].
enum class Wrap { edge, repeat };

/// Owns a 2D or 3D texture with one level and immutable storage.
class Texture {
public:
  Texture() = default;

  /// Allocate a texture. Throw TextureRefused.
  /// @param format  sized internal format, such as GL_RGBA32F
  static Texture make_2d(GLenum format, int width, int height, Filter filter, Wrap wrap = Wrap::edge);
  /// Allocates an RGBA8 texture for a picture that is drawn to the screen. A software renderer stores it in the order
  /// of the screen's bytes where it can. It then draws it in a third of the time, and copies it to the screen as it is.
  static Texture make_picture(int width, int height, Filter filter);
  static Texture make_3d(GLenum format, int width, int height, int depth, Filter filter, Wrap wrap);

  /// Sets every texel to 0.
  void clear();
  /// Uploads all texels; `pixels` are tightly packed values of `type` in `layout` (GL_RG, GL_SHORT, ...). Throws
  /// TextureRefused, because some devices allocate memory only here.
  void write(GLenum layout, GLenum type, const void* pixels);
  /// The same from a buffer that shaders have written.
  void write(GLenum layout, GLenum type, const Buffer& pixels);
  /// The same for `count` slices of a 3D texture, from slice `first` on.
  void write_slices(GLenum layout, GLenum type, int first, int count, const Buffer& pixels);
  /// Uploads all of a 3D texture except a margin of one texel on every side, whose texels all become `margin`. Both are
  /// texels of `type` in `layout`.
  template <typename Texel>
  void write_inside(GLenum layout, GLenum type, const Texel* pixels, const Texel& margin) {
    write_inside(layout, type, pixels, std::vector<Texel>(largest_side(), margin).data());
  }
  /// Reads all texels back, tightly packed.
  void read(GLenum layout, GLenum type, void* pixels, std::size_t bytes) const;

  void bind(GLuint unit) const { glBindTextureUnit(unit, object_.name()); }
  void bind_image(GLuint unit, GLenum access) const;

  int width() const { return width_; }
  int height() const { return height_; }
  int depth() const { return depth_; }
  /// Returns the device memory that the texture takes, in bytes, from the channel sizes that the device reports.
  std::size_t bytes() const;
  GLuint name() const { return object_.name(); }
  explicit operator bool() const { return bool(object_); }

private:
  enum class Storage { immutable, of_screen };
  static Texture make(GLenum target, GLenum format, int width, int height, int depth, Filter filter, Wrap wrap,
                      Storage storage = Storage::immutable);
  void write_inside(GLenum layout, GLenum type, const void* pixels, const void* side);
  std::size_t largest_side() const;  // texels of the largest face of a 3D texture

  Object<TextureKind> object_;
  GLenum format_ = 0;
  int width_ = 0, height_ = 0, depth_ = 0;
};

/// Owns a table, or the data that one stage passes to the next: shaders write it as a buffer and read it as texels
/// (samplerBuffer). This is fastest on a software renderer: storing to an image takes several times as long, and
/// reading values of a buffer, or texels of a texture, takes longer than reading these texels.
class TexelBuffer {
public:
  TexelBuffer() = default;
  /// Allocates `texels` texels and fills them from `values` unless that is null. Throws DeviceRefused if they are more
  /// than the device allows shaders, or its memory does not suffice.
  /// @param format  GL_R16, GL_R32F, GL_R32UI, GL_RG16, GL_RG16F, GL_RG32F, GL_RG32I, GL_RGBA16, GL_RGBA16F, GL_RGBA32F
  /// or
  ///                GL_RGBA32I
  TexelBuffer(GLenum format, std::size_t texels, const void* values = nullptr);

  void bind(GLuint unit) const { glBindTextureUnit(unit, texture_.name()); }
  void bind_storage(GLuint binding) const { buffer_.bind_storage(binding); }
  const Buffer& values() const { return buffer_; }
  void clear() { buffer_.clear(); }
  void read(void* values, std::size_t bytes) const { buffer_.read(values, bytes); }
  explicit operator bool() const { return bool(texture_); }

  /// Becomes a buffer of so many texels, with whatever values it has. Keeps the one that it is if that has the format
  /// and the number already: a device takes longer to allocate than to clear.
  void resize(GLenum format, std::size_t texels);

private:
  Buffer buffer_;
  Object<TextureKind> texture_;
  GLenum format_ = 0;
  std::size_t texels_ = 0;
};

struct FramebufferKind {
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};

/// Binds textures as the target of drawing.
class Framebuffer {
public:
  Framebuffer() = default;
  /// @param colour  must outlive the framebuffer
  explicit Framebuffer(const Texture& colour);
  /// Binds several textures of one size; a fragment shader's output i goes to the i-th.
  explicit Framebuffer(std::initializer_list<const Texture*> colours);
  int width() const { return width_; }
  /// Binds the framebuffer and sets the viewport to all of it.
  void bind() const;
  /// Copies the texels from `first` to before `end` to the same places of a framebuffer of the same size; 0 is the
  /// window's.
  void copy_to(GLuint framebuffer, glm::ivec2 first, glm::ivec2 end) const;

private:
  Object<FramebufferKind> object_;
  int width_ = 0, height_ = 0;
};

struct VertexArrayKind {
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};

/// Draws a triangle that covers the viewport. The vertex shader makes its corners from gl_VertexID.
class FullScreenTriangle {
public:
  FullScreenTriangle();
  void draw() const;

private:
  Object<VertexArrayKind> object_;
};

/// Draws points without data: the vertex shader makes their places from gl_VertexID.
class Points {
public:
  Points();
  /// @param size_px  side of the square that each point covers, 1 to 255
  void draw(int count, float size_px) const;

private:
  Object<VertexArrayKind> object_;
};

struct QueryKind {
  static void destroy(GLuint name) { glDeleteQueries(1, &name); }
};

/// Measures how long the device takes for the work between begin() and end().
///
/// It uses two time stamps with a flush behind the first. Mesa's software renderer draws tile by tile, and its
/// elapsed-time query covers only the last tile.
class Timer {
public:
  Timer();
  void begin() {
    glQueryCounter(begin_.name(), GL_TIMESTAMP);
    glFlush();
  }
  void end() { glQueryCounter(end_.name(), GL_TIMESTAMP); }
  /// Returns the time in milliseconds. Blocks until the device has finished.
  double milliseconds() const;

private:
  Object<QueryKind> begin_, end_;
};

}  // namespace insonate::gl
