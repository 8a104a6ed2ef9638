#include "sim/gl/egl_displays.h"

#include <epoxy/egl.h>

#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

#include "sim/core/input_error.h"

namespace insonate::gl {
namespace {

constexpr const char* kVariable = "INSONATE_EGL_DEVICE";

std::vector<EGLDeviceEXT> devices() {
  // EGL_EXT_device_enumeration is the half of EGL_EXT_device_base that lists devices.
  for (const char* extension : {"EGL_EXT_device_enumeration", "EGL_EXT_device_base"}) {
    EGLint count = 0;
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, extension) || !eglQueryDevicesEXT(0, nullptr, &count)) continue;
    std::vector<EGLDeviceEXT> all(std::size_t(count), nullptr);
    if (!eglQueryDevicesEXT(count, all.data(), &count)) continue;
    all.resize(std::size_t(count));
    return all;
  }
  return {};
}

bool is_software(EGLDeviceEXT device) {
  const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  return extensions && std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
}

EglDisplay on(EGLDeviceEXT device) {
  return {[device] { return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr); }, is_software(device)};
}

// True if LIBGL_ALWAYS_SOFTWARE is on, with the same values as in Mesa.
bool software_is_asked_for() {
  const char* value = std::getenv("LIBGL_ALWAYS_SOFTWARE");
  if (!value) return false;
  const std::string_view text(value);
  return !text.empty() && text != "0" && text != "n" && text != "no" && text != "f" && text != "false";
}

EglDisplay the_one_chosen(const std::string& chosen, const std::vector<EGLDeviceEXT>& all) {
  std::size_t n = 0;
  const auto [end, error] = std::from_chars(chosen.data(), chosen.data() + chosen.size(), n);
  if (error == std::errc() && end == chosen.data() + chosen.size() && n < all.size()) return on(all[n]);
  const std::string last = all.empty() ? "" : std::to_string(all.size() - 1);
  throw InputError(kVariable, "", "there is no EGL device " + chosen,
                   all.empty() ? "unset it" : "take one from 0 to " + last + ", or unset it");
}

}  // namespace

std::vector<EglDisplay> egl_displays() {
  const bool by_device = epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device");
  const std::vector<EGLDeviceEXT> all = by_device ? devices() : std::vector<EGLDeviceEXT>();
  if (const char* chosen = std::getenv(kVariable); chosen && *chosen) return {the_one_chosen(chosen, all)};

  std::vector<EglDisplay> displays, software;
  for (EGLDeviceEXT device : all) (is_software(device) ? software : displays).push_back(on(device));
  if (software_is_asked_for()) displays.clear();
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
    displays.push_back(
        {[] { return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr); }, false});
  displays.insert(displays.end(), software.begin(), software.end());
  return displays;
}

}  // namespace insonate::gl
