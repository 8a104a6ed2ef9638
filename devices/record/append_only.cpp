#include "devices/record/append_only.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "sim/core/input_error.h"

namespace insonate {

AppendOnlyFile::AppendOnlyFile(std::filesystem::path file, std::string when_full)
    : file_(std::move(file)), when_full_(std::move(when_full)) {
  std::error_code error;
  if (file_.has_parent_path()) std::filesystem::create_directories(file_.parent_path(), error);
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0)
    throw InputError(file_.string(), "", std::string("it cannot be written (") + std::strerror(errno) + ")",
                     "name a new file in a folder that may be written");
  // The lock only signals to others, and not every file system supports it. So an error is ignored.
  ::flock(descriptor_, LOCK_EX | LOCK_NB);
}

AppendOnlyFile::~AppendOnlyFile() {
  ::close(descriptor_);
}

void AppendOnlyFile::append(std::string_view bytes) {
  std::string_view rest = bytes;
  while (!rest.empty()) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      const std::string why = std::strerror(errno);
      // A partial line would run into the next one.
      if (rest.size() < bytes.size() && ::ftruncate(descriptor_, off_t(size_)) != 0)
        size_ += bytes.size() - rest.size();
      throw InputError(file_.string(), "", "it cannot be written on (" + why + ")", when_full_);
    }
    rest.remove_prefix(std::size_t(written));
  }
  size_ += bytes.size();
}

bool is_being_written(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return locked;
}

}  // namespace insonate
