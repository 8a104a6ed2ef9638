// What is written into folders: the cache, cases, reports, and the shards of datasets.
#include <algorithm>
#include <memory>
#include <random>
#include <utility>

#include "devices/calibration/calibration.h"
#include "scenarios/results/export/report_files.h"
#include "sim/core/hash.h"
#include "sim/core/image.h"
#include "sim/files/png.h"
#include "sim/phantom/phantom.h"
#include "sim/volume/case.h"
#include "tests/faults/kill_checks.h"
#include "tests/faults/kill_kinds.h"
#include "tests/scenarios/results/made_attempt.h"
#include "tools/dataset/dataset_folder.h"
#include "tools/dataset/shard_file.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

// Cases

const std::string kRecipe = R"(name = "Test"
grid = { from = [0, 0, 0], to = [24, 20, 16], voxel_mm = 1 }
options.radius_mm = { default = 6, least = 1, most = 9, about = "a radius" }
labels = [{ name = "ball", tissue = "liver", hu = 60, texture_hu = 5 }]
shapes = [{ name = "ball", kind = "ellipsoid", centre = [12, 10, 8], radii = [7, 7, "radius_mm"], label = "ball" }]
landmarks = [{ name = "middle", at = [12, 10, 8] }]
views = [{ name = "front", title = "From the front", probe = "curvilinear", aim = "middle", from = [9, 0, 7], marker = [1, 0, 0], press_mm = 1, landmarks = ["middle"], targets = ["ball"] }]
)";

class Cache : public Kind {
public:
  Cache() : Kind("the cache of phantoms") {}

  void write(const fs::path& folder, const Promises& before, const Commit& commit) override {
    put_recipe(folder);
    const std::int32_t first = next_of(before);
    for (std::int32_t number = first; number < first + 3; ++number) {
      get(folder, number);
      // A cache on a full disk keeps nothing, and promises nothing.
      bool made_again = false;
      get(folder, number, &made_again);
      if (!made_again) commit({number, 0});
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    put_recipe(folder);
    const std::int32_t next = next_of(promises);
    for (std::int32_t number = std::max(0, next - 3); number <= next; ++number) {
      bool made = false;
      const Case cached = get(folder, number, &made);
      const Case fresh = make_phantom("ball", kRecipe, options(number));
      require(cached.ct.voxels == fresh.ct.voxels && cached.labels.voxels == fresh.labels.voxels &&
                  cached.views.size() == 1 && cached.landmarks.size() == 1,
              "half a phantom looks whole");
      require(!promised(promises, number, 0) || !made, "a phantom is lost from the cache");
    }
    const fs::path phantoms = folder / "cache" / "phantoms";
    age_temporaries(phantoms);
    // Another one than all others, so that it is made.
    const auto other = std::vector<std::pair<std::string, std::string>>{
        {"radius_mm", std::to_string(7 + double(std::random_device{}() % 100'000) / 1e5)}};
    cached_phantom(folder / "ball.toml", other, folder / "cache");
    require_no_temporaries(phantoms);
    require(names_in(phantoms).size() <= kKeptPhantoms, "the cache keeps too many phantoms");
  }

private:
  static std::vector<std::pair<std::string, std::string>> options(std::int32_t number) {
    return {{"radius_mm", std::to_string(1 + 0.001 * number)}};
  }
  static void put_recipe(const fs::path& folder) {
    if (!fs::exists(folder / "ball.toml")) write_file(folder / "ball.toml", kRecipe);
  }
  static Case get(const fs::path& folder, std::int32_t number, bool* made = nullptr) {
    return cached_phantom(folder / "ball.toml", options(number), folder / "cache", [made](double) {
      if (made) *made = true;
    });
  }
};

class Cases : public Kind {
public:
  Cases() : Kind("case folders, replaced and added to") {}

  void write(const fs::path& folder, const Promises& before, const Commit& commit) override {
    const std::int32_t first = next_of(before) + 1;
    for (std::int32_t number = first; number < first + 3; ++number) {
      write_case(folder / "patient", version(number));
      commit({number, 0});
      for (int more = 1; more <= 2; ++more) {
        ReferenceView view;
        view.name = "view_" + std::to_string(more);
        view.title = "A view";
        view.probe = "curvilinear";
        view.depth_mm = 100;
        append_view(folder / "patient", view);
        commit({number, more});
      }
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    const std::int32_t last = next_of(promises) - 1;
    if (!fs::exists(folder / "patient")) {
      require(last < 0, "a case is lost");
      return;
    }
    const Case found = read_case(folder / "patient");
    const std::int32_t number = std::stoi(found.name);
    require(number >= last, "a case that was replaced is back");
    require(found.ct.voxels == version(number).ct.voxels, "a case is mixed of two");
    require(number > last || int(found.views.size()) >= most(promises, last).value_or(0), "a view is lost");
    for (const fs::path& place : {folder, folder / "patient"}) age_temporaries(place);
    write_case(folder / "patient", found);
    require(names_in(folder) == std::vector<std::string>{"patient"}, "something is left beside the case");
    require_no_temporaries(folder / "patient");
  }

private:
  static Case version(std::int32_t number) {
    Case subject;
    subject.name = std::to_string(number);
    subject.ct.grid.size = {30, 30, 30};
    subject.ct.grid.spacing = glm::dvec3(2.0);
    for (std::size_t i = 0; i < subject.ct.grid.count(); ++i)
      subject.ct.voxels.push_back(std::int16_t(hash(std::uint32_t(number), std::uint32_t(i)) % 1000));
    return subject;
  }
};

// Reports and other files that replace an older one

class Files : public Kind {
public:
  Files() : Kind("reports, pictures, calibration, state") {}

  void write(const fs::path& folder, const Promises& before, const Commit& commit) override {
    const std::int32_t first = next_of(before) + 1;
    for (std::int32_t number = first; number < first + 3; ++number) {
      write_all(folder, number);
      commit({number, 0});
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    const std::int32_t last = next_of(promises) - 1;
    const fs::path expected = fs::temp_directory_path() / ("insonate-expected-" + std::to_string(getpid()));
    for (const char* name : kNames) {
      if (!fs::exists(folder / name)) {
        require(last < 0, std::string(name) + " is lost");
        continue;
      }
      const std::string bytes = read_file(folder / name);
      bool whole = false;
      for (std::int32_t number = std::max(last, 1); number <= last + 2 && !whole; ++number) {
        write_all(expected, number);
        whole = bytes == read_file(expected / name);
      }
      require(whole, std::string(name) + " is none of the files that were written");
    }
    fs::remove_all(expected);
    age_temporaries(folder);
    write_all(folder, std::max(last, 1));
    require_no_temporaries(folder);
  }

private:
  static constexpr const char* kNames[] = {"report.html", "score.json",       "score.csv", "xapi.json",
                                           "state.json",  "calibration.toml", "best.png"};

  void write_all(const fs::path& folder, std::int32_t number) const {
    Attempt attempt = made_attempt("L-" + std::to_string(number), exam_);
    attempt.pictures.clear();
    attempt.number = number;
    attempt.uuid = "00000000-0000-4000-8000-000000000000";
    attempt.database = std::string(32, '0');
    write_report_files(folder, attempt);
    write_file(folder / "state.json", "{\"version\": " + std::to_string(number) + "}\n" + std::string(100'000, ' '));
    Calibration calibration;
    calibration.tracker = {"hydra", std::to_string(number), 1};
    write_calibration(folder / "calibration.toml", calibration);
    Image<std::uint8_t> image(100, 80);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] = std::uint8_t(hash(std::uint32_t(number), std::uint32_t(i)));
    write_png(folder / "best.png", image);
  }

  TinyExam exam_ = tiny_exam(0);
};

// Datasets

/// Sets of shards, one after the other: the missing shards are written, then the manifest is completed.
class Shards : public Kind {
public:
  Shards() : Kind("shards and manifests of datasets") {}

  void write(const fs::path& folder, const Promises&, const Commit& commit) override {
    int more = 2;
    for (std::int32_t number = 0; more > 0; ++number) {
      const DatasetFolder set(folder / std::to_string(number));
      if (!set.has_begun() || !set.is_complete()) {
        make(set, number, commit);
        --more;
      }
    }
  }

  void check(const fs::path& folder, const Promises& promises) override {
    const fs::path expected = fs::temp_directory_path() / ("insonate-expected-" + std::to_string(getpid()) + ".h5");
    const std::int32_t sets = next_of(promises);
    for (std::int32_t number = 0; number < sets + 1; ++number) {
      const DatasetFolder set(folder / std::to_string(number));
      if (!set.has_begun()) {
        require(number == sets, "a set is lost");
        continue;
      }
      require(set.damage().empty(), "half a shard looks whole");
      for (std::uint32_t shard = 0; shard < kShards; ++shard) {
        if (!set.has_shard(shard)) {
          require(!promised(promises, number, std::int32_t(shard)), "a shard is lost");
          continue;
        }
        write_shard(expected, expected, number, shard);
        require(read_file(expected) == read_file(set.shard_file(shard)), "a shard is another");
        fs::remove(expected);
      }
      if (!set.is_complete()) {
        require(!promised(promises, number, kFinished), "a set that was complete is not complete any more");
        continue;
      }
      require(set.missing().empty(), "a set is complete without all of its shards");
      // Written again, the manifest is the same; what killed writers left is gone.
      const fs::path place = folder / std::to_string(number);
      const std::string manifest = read_file(place / "manifest.json");
      age_temporaries(place);
      set.complete();
      require(read_file(place / "manifest.json") == manifest, "a manifest is another");
      require_no_temporaries(place);
      require_no_temporaries(place / "shards");
    }
  }

private:
  static constexpr std::uint32_t kShards = 3, kImages = 4;

  static Study study_of(std::int32_t number) {
    Study study;
    study.name = "set " + std::to_string(number);
    study.digest = std::string(15, '0') + char('a' + number % 6);
    study.images = kShards * kImages;
    study.shard_images = kImages;
    return study;
  }

  static void write_shard(const fs::path& file, const fs::path& shown, std::int32_t number, std::uint32_t shard) {
    constexpr int kSide = 48;
    const std::vector<std::pair<std::string, std::string>> about{
        {"study_digest", study_of(number).digest}, {"case_digest", "0123456789abcdef"}, {"device", "none"}};
    ShardWriter writer(file, shown, {kImages, kSide, kSide, 1}, about);
    for (std::uint32_t row = 0; row < kImages; ++row) {
      DatasetImage image;
      image.grey = Image<std::uint8_t>(kSide, kSide);
      for (std::size_t i = 0; i < image.grey.pixels.size(); ++i)
        image.grey.pixels[i] = std::uint8_t(hash(std::uint32_t(number), hash(kImages * shard + row, std::uint32_t(i))));
      image.truth.label = image.truth.visible_label = image.truth.reach = image.grey;
      image.truth.skin_mm = {1.0f};
      image.digest = "000000000000000" + std::to_string(row);
      writer.put(row, image);
    }
    writer.finish();
  }

  static void make(const DatasetFolder& set, std::int32_t number, const Commit& commit) {
    static const StudyCase subject;
    const Study study = study_of(number);
    StudyPatient patient;
    patient.name = "abdomen";
    patient.of = &subject;
    patient.shards = kShards;
    set.begin(study, {patient});
    for (const std::uint32_t shard : set.missing()) {
      const fs::path temporary = set.temporary_for(shard);
      try {
        write_shard(temporary, set.shard_file(shard), number, shard);
        set.put_in_place(temporary, shard);
      } catch (...) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw;
      }
      commit({number, std::int32_t(shard)});
    }
    set.complete();
    commit({number, kFinished});
  }
};

}  // namespace

void add_folder_kinds(std::vector<std::unique_ptr<Kind>>& kinds) {
  kinds.push_back(std::make_unique<Cache>());
  kinds.push_back(std::make_unique<Cases>());
  kinds.push_back(std::make_unique<Files>());
  kinds.push_back(std::make_unique<Shards>());
}

}  // namespace insonate
