#pragma once

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/files/files.h"
#include "tests/faults/killed_process.h"

namespace insonate {

inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

/// Returns bytes that cannot be compressed.
inline std::string noise(std::uint32_t seed, std::size_t size = 20'000) {
  std::mt19937 random(seed);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = char(random());
  return bytes;
}

inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

/// Sets the age of temporary files that killed writers left to two days.
inline void age_temporaries(const std::filesystem::path& folder) {
  const timespec then{time(nullptr) - 2 * 24 * 3600, 0}, times[2] = {then, then};
  for (const std::string& name : names_in(folder))
    if (name.front() == '.') utimensat(AT_FDCWD, (folder / name).c_str(), times, 0);
}

inline void require_no_temporaries(const std::filesystem::path& folder) {
  for (const std::string& name : names_in(folder)) require(name.front() != '.', name + " is left");
}

/// The number of the promise that a thing is complete.
inline constexpr std::int32_t kFinished = -1;

/// The most that was promised of one thing; nothing when nothing was.
inline std::optional<std::int32_t> most(const Promises& promises, std::int32_t what) {
  std::optional<std::int32_t> number;
  for (const Promise& promise : promises)
    if (promise.what == what) number = std::max(number.value_or(promise.number), promise.number);
  return number;
}

inline bool promised(const Promises& promises, std::int32_t what, std::int32_t number) {
  return std::any_of(promises.begin(), promises.end(),
                     [&](const Promise& p) { return p.what == what && p.number == number; });
}

inline std::int32_t next_of(const Promises& promises) {
  std::int32_t next = 0;
  for (const Promise& promise : promises) next = std::max(next, promise.what + 1);
  return next;
}

/// One above the highest N of PREFIX-N.anything in the folder, and of what was promised: a writer may have been killed
/// between its beginning and its promise.
inline std::int32_t next_of(const std::filesystem::path& folder, const std::string& prefix, const Promises& promises) {
  std::int32_t next = next_of(promises);
  for (const std::string& entry : names_in(folder)) {
    const std::size_t at = entry.find(prefix + "-");
    if (at != std::string::npos) next = std::max(next, std::stoi(entry.substr(at + prefix.size() + 1)) + 1);
  }
  return next;
}

}  // namespace insonate
