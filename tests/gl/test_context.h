#pragma once

#include <catch2/catch.hpp>
#include <epoxy/gl.h>

#include <string>
#include <vector>

#include "sim/gl/headless_context.h"

namespace insonate::test {

/// A context without a window in which any OpenGL error fails the test. Out of memory is not the caller's error: code
/// that allocates much checks for it itself.
class TestContext {
public:
  TestContext() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(note, &errors_);
  }
  ~TestContext() {
    glDebugMessageCallback(nullptr, nullptr);
    for (const std::string& error : errors_) FAIL_CHECK(error);
  }
  /// Discards errors that a test causes on purpose.
  void forget_errors() { errors_.clear(); }

  TestContext(const TestContext&) = delete;
  TestContext& operator=(const TestContext&) = delete;

private:
  static void APIENTRY note(GLenum source, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message,
                            const void* errors) {
    const std::string text(message);
    if (source == GL_DEBUG_SOURCE_API && type == GL_DEBUG_TYPE_ERROR && text.find("GL_OUT_OF_MEMORY") == text.npos)
      static_cast<std::vector<std::string>*>(const_cast<void*>(errors))->push_back(text);
  }

  gl::HeadlessContext context_{gl::HeadlessContext::Kind::debugged};
  std::vector<std::string> errors_;
};

}  // namespace insonate::test
