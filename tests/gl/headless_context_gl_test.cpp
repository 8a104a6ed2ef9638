// Tests which EGL device a context without a window uses.

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/gl/egl_displays.h"
#include "sim/gl/headless_context.h"

using namespace insonate;

namespace {

/// Sets or clears an environment variable while the object exists.
class Variable {
public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* was = std::getenv(name)) was_ = was;
    set(value);
  }
  ~Variable() { set(was_ ? was_->c_str() : nullptr); }

private:
  void set(const char* value) { value ? ::setenv(name_, value, 1) : ::unsetenv(name_); }

  const char* name_;
  std::optional<std::string> was_;
};

constexpr const char* kChosen = "INSONATE_EGL_DEVICE";
constexpr const char* kSoftware = "LIBGL_ALWAYS_SOFTWARE";  // variables of Mesa; the next one selects a driver by name
constexpr const char* kDriver = "GALLIUM_DRIVER";

std::string refused(const char* device) {
  const Variable chosen(kChosen, device);
  try {
    const gl::HeadlessContext context;
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("an EGL device that is not there is refused in a sentence") {
  for (const char* wrong : {"99", "-1", "1x", "nvidia", " 0", "99999999999999999999"}) {
    CAPTURE(wrong);
    const std::string sentence = refused(wrong);
    CHECK(sentence.starts_with("INSONATE_EGL_DEVICE: there is no EGL device " + std::string(wrong) + "; "));
  }
  CHECK(refused("").empty());  // the same as unset
}

TEST_CASE("EGL's devices can be chosen by number, and one of them is what is taken without a choice") {
  std::string taken;
  {
    const Variable none(kChosen, nullptr), hardware_too(kSoftware, nullptr), any(kDriver, nullptr);
    const gl::HeadlessContext context;
    taken = gl::device_description();
  }
  std::vector<std::string> by_number;
  for (int n = 0; n < 16; ++n) {
    const Variable chosen(kChosen, std::to_string(n).c_str()), hardware_too(kSoftware, nullptr), any(kDriver, nullptr);
    try {
      const gl::HeadlessContext context;
      by_number.push_back(gl::device_description());
    } catch (const InputError&) {
      break;  // no more devices
    } catch (const std::runtime_error&) {
      // the device exists but has no OpenGL 4.5
    }
  }
  CAPTURE(taken, by_number);
  if (by_number.empty()) {
    WARN("skipped: EGL names no devices here");
    return;
  }
  CHECK(std::ranges::count(by_number, taken) >= 1);
}

TEST_CASE("without a choice a software renderer is the last thing that is taken") {
  const Variable none(kChosen, nullptr);
  bool has_software = false;
  {
    const Variable hardware_too(kSoftware, nullptr);
    const std::vector<gl::EglDisplay> displays = gl::egl_displays();
    REQUIRE_FALSE(displays.empty());
    CHECK(std::ranges::is_sorted(displays, {}, &gl::EglDisplay::is_software));
    has_software = std::ranges::any_of(displays, &gl::EglDisplay::is_software);
  }
  const Variable software_alone(kSoftware, "1");
  try {
    const gl::HeadlessContext context;
    CHECK((gl::is_software_renderer() || !has_software));  // a card's own driver does not know the variable
  } catch (const std::runtime_error& error) {
    WARN("skipped, no software renderer is installed: " << error.what());
  }
}
