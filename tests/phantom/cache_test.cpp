#include <catch2/catch.hpp>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/phantom/phantom.h"
#include "tests/core/temporary_folder.h"

using namespace insonate;
namespace fs = std::filesystem;

namespace {

const std::string kRecipe = R"(name = "Test"
grid = { from = [0, 0, 0], to = [24, 20, 16], voxel_mm = 1 }
options.radius_mm = { default = 6, least = 1, most = 9, about = "a radius" }
labels = [{ name = "ball", tissue = "liver", hu = 60, texture_hu = 5 }]
shapes = [{ name = "ball", kind = "ellipsoid", centre = [12, 10, 8], radii = [7, 7, "radius_mm"], label = "ball" }]
landmarks = [{ name = "middle", at = [12, 10, 8] }]
views = [{ name = "front", title = "From the front", probe = "curvilinear", aim = "middle", from = [9, 0, 7], marker = [1, 0, 0], press_mm = 1, landmarks = ["middle"], targets = ["ball"] }]
)";

// A cache of its own that goes with the test, and a count of how often a phantom was made.
class Workplace {
public:
  Workplace() { write_file(recipe(), kRecipe); }

  fs::path recipe() const { return folder_ / "ball.toml"; }
  fs::path cache() const { return folder_ / "cache"; }

  Case get(const std::vector<std::pair<std::string, std::string>>& options = {}) {
    bool was_made = false;
    Case subject = cached_phantom(recipe(), options, cache(), [&](double) { was_made = true; });
    made += was_made ? 1 : 0;
    return subject;
  }

  std::vector<fs::path> folders() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(cache() / "phantoms")) found.push_back(entry.path());
    return found;
  }

  int made = 0;

private:
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path;
};

bool same(const Case& a, const Case& b) {
  return a.name == b.name && a.ct.voxels == b.ct.voxels && a.labels.voxels == b.labels.voxels &&
         a.ct.grid.origin == b.ct.grid.origin && a.ct.grid.size == b.ct.grid.size &&
         a.label_table.size() == b.label_table.size() && a.label_table[0].name == b.label_table[0].name &&
         a.landmarks.size() == b.landmarks.size() && a.landmarks[0].position == b.landmarks[0].position &&
         a.views.size() == b.views.size() && a.views[0].patient_from_probe == b.views[0].patient_from_probe;
}

}  // namespace

TEST_CASE("a phantom is made once and comes back from the cache as it was made") {
  Workplace place;
  const Case made = place.get();
  CHECK(place.made == 1);
  CHECK(same(place.get(), made));
  CHECK(place.made == 1);
}

TEST_CASE("other options and another recipe are other phantoms") {
  Workplace place;
  const Case plain = place.get();
  const Case smaller = place.get({{"radius_mm", "4"}});
  CHECK(place.made == 2);
  CHECK_FALSE(same(plain, smaller));
  CHECK(place.folders().size() == 2);
  write_file(place.recipe(), kRecipe + "# another text\n");
  place.get();
  CHECK(place.made == 3);
}

TEST_CASE("a damaged cache is noticed, whatever the damage, and made again") {
  Workplace place;
  const Case made = place.get();
  const fs::path folder = place.folders().front();
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  REQUIRE(files.size() >= 4);  // the table, two volumes, the digests
  int times = 1;
  const auto heals = [&] {
    const Case again = place.get();
    CHECK(place.made == ++times);
    CHECK(same(again, made));
    CHECK(same(place.get(), made));
    CHECK(place.made == times);
  };
  for (const fs::path& file : files) {
    INFO(file.filename());
    {
      std::string bytes = read_file(file);
      bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 1);
      write_file(file, bytes);
      INFO("one bit flipped");
      heals();
    }
    {
      fs::resize_file(file, fs::file_size(file) / 2);
      INFO("cut in half");
      heals();
    }
    {
      fs::resize_file(file, 0);
      INFO("emptied");
      heals();
    }
    {
      fs::remove(file);
      INFO("removed");
      heals();
    }
  }
  fs::remove_all(folder);
  write_file(folder, "a file where the folder was");
  heals();
}

TEST_CASE("a cache that cannot be written costs time and nothing else") {
  Workplace place;
  write_file(place.cache(), "a file where the cache should be");
  const Case made = place.get();
  CHECK(place.made == 1);
  CHECK(same(place.get(), made));
  CHECK(place.made == 2);
}

namespace {

fs::file_time_type hours_ago(int hours) {
  return fs::file_time_type::clock::now() - std::chrono::hours(hours);
}

/// Another one for each number, and none of them as large as the recipe's own.
std::string radius_mm(std::size_t number) {
  return std::to_string(1 + 0.25 * double(number));
}

// As many phantoms as a cache keeps, numbered from 1 up, each an hour older than the one before it.
std::vector<fs::path> fill(Workplace& place) {
  std::vector<fs::path> folders;
  for (std::size_t n = 1; n <= kKeptPhantoms; ++n) {
    place.get({{"radius_mm", radius_mm(n)}});
    for (const fs::path& folder : place.folders())
      if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
    REQUIRE(folders.size() == n);
    fs::last_write_time(folders.back(), hours_ago(int(n)));
  }
  return folders;
}

}  // namespace

TEST_CASE("a cache keeps the phantoms that were used last") {
  Workplace place;
  const std::vector<fs::path> folders = fill(place);
  place.get({{"radius_mm", radius_mm(kKeptPhantoms)}});  // the oldest, just used
  CHECK(place.made == int(kKeptPhantoms));
  place.get({{"radius_mm", "8.5"}});
  CHECK(place.folders().size() == kKeptPhantoms);
  CHECK(fs::exists(folders.back()));
  CHECK_FALSE(fs::exists(folders[kKeptPhantoms - 2]));  // now the one that was used longest ago
  CHECK(fs::exists(folders[kKeptPhantoms - 3]));
}

TEST_CASE("a cached phantom that somebody reads stays") {
  Workplace place;
  const std::vector<fs::path> folders = fill(place);
  const int reader = open(folders.back().c_str(), O_RDONLY | O_DIRECTORY);
  REQUIRE(reader >= 0);
  REQUIRE(flock(reader, LOCK_SH) == 0);
  place.get({{"radius_mm", "8.5"}});
  CHECK(fs::exists(folders.back()));
  close(reader);
  place.get({{"radius_mm", "8.6"}});
  CHECK_FALSE(fs::exists(folders.back()));
  CHECK(place.folders().size() == kKeptPhantoms);
}

TEST_CASE("what was left half done goes from a cache when it is old, and nothing that is not a folder") {
  Workplace place;
  const fs::path phantoms = place.cache() / "phantoms";
  write_file(phantoms / ".old.partial" / "ct.nrrd", "x");
  write_file(phantoms / ".new.partial" / "ct.nrrd", "x");
  write_file(phantoms / "note.txt", "x");
  fs::last_write_time(phantoms / ".old.partial", hours_ago(48));
  fs::last_write_time(phantoms / "note.txt", hours_ago(48));
  place.get();
  CHECK_FALSE(fs::exists(phantoms / ".old.partial"));
  CHECK(fs::exists(phantoms / ".new.partial"));
  CHECK(fs::exists(phantoms / "note.txt"));
}

TEST_CASE("a missing recipe is named") {
  Workplace place;
  CHECK_THROWS_AS(cached_phantom(place.recipe().parent_path() / "none.toml", {}, place.cache()), InputError);
}
