#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/gl/objects.h"

namespace insonate::gl {

/// Provides the text of the shaders: the embedded ones, or those of a folder as they were when it was read. Programs
/// built from one ShaderSources always match each other, however late they are built.
class ShaderSources {
public:
  static constexpr int kLinesPerFile = 10000;

  /// Returns the text of a shader, or an empty text for an unknown name.
  using Lookup = std::string_view (*)(std::string_view name);

  ShaderSources() = default;
  /// Takes the embedded shaders and, for names that these lack, the program's own.
  explicit ShaderSources(Lookup own) : own_(own) {}
  /// Takes files from `folder`, laid out as sim/shaders. Where a file does not exist there, takes the embedded one.
  explicit ShaderSources(const std::filesystem::path& folder);

  /// Returns a shader's text, with its `#include "shared/..."` lines replaced by those files. By #line, line n of file
  /// i has the number i * kLinesPerFile + n, because drivers drop the file number that #line takes as well. Throws
  /// std::runtime_error for an unknown name.
  /// @param files  receives the names in the order of their numbers
  std::string text(std::string_view name, std::vector<std::string>& files) const;

private:
  std::string_view load(std::string_view name) const;
  void expand(std::string_view name, std::string& text, std::vector<std::string>& files) const;

  std::shared_ptr<const std::map<std::string, std::string, std::less<>>> folder_texts_;  // by name
  Lookup own_ = nullptr;
};

/// Returns when the newest shader file of a folder was written; empty if there is none.
std::optional<std::filesystem::file_time_type> last_change(const std::filesystem::path& folder);

/// Lines put in front of a shader as `#define NAME VALUE`.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// Returns the value of a define for something that is on or off.
inline std::string flag(bool on) {
  return on ? "1" : "0";
}

struct ProgramKind {
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

/// A linked program that can be rebuilt from its sources while it is in use.
class Program {
public:
  Program() = default;
  /// Builds one compute shader, or a vertex and a fragment shader. The ending of each name gives the stage (.comp,
  /// .vert, .frag). Throws std::runtime_error with file, line and the compiler's message if that fails.
  Program(const ShaderSources& sources, std::vector<std::string> shaders, Defines defines = {});

  /// Rebuilds all `programs` from `sources`. If one fails, all keep their current programs and the compiler's messages
  /// are returned.
  static std::optional<std::string> reload(std::span<Program* const> programs, const ShaderSources& sources);

  /// Builds for other defines; does nothing if the program has these already. The kMaxKept variants used last are kept
  /// until the next reload(), so that a return to one is free. Any other takes as long as a new program, 50 to 200 ms
  /// with llvmpipe. Throws as the constructor does, and then keeps the current program.
  void define(const Defines& defines);
  static constexpr std::size_t kMaxKept = 16;

  void use() const { glUseProgram(name()); }
  GLint uniform(const char* name) const { return glGetUniformLocation(this->name(), name); }
  GLuint name() const { return variants_.empty() ? 0 : variants_.front().object.name(); }

  /// Runs a compute program over at least `x` by `y` by `z` invocations, in groups of its local size. It starts after
  /// all earlier reads of what it overwrites, and its results are visible to all later work. Throws std::runtime_error
  /// if the device does not accept that many groups.
  void dispatch(int x, int y, int z = 1) const;
  /// The same for a number of whole groups, each at least 1.
  void dispatch_groups(int x, int y = 1, int z = 1) const;

private:
  struct Variant {
    Defines defines;
    Object<ProgramKind> object;
    GLint group[3] = {1, 1, 1};
  };
  Variant build(Defines defines) const;

  ShaderSources sources_;
  std::vector<std::string> shaders_;
  std::vector<Variant> variants_;  ///< the one in use first, then the others by last use
};

}  // namespace insonate::gl
