#pragma once

#include <fcntl.h>
#include <sys/stat.h>

#include <ctime>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/core/files.h"

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

}  // namespace insonate
