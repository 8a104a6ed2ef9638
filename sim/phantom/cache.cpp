#include <xxhash.h>

#include <cstdio>
#include <map>
#include <system_error>

#include "sim/core/files.h"
#include "sim/core/input_error.h"
#include "sim/phantom/phantom.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

// Raised whenever the same recipe would give other voxels, or the files another layout.
constexpr const char* kMakerVersion = "phantom maker 1";
constexpr const char* kDigestsFile = "digests.txt";

// 128 bits against damage and mix-ups, not against an attacker: who can write the cache can write the digests too.
std::string digest(const std::string& bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    char hex[3];
    std::snprintf(hex, sizeof hex, "%02x", byte);
    text += hex;
  }
  return text;
}

std::string key_of(const std::string& recipe_text, std::vector<std::pair<std::string, std::string>> options) {
  // Lengths before the parts, so that no two lists of parts run together to the same text.
  std::string all;
  const auto add = [&](const std::string& part) { all += std::to_string(part.size()) + ":" + part; };
  add(kMakerVersion);
  add(recipe_text);
  for (const auto& [option, value] : options) {
    add(option);
    add(value);
  }
  return digest(all);
}

// One line a file: its digest and its name.
std::string digests_of(const fs::path& folder) {
  std::map<std::string, std::string> digests;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != kDigestsFile && name.front() != '.')
      digests[name] = digest(read_file(entry.path(), std::size_t(1) << 34));
  }
  std::string text;
  for (const auto& [name, value] : digests) text += value + "  " + name + "\n";
  return text;
}

// The digests are written last, so a folder without them was never finished.
bool is_whole(const fs::path& folder) {
  try {
    return fs::is_directory(folder) && read_file(folder / kDigestsFile) == digests_of(folder);
  } catch (const InputError&) {
    return false;
  } catch (const fs::filesystem_error&) {
    return false;
  }
}

}  // namespace

Case cached_phantom(const fs::path& recipe, const std::vector<std::pair<std::string, std::string>>& options,
                    const fs::path& cache, const Progress& progress) {
  const std::string text = read_file(recipe, std::size_t(16) << 20);
  const fs::path folder = cache / "phantoms" / (recipe.stem().string() + "-" + key_of(text, options));
  if (is_whole(folder)) {
    try {
      return read_case(folder);
    } catch (const InputError&) {
      // Whole, yet not to be read: written by another version of the reader. Made again below.
    }
  }
  Case subject = make_phantom(recipe.string(), text, options, progress);
  try {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    write_case(folder, subject);
    write_file(folder / kDigestsFile, digests_of(folder));
  } catch (const InputError&) {
    // The case is whole all the same: a cache that cannot be written costs the time to make it again.
  }
  return subject;
}

}  // namespace insonate
