#include "sim/gl/program.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "sim/gl/embedded_shaders.h"

namespace insonate::gl {
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
  std::string log(std::size_t(std::max(length, 1)), '\0');
  text(name, length, nullptr, log.data());
  return log.c_str();  // without the terminating zero that the length counts
}

struct ShaderKind {
  static void destroy(GLuint name) { glDeleteShader(name); }
};

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

std::string ShaderSources::load(std::string_view name) const {
  if (folder_) {
    std::ifstream stream(*folder_ / name);
    if (stream) return {std::istreambuf_iterator<char>(stream), {}};
  }
  const std::string_view text = embedded_shader(name);
  if (text.empty()) throw std::runtime_error("there is no shader named " + std::string(name));
  return std::string(text);
}

void ShaderSources::expand(std::string_view name, std::string& text, std::vector<std::string>& files) const {
  const std::size_t number = files.size();
  files.emplace_back(name);
  const auto line_directive = [&](int line) {
    return "#line " + std::to_string(int(number) * kLinesPerFile + line) + "\n";
  };
  text += line_directive(1);
  std::istringstream lines(load(name));
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

std::optional<std::filesystem::file_time_type> ShaderSources::last_change() const {
  if (!folder_) return std::nullopt;
  std::optional<std::filesystem::file_time_type> newest;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*folder_, error)) {
    const auto time = entry.last_write_time(error);
    if (!error && entry.is_regular_file(error)) newest = std::max(newest.value_or(time), time);
  }
  return newest;
}

Program::Program(const ShaderSources& sources, std::vector<std::string> shaders, Defines defines)
    : object_(glCreateProgram()), shaders_(std::move(shaders)), defines_(std::move(defines)) {
  for (const std::string& name : shaders_) {
    const Object<ShaderKind> shader = compile(sources, name, defines_);
    glAttachShader(object_.name(), shader.name());  // stays alive with the program
  }
  glLinkProgram(object_.name());
  GLint linked = 0;
  glGetProgramiv(object_.name(), GL_LINK_STATUS, &linked);
  if (!linked)
    throw std::runtime_error(shaders_.front() + " does not link:\n" +
                             log_of(object_.name(), glGetProgramiv, glGetProgramInfoLog));
  if (shaders_.front().ends_with(".comp")) {
    GLint group[3] = {1, 1, 1};
    glGetProgramiv(object_.name(), GL_COMPUTE_WORK_GROUP_SIZE, group);
    group_x_ = group[0];
    group_y_ = group[1];
  }
}

std::optional<std::string> Program::reload(const ShaderSources& sources) {
  try {
    *this = Program(sources, shaders_, defines_);
    return std::nullopt;
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void Program::define(const ShaderSources& sources, const Defines& defines) {
  if (defines != defines_) *this = Program(sources, shaders_, defines);
}

void Program::dispatch(int x, int y) const {
  dispatch_groups((x + group_x_ - 1) / group_x_, (y + group_y_ - 1) / group_y_);
}

void Program::dispatch_groups(int x, int y) const {
  use();
  glDispatchCompute(GLuint(x), GLuint(y), 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace insonate::gl
