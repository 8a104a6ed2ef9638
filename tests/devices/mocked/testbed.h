#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/devices/child_process.h"

struct _UMockdevTestbed;

namespace insonate {

/// A simulated machine without devices, by umockdev. Programs that start in it see only what the test plugs in.
/// Everything happens on the test's thread, in pump().
class Testbed {
public:
  Testbed();
  ~Testbed();
  Testbed(const Testbed&) = delete;
  Testbed& operator=(const Testbed&) = delete;

  /// Returns why this machine cannot have a test bed; empty if it can.
  static std::string why_not();

  _UMockdevTestbed* get() const { return testbed_; }
  /// Returns the real path of a path of the mocked machine.
  std::string real_path(const std::string& path) const { return root_ + path; }

private:
  _UMockdevTestbed* testbed_;
  std::string root_;
};

/// A file in the place of a device's node, opened by the test as well. It stands for the node in poll() only: a pipe is
/// ready to read once something was written to it, and ready to write while it is not full.
class Node {
public:
  /// Creates the file at `path` (a real path). With `packets`, each write is read as one piece, like a HID's reports.
  Node(const std::string& path, bool packets);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Returns false if there is no room.
  bool write(const std::vector<unsigned char>& bytes);
  void make_writable(bool writable);
  /// Sets whether root without its privileges may open it too.
  void allow(bool allowed);
  /// Returns whether another process has it open.
  bool is_open_elsewhere() const;

private:
  std::string path_;
  int fd_;
};

/// A program started in the test bed.
class Child : public ChildProcess {
public:
  explicit Child(const std::vector<std::string>& command);
};

/// Runs the mocked kernel, and `each_time` between its steps, until `done`. Returns false if that takes longer than the
/// slowest machine needs.
bool pump(
    const std::function<bool()>& done, const std::function<void()>& each_time = [] {});

}  // namespace insonate
