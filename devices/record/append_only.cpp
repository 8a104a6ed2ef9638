#include "devices/record/append_only.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate {

AppendOnlyFile::AppendOnlyFile(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code error;
  if (file_.has_parent_path()) std::filesystem::create_directories(file_.parent_path(), error);
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0)
    throw InputError(file_.string(), "", std::string("it cannot be written (") + std::strerror(errno) + ")",
                     "name a new file in a folder that may be written");
  // Only a sign for others, and not every file system has it.
  ::flock(descriptor_, LOCK_EX | LOCK_NB);
}

AppendOnlyFile::~AppendOnlyFile() {
  ::close(descriptor_);
}

void AppendOnlyFile::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0)
      throw InputError(file_.string(), "", std::string("it cannot be written on (") + std::strerror(errno) + ")",
                       "make room on the disk and record again");
    bytes.remove_prefix(std::size_t(written));
    size_ += std::uint64_t(written);
  }
}

bool is_being_written(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return locked;
}

}  // namespace insonate
