// What a desktop does to the window under the pointer, beyond keys and mouse.
//   desktop drop PATH...   drops files on it: the source's side of the XDND protocol, version 5, without the dragging
//   desktop close          asks it to close, as the button in its frame does
// Exit code 0 when the window said that it took what was dropped, or could be asked to close.

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <poll.h>

#include <cstdio>
#include <cstring>
#include <string>

namespace {

constexpr int kPatience_ms = 60000;  // frames may be slow where the tests run
constexpr long kVersion = 5;

class Desktop {
public:
  explicit Desktop(Display* display) : display_(display) {
    own_ = XCreateSimpleWindow(display, root(), 0, 0, 1, 1, 0, 0, 0);
  }

  bool drop(const std::string& uris) {
    int x = 0, y = 0;
    const Window target = window_under_pointer("XdndAware", x, y);
    if (!target) return false;
    XSetSelectionOwner(display_, atom("XdndSelection"), own_, CurrentTime);
    tell(target, "XdndEnter", {long(own_), kVersion << 24, long(atom("text/uri-list")), 0, 0});
    tell(target, "XdndPosition", {long(own_), 0, (long(x) << 16) | y, CurrentTime, long(atom("XdndActionCopy"))});
    XEvent event;
    if (!await("XdndStatus", uris, event) || !(event.xclient.data.l[1] & 1)) return false;
    tell(target, "XdndDrop", {long(own_), 0, CurrentTime, 0, 0});
    // Its bit 0 is meant to say so; GLFW 3.3 sends the number of bytes that it took.
    return await("XdndFinished", uris, event) && event.xclient.data.l[1] != 0;
  }

  bool close() {
    int x = 0, y = 0;
    const Window target = window_under_pointer("WM_PROTOCOLS", x, y);
    if (target) tell(target, "WM_PROTOCOLS", {long(atom("WM_DELETE_WINDOW")), CurrentTime, 0, 0, 0});
    return target;
  }

private:
  Window root() const { return DefaultRootWindow(display_); }
  Atom atom(const char* name) const { return XInternAtom(display_, name, False); }

  // The outermost one with a property.
  Window window_under_pointer(const char* property, int& x, int& y) const {
    for (Window window = root(), child = None;; window = child) {
      Window same_root = None;
      int in_x = 0, in_y = 0;
      unsigned mask = 0;
      if (!XQueryPointer(display_, window, &same_root, &child, &x, &y, &in_x, &in_y, &mask)) return None;
      Atom type = None;
      int format = 0;
      unsigned long count = 0, left = 0;
      unsigned char* there = nullptr;
      XGetWindowProperty(display_, window, atom(property), 0, 1, False, AnyPropertyType, &type, &format, &count, &left,
                         &there);
      if (there) XFree(there);
      if (type != None) return window;
      if (child == None) return None;
    }
  }

  void tell(Window target, const char* message, const long (&data)[5]) {
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = target;
    event.xclient.message_type = atom(message);
    event.xclient.format = 32;
    std::memcpy(event.xclient.data.l, data, sizeof data);
    XSendEvent(display_, target, False, NoEventMask, &event);
    XFlush(display_);
  }

  // Hands over what is dropped to whoever asks meanwhile.
  bool await(const char* message, const std::string& uris, XEvent& event) {
    for (;;) {
      while (XPending(display_) == 0) {
        pollfd ready{ConnectionNumber(display_), POLLIN, 0};
        if (poll(&ready, 1, kPatience_ms) <= 0) return false;
      }
      XNextEvent(display_, &event);
      if (event.type == ClientMessage && event.xclient.message_type == atom(message)) return true;
      if (event.type == SelectionRequest) answer(event.xselectionrequest, uris);
    }
  }

  void answer(const XSelectionRequestEvent& request, const std::string& uris) {
    XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                    reinterpret_cast<const unsigned char*>(uris.data()), int(uris.size()));
    XEvent answer{};
    answer.xselection.type = SelectionNotify;
    answer.xselection.requestor = request.requestor;
    answer.xselection.selection = request.selection;
    answer.xselection.target = request.target;
    answer.xselection.property = request.property;
    answer.xselection.time = request.time;
    XSendEvent(display_, request.requestor, False, NoEventMask, &answer);
    XFlush(display_);
  }

  Display* display_;
  Window own_ = None;
};

// As file managers write it: a file:// URI, everything but plain characters as %XX.
std::string uri_of(const std::string& path) {
  std::string uri = "file://";
  for (const char c : path) {
    const bool plain =
        std::strchr("/-_.~", c) || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    char coded[4];
    std::snprintf(coded, sizeof coded, "%%%02X", static_cast<unsigned char>(c));
    uri += plain ? std::string(1, c) : coded;
  }
  return uri + "\r\n";
}

}  // namespace

int main(int argc, char** argv) {
  Display* display = XOpenDisplay(nullptr);
  if (!display) return 2;
  const std::string action = argc > 1 ? argv[1] : "";
  std::string uris;
  for (int i = 2; i < argc; ++i) uris += uri_of(argv[i]);
  const bool done = action == "drop" ? Desktop(display).drop(uris) : action == "close" && Desktop(display).close();
  XCloseDisplay(display);
  return done ? 0 : 1;
}
