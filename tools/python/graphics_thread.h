#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace insonate::python {

/// Runs `work` on the thread that has the process's OpenGL context, and waits for it without Python's lock. So any
/// Python thread may use any simulator. The first call opens the context. Throws what `work` throws, and InputError in
/// a process that was forked from one which has used OpenGL.
void on_graphics_thread(const std::function<void()>& work);

/// Lets the thread destroy an object, and does not wait.
void destroy_on_graphics_thread(std::shared_ptr<void> object);

/// An object that is made, used and destroyed on the graphics thread.
template <typename T>
class OnGraphicsThread {
public:
  OnGraphicsThread() = default;
  OnGraphicsThread(OnGraphicsThread&& other) noexcept : object_(std::move(other.object_)) {}
  OnGraphicsThread& operator=(OnGraphicsThread&&) = delete;
  ~OnGraphicsThread() { close(); }

  template <typename... Arguments>
  void open(Arguments&&... arguments) {
    on_graphics_thread([&] { object_ = std::make_shared<T>(std::forward<Arguments>(arguments)...); });
  }
  void close() {
    if (object_) destroy_on_graphics_thread(std::move(object_));
    object_.reset();
  }
  /// Throws std::runtime_error if it is closed.
  /// @param name  of the object in that error
  void check_is_open(const char* name) const {
    if (!object_) throw std::runtime_error(std::string("the ") + name + " is closed; open a new one");
  }

  /// Calls `use` with the object. Throws what check_is_open() throws.
  template <typename Use>
  void with(const char* name, const Use& use) {
    check_is_open(name);
    // Another thread may close it meanwhile; the last one that holds it lets go of it on the graphics thread.
    std::shared_ptr<T> held = object_;
    on_graphics_thread([&] {
      const std::shared_ptr<T> mine = std::move(held);
      use(*mine);
    });
  }

private:
  std::shared_ptr<T> object_;
};

}  // namespace insonate::python
