#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/devices/child_process.h"

struct _UMockdevTestbed;

namespace insonate {

/// A machine without devices, by umockdev: programs that start in it see only what the test plugs in. Everything
/// happens on the test's thread, in pump().
class Testbed {
public:
  Testbed();
  ~Testbed();
  Testbed(const Testbed&) = delete;
  Testbed& operator=(const Testbed&) = delete;

  /// Why this machine cannot have one; empty when it can.
  static std::string why_not();

  _UMockdevTestbed* get() const { return testbed_; }
  /// Where a path of the mocked machine really is.
  std::string real_path(const std::string& path) const { return root_ + path; }

private:
  _UMockdevTestbed* testbed_;
  std::string root_;
};

/// A file in the place of a device's node, opened for the test as well. It stands for the node in poll() alone: a pipe
/// is ready to read when something was written to it, and ready to write when it is not full.
class Node {
public:
  /// Makes the file at `path` (a real one). With `packets`, each write is read as one piece, as a HID's reports are.
  Node(const std::string& path, bool packets);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// False when there is no room.
  bool write(const std::vector<unsigned char>& bytes);
  void make_writable(bool writable);
  /// What root without its privileges may do, too.
  void allow(bool allowed);
  /// Whether another process has it open.
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

/// Lets the mocked kernel work, and `each_time` besides, until `done`. False when that takes longer than the slowest
/// machine needs.
bool pump(
    const std::function<bool()>& done, const std::function<void()>& each_time = [] {});

}  // namespace insonate
