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

/// The text of the project's shaders: those embedded in the program, or those of a folder while one is being edited, as
/// they were when it was read. What is built from the same sources, however much later, fits together.
class ShaderSources {
public:
  static constexpr int kLinesPerFile = 10000;

  /// Returns the text of a shader, or an empty one for a name that it does not know.
  using Lookup = std::string_view (*)(std::string_view name);

  ShaderSources() = default;
  /// The embedded shaders, and those of a program that has some of its own.
  explicit ShaderSources(Lookup own) : own_(own) {}
  /// Takes files from `folder` (laid out as sim/shaders) where they exist there, else the embedded ones.
  explicit ShaderSources(const std::filesystem::path& folder);

  /// A shader with its `#include "shared/..."` lines replaced by those files. The first line of file number i is given
  /// the line number i * kLinesPerFile + 1 by #line, because drivers drop the source number that #line also takes.
  /// Throws std::runtime_error when there is no such shader.
  /// @param files  receives the names in the order of their numbers
  std::string text(std::string_view name, std::vector<std::string>& files) const;

private:
  std::string_view load(std::string_view name) const;
  void expand(std::string_view name, std::string& text, std::vector<std::string>& files) const;

  std::shared_ptr<const std::map<std::string, std::string, std::less<>>> of_folder_;  // by name
  Lookup own_ = nullptr;
};

/// When the newest file of a folder was written; nothing when there is none.
std::optional<std::filesystem::file_time_type> last_change(const std::filesystem::path& folder);

/// Lines put in front of a shader as `#define NAME VALUE`.
using Defines = std::vector<std::pair<std::string, std::string>>;

/// What a define is for something that is on or off.
inline std::string flag(bool on) {
  return on ? "1" : "0";
}

struct ProgramKind {
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

/// A linked program that can be made anew from its files while it is in use.
class Program {
public:
  Program() = default;
  /// One compute shader, or a vertex and a fragment shader; the ending of a name says which (.comp, .vert, .frag).
  /// Throws std::runtime_error with file, line and the compiler's words when it does not build.
  Program(const ShaderSources& sources, std::vector<std::string> shaders, Defines defines = {});

  /// Builds programs again from other sources, all of them or none: when one fails they all go on as they were, and the
  /// compiler's words are returned.
  static std::optional<std::string> reload(std::span<Program* const> programs, const ShaderSources& sources);

  /// Builds for other defines; does nothing when they are those it was built for. The kMostKept variants used last are
  /// kept until the next reload(), so that going back costs nothing; one that is not kept takes as long to build as any
  /// program, 50 to 200 ms with llvmpipe. Throws as the constructor does, and goes on as it was.
  void define(const Defines& defines);
  static constexpr std::size_t kMostKept = 16;

  void use() const { glUseProgram(name()); }
  GLint uniform(const char* name) const { return glGetUniformLocation(this->name(), name); }
  GLuint name() const { return variants_.empty() ? 0 : variants_.front().object.name(); }

  /// Runs a compute program over at least `x` by `y` by `z` invocations in groups of its local size, behind whatever
  /// still reads what it writes over, and makes what it wrote visible to whatever comes next. Throws std::runtime_error
  /// when the device does not take as many groups.
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
  std::vector<Variant> variants_;  ///< the one in use, then those used before it
};

}  // namespace insonate::gl
