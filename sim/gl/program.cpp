#include "sim/gl/program.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "sim/gl/work_division.h"
#include "sim/shaders/embedded_shaders.h"

namespace insonate::gl {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kInclude = "#include \"";

GLenum stage_of(const std::string& name) {
  if (name.ends_with(".comp")) return GL_COMPUTE_SHADER;
  if (name.ends_with(".vert")) return GL_VERTEX_SHADER;
  if (name.ends_with(".frag")) return GL_FRAGMENT_SHADER;
  throw std::runtime_error(name + ": a shader's name ends in .comp, .vert or .frag");
}

std::string log_of(GLuint name, void (*get)(GLuint, GLenum, GLint*), void (*text)(GLuint, GLsizei, GLsizei*, char*)) {
  GLint length = 0;
  get(name, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(length), '\0');
  GLsizei written = 0;  // without the terminating zero that the length counts
  text(name, length, &written, log.data());
  log.resize(std::size_t(written));
  return log;
}

struct ShaderKind {
  static void destroy(GLuint name) { glDeleteShader(name); }
};

// Also follows links to folders, and skips folders that may not be read.
constexpr fs::directory_options kAsFilesOpen =
    fs::directory_options::follow_directory_symlink | fs::directory_options::skip_permission_denied;

// A folder may also hold other files, even large ones, or be named by mistake.
bool is_shader(const fs::directory_entry& entry) {
  static constexpr std::array kEndings = {".comp", ".vert", ".frag", ".glsl", ".h"};
  std::error_code error;
  return std::ranges::count(kEndings, entry.path().extension().string()) > 0 && entry.is_regular_file(error);
}

// OpenGL itself only records an error, which nobody reads, and runs nothing.
void refuse_too_many(const std::string& shader, const std::array<int, 3>& groups) {
  for (std::size_t axis = 0; axis < groups.size(); ++axis) {
    if (groups[axis] <= WorkDivision{}.most_groups) continue;
    GLint most = 0;
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, GLuint(axis), &most);
    if (groups[axis] > most)
      throw std::runtime_error(shader + ": " + std::to_string(groups[axis]) +
                               " work groups are above the device's limit of " + std::to_string(most) +
                               "; take fewer scan lines, pixels or voxels");
  }
}

Object<ShaderKind> compile(const ShaderSources& sources, const std::string& name, const Defines& defines) {
  std::vector<std::string> files;
  const std::string body = sources.text(name, files);
  std::string header = "#version 450 core\n";
  for (const auto& [key, value] : defines) header += "#define " + key + " " + value + "\n";
  const char* parts[] = {header.c_str(), body.c_str()};
  Object<ShaderKind> shader(glCreateShader(stage_of(name)));
  glShaderSource(shader.name(), 2, parts, nullptr);
  glCompileShader(shader.name());
  GLint compiled = 0;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (!compiled) {
    std::string message = name + " does not compile:\n" + log_of(shader.name(), glGetShaderiv, glGetShaderInfoLog);
    for (std::size_t i = 1; i < files.size(); ++i)
      message +=
          "  line " + std::to_string(int(i) * ShaderSources::kLinesPerFile + 1) + " is line 1 of " + files[i] + "\n";
    throw std::runtime_error(message);
  }
  return shader;
}

}  // namespace

ShaderSources::ShaderSources(const fs::path& folder) {
  std::map<std::string, std::string, std::less<>> texts;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, kAsFilesOpen, error)) {
    if (!is_shader(entry)) continue;
    std::ifstream stream(entry.path());
    if (stream)
      texts[entry.path().lexically_relative(folder).generic_string()] = {std::istreambuf_iterator(stream), {}};
  }
  folder_texts_ = std::make_shared<const decltype(texts)>(std::move(texts));
}

std::string_view ShaderSources::load(std::string_view name) const {
  if (folder_texts_) {
    const auto found = folder_texts_->find(name);
    if (found != folder_texts_->end()) return found->second;
  }
  std::string_view text = embedded_shader(name);
  if (text.empty() && own_) text = own_(name);
  if (text.empty()) throw std::runtime_error("there is no shader named " + std::string(name));
  return text;
}

void ShaderSources::expand(std::string_view name, std::string& text, std::vector<std::string>& files) const {
  const std::size_t number = files.size();
  files.emplace_back(name);
  const auto line_directive = [&](int line) {
    return "#line " + std::to_string(int(number) * kLinesPerFile + line) + "\n";
  };
  text += line_directive(1);
  std::istringstream lines{std::string(load(name))};
  int line_number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++line_number;
    if (!line.starts_with(kInclude)) {
      text += line + "\n";
      continue;
    }
    const std::string included = line.substr(kInclude.size(), line.rfind('"') - kInclude.size());
    if (std::find(files.begin(), files.end(), included) == files.end()) expand(included, text, files);
    text += line_directive(line_number + 1);
  }
}

std::string ShaderSources::text(std::string_view name, std::vector<std::string>& files) const {
  std::string text;
  expand(name, text, files);
  return text;
}

std::optional<fs::file_time_type> last_change(const fs::path& folder) {
  std::optional<fs::file_time_type> newest;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, kAsFilesOpen, error)) {
    const auto time = entry.last_write_time(error);
    if (!error && is_shader(entry)) newest = std::max(newest.value_or(time), time);
  }
  return newest;
}

Program::Program(const ShaderSources& sources, std::vector<std::string> shaders, Defines defines)
    : sources_(sources), shaders_(std::move(shaders)) {
  variants_.push_back(build(std::move(defines)));
}

Program::Variant Program::build(Defines defines) const {
  Variant variant{std::move(defines), Object<ProgramKind>(glCreateProgram())};
  const GLuint program = variant.object.name();
  for (const std::string& name : shaders_) {
    const Object<ShaderKind> shader = compile(sources_, name, variant.defines);
    glAttachShader(program, shader.name());  // stays alive with the program
  }
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked)
    throw std::runtime_error(shaders_.front() + " does not link:\n" +
                             log_of(program, glGetProgramiv, glGetProgramInfoLog));
  if (shaders_.front().ends_with(".comp")) glGetProgramiv(program, GL_COMPUTE_WORK_GROUP_SIZE, variant.group);
  return variant;
}

std::optional<std::string> Program::reload(std::span<Program* const> programs, const ShaderSources& sources) {
  std::vector<Program> built;
  std::string problems;
  for (const Program* program : programs) {
    try {
      built.emplace_back(sources, program->shaders_, program->variants_.front().defines);
    } catch (const std::runtime_error& error) {
      problems += error.what();
    }
  }
  if (!problems.empty()) return problems;
  for (std::size_t i = 0; i < built.size(); ++i) *programs[i] = std::move(built[i]);
  return std::nullopt;
}

void Program::define(const Defines& defines) {
  auto found = std::find_if(variants_.begin(), variants_.end(),
                            [&](const Variant& variant) { return variant.defines == defines; });
  if (found == variants_.end()) {
    Variant built = build(defines);
    if (variants_.size() == kMaxKept) variants_.pop_back();
    found = variants_.insert(variants_.end(), std::move(built));
  }
  std::rotate(variants_.begin(), found, found + 1);
}

void Program::dispatch(int x, int y, int z) const {
  const GLint* group = variants_.front().group;
  const auto groups = [](int invocations, GLint size) { return (invocations + size - 1) / size; };
  dispatch_groups(groups(x, group[0]), groups(y, group[1]), groups(z, group[2]));
}

void Program::dispatch_groups(int x, int y, int z) const {
  refuse_too_many(shaders_.front(), {x, y, z});
  use();
  // Earlier draws or copies may still read what this overwrites.
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  glDispatchCompute(GLuint(x), GLuint(y), GLuint(z));
  // For the next shader, and for calls that write, clear or read the same objects without a shader.
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                  GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

}  // namespace insonate::gl
