// Readers of text when memory runs out: at whichever allocation that happens, they throw std::bad_alloc or an
// InputError, or give what they give otherwise, and let go of all they had taken.
#include <catch2/catch.hpp>
#include <dlfcn.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <limits>
#include <new>
#include <utility>

#include "devices/calibration/calibration.h"
#include "devices/calibration/setup_input.h"
#include "devices/replay/raw_replay.h"
#include "devices/sequence/probe_samples.h"
#include "devices/sequence/recorded_images.h"
#include "devices/sequence/sequence.h"
#include "devices/tracker_uri.h"
#include "scenarios/action.h"
#include "scenarios/results/database/comment.h"
#include "scenarios/results/roster.h"
#include "scenarios/scenario.h"
#include "sim/acoustics/transducer.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/model/settings_file.h"
#include "sim/phantom/phantom.h"
#include "sim/tissue/tissue.h"
#include "sim/view/body/transfer_function_file.h"
#include "sim/volume/ct_reader.h"
#include "sim/wein/wein_settings_file.h"
#include "tests/scenarios/tiny_case.h"
#include "tools/cli/pose_file.h"
#include "tools/dataset/ranks.h"
#include "tools/dataset/study.h"
#include "tools/register/read_sweep.h"
#include "tools/register/start_transform.h"

namespace {

/// Of this thread: how many allocations still succeed, below 0 for all; and how many blocks are held.
thread_local long allocations_left = -1;
/// Of this thread: the largest block that there is memory for, in bytes.
thread_local std::size_t largest_block = std::numeric_limits<std::size_t>::max();
thread_local long blocks = 0;
thread_local bool any_failed = false;

void* allocate(std::size_t size, std::size_t alignment) {
  if (allocations_left == 0 || size > largest_block) {
    any_failed = true;
    throw std::bad_alloc();
  }
  if (allocations_left > 0) --allocations_left;
  void* block = alignment > alignof(std::max_align_t)
                    ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                    : std::malloc(size == 0 ? 1 : size);
  if (!block) throw std::bad_alloc();
  ++blocks;
  return block;
}

void release(void* block) noexcept {
  if (!block) return;
  --blocks;
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, 0);
}
void* operator new[](std::size_t size) {
  return allocate(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, std::size_t(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return allocate(size, std::size_t(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return allocate(size, 0);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* block) noexcept {
  release(block);
}
void operator delete[](void* block) noexcept {
  release(block);
}
void operator delete(void* block, std::size_t) noexcept {
  release(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  release(block);
}
void operator delete(void* block, std::align_val_t) noexcept {
  release(block);
}
void operator delete[](void* block, std::align_val_t) noexcept {
  release(block);
}
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  release(block);
}
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept {
  release(block);
}

/// In the place of toml++'s own, in which a failed allocation ends the program: it always has the memory that
/// TomlDocument has asked for before.
toml::parse_result toml::parse(std::string_view text, std::string_view name) {
  using Parse = toml::parse_result (*)(std::string_view, std::string_view);
  static const auto theirs =
      reinterpret_cast<Parse>(dlsym(RTLD_NEXT, "_ZN4toml2v32ex5parseESt17basic_string_viewIcSt11char_traitsIcEES5_"));
  if (!theirs) std::abort();
  const long left = std::exchange(allocations_left, -1);
  struct Restore {
    long left;
    ~Restore() { allocations_left = left; }
  } const restore{left};
  return theirs(text, name);
}

using namespace insonate;
namespace fs = std::filesystem;

namespace {

struct Folder {
  fs::path path = fs::temp_directory_path() / ("insonate_allocation_" + std::to_string(getpid()));
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  fs::path put(const char* name, const std::string& text) const {
    write_file(path / name, text);
    return path / name;
  }
};

/// Lets `read` run out of memory at each of its allocations in turn. It returns something that tells one reading from
/// another. Returns how many allocations there were.
long run_out_everywhere(const std::function<double()>& read) {
  const double expected = read();  // and whatever is made once for all
  long failed_at = 0;
  for (;; ++failed_at) {
    enum { gave, ran_out, refused, other } outcome = other;
    double value = 0;
    const long before = blocks;
    any_failed = false;
    allocations_left = failed_at;
    try {
      value = read();
      outcome = gave;
    } catch (const std::bad_alloc&) {
      outcome = ran_out;
    } catch (const InputError&) {
      outcome = refused;
    } catch (const std::exception&) {
    }
    allocations_left = -1;
    const long after = blocks;  // before anything is reported, which takes memory too
    if (outcome == gave && value == expected && after == before) {
      if (!any_failed) break;
      continue;
    }
    INFO("allocation " << failed_at);
    REQUIRE(any_failed);
    REQUIRE(outcome != other);
    if (outcome == gave) REQUIRE(value == expected);
    REQUIRE(after == before);
  }
  return failed_at;
}

const char* const kCalibration = R"([tracker]
kind = "hydra"
serial = "1234"
sensor = 2
)";

Case tiny() {
  return tiny_case();
}

}  // namespace

TEST_CASE("readers of TOML outlive a failure at each allocation") {
  const Folder folder;
  const fs::path tissues = folder.put("tissues.toml", read_file(fs::path(INSONATE_ASSETS_FOLDER) / "tissues.toml"));
  CHECK(run_out_everywhere([&] { return read_tissue_table(tissues).knots[1].impedance_mrayl; }) > 100);
  CHECK(run_out_everywhere([&] { return double(parse_scenario(kTinyScenario, "exam.toml").steps.size()); }) > 100);
  const fs::path settings = folder.put("settings.toml", "gain_db = 3\n");
  CHECK(run_out_everywhere([&] { return read_settings(settings, 3.5, 160).gain_db; }) > 10);
  const fs::path roster = folder.put("roster.toml", "format = 1\nlearners = [\"L-01\", \"L-02\"]\n");
  CHECK(run_out_everywhere([&] { return double(read_roster(roster).size()); }) > 10);
}

TEST_CASE("readers of looks, probes, transducers and studies outlive a failure at each allocation") {
  const Folder folder;
  const fs::path assets = INSONATE_ASSETS_FOLDER;
  CHECK(run_out_everywhere([&] {
          return double(view::read_transfer_function(assets / "transfer_functions" / "3_organs.toml").points.size());
        }) > 10);
  const fs::path transducer = assets / "transducers" / "linear.toml";
  CHECK(run_out_everywhere([&] { return read_transducer(transducer).pitch_mm; }) > 10);
  const fs::path wein = folder.put("wein.toml", "similarity_patch = 8\n");
  CHECK(run_out_everywhere([&] { return double(read_wein_settings(wein).similarity_patch); }) > 10);
  const fs::path study = folder.put("study.toml",
                                    "format = 1\nname = \"n\"\nseed = 3\nimages = 100\n[settings]\ngain_db = [-3, 3]\n"
                                    "[[case]]\ncase = \"abdomen\"\n[[probe]]\nname = \"linear\"\n[[poses]]\nkind = "
                                    "\"skin\"\n");
  CHECK(run_out_everywhere([&] { return double(read_study(study).shards()); }) > 10);
  CHECK(run_out_everywhere([&] { return double(read_shard_list("--shards", "0-9:2,4", 20).size()); }) > 0);
  const std::string probe = folder.put("probe.toml", "kind = \"linear\"\nwidth_mm = 40\ndepth_mm = 50\n").string();
  CHECK(run_out_everywhere([&] { return read_probe(probe).width_mm; }) > 10);
  const std::string landmarks = folder.put("landmarks.txt", "0 0 0 1 2 3\n50 0 0 51 2 3\n0 50 0 1 52 3\n").string();
  CHECK(run_out_everywhere([&] { return start_from_landmarks(landmarks).ct_from_sweep[3].x; }) > 0);
  const std::string pose = folder.put("pose.txt", "1 0 0 0 0 1 0 9 0 0 1 0 0 0 0 1\n").string();
  CHECK(run_out_everywhere([&] { return read_pose(pose).translation.y; }) > 0);
  Comment comment;
  comment.text = "Slow down \xc2";
  CHECK(run_out_everywhere([&] { return double(why_no_comment(comment.text).size()); }) > 0);
}

TEST_CASE("readers of cases, recipes and calibrations outlive a failure at each allocation") {
  const Folder folder;
  write_case(folder.path / "tiny", tiny());
  fs::remove(folder.path / "tiny" / "ct.nrrd");  // the table is read first; what is not there ends it
  CHECK(run_out_everywhere([&] {
          try {
            read_case(folder.path / "tiny");
          } catch (const InputError& error) {
            return double(std::string_view(error.what()).find("ct.nrrd") != std::string_view::npos);
          }
          return -1.0;
        }) > 10);
  const std::string recipe = R"(name = "Test"
grid = { from = [0, 0, 0], to = [24, 20, 16], voxel_mm = 1 }
options.radius_mm = { default = 6, least = 1, most = 9, about = "a radius" }
labels = [{ name = "ball", tissue = "liver", hu = 60 }]
shapes = [{ name = "ball", kind = "ellipsoid", centre = [12, 10, 8], radii = [7, 7, "radius_mm"], label = "ball" }]
)";
  CHECK(run_out_everywhere([&] { return double(problems_with_options("r", recipe, {{"radius", "1"}}).size()); }) > 10);
  CHECK(run_out_everywhere([&] { return double(parse_calibration(kCalibration, "lab.toml").tracker.sensor); }) > 0);
  const fs::path landmarks = fs::path(INSONATE_ASSETS_FOLDER) / "calibration" / "abdomen.toml";
  CHECK(run_out_everywhere([&] { return double(read_landmark_list(landmarks).landmarks.size()); }) > 10);
}

TEST_CASE("readers of recordings outlive a failure at each allocation") {
  const Folder folder;
  const auto samples = samples_of(0.2, 30, [](double t) { return turned(90 * t, {1, 2, 3}, {t, 2, 3}); });
  const std::string text = write_sequence(samples);
  CHECK(run_out_everywhere([&] { return double(probe_samples(parse_sequence(text, "scan")).size()); }) > 10);
  const fs::path scan = folder.put("scan.igs.mha", text);
  CHECK(run_out_everywhere([&] { return double(read_recorded_scan(scan).samples.size()); }) > 10);
  std::string raw = "insonate raw 1\ntracker spacemouse:\nstart 1 0 0 0 1 0 0 0 1 0 0 0\nopen 1 256f:c635\n";
  for (int i = 0; i < 20; ++i) raw += "read " + std::to_string(2 + i) + " 015e0151ff0000\n";
  CHECK(run_out_everywhere([&] { return double(parse_raw(raw, "run.raw").samples.size()); }) > 10);
  CHECK(run_out_everywhere([&] { return double(parse_tracker_uri("hydra:A1?handset=2&raw=1").options.size()); }) > 0);
  CHECK(run_out_everywhere([&] {
          return double(
              parse_actions("depth 120; caliper 1 -10.5 40 12 41; answer :a%20stone", "scan", "frame 1").size());
        }) >= 0);
}

TEST_CASE("an image that the memory has no room for is refused in a sentence, and read once there is room") {
  const Folder folder;
  const std::size_t side = 1024;
  const fs::path file = folder.put(
      "scan.igs.mha",
      "ObjectType = Image\nNDims = 3\nDimSize = 1024 1024 1\nElementType = MET_UCHAR\n"
      "Seq_Frame0000_ProbeToTrackerTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
      "Seq_Frame0000_ProbeToTrackerTransformStatus = OK\nSeq_Frame0000_Timestamp = 0\nElementDataFile = LOCAL\n" +
          std::string(side * side, 'x'));
  const RecordedScan scan = read_recorded_scan(file);
  REQUIRE(scan.images);
  ImageReader reader(*scan.images);
  largest_block = side * side - 1;
  CHECK_THROWS_WITH(reader.grey(0),
                    Catch::Contains("scan.igs.mha: image data: there is not enough memory for one image "
                                    "of 1048576 bytes; close other programs"));
  largest_block = std::numeric_limits<std::size_t>::max();
  CHECK(reader.grey(0).pixels[7] == 'x');
}

TEST_CASE("a volume that the memory has no room for is refused in a sentence") {
  const Folder folder;
  const fs::path file = folder.path / "ct.nrrd";
  const Case subject = tiny_case();
  write_ct(file, subject.ct);
  largest_block = subject.ct.voxels.size();  // in bytes: half of what the voxels take
  CHECK_THROWS_WITH(read_ct(file), Catch::Contains("ct.nrrd: there is not enough memory for it; resample it"));
  largest_block = std::numeric_limits<std::size_t>::max();
  CHECK(read_ct(file).voxels == subject.ct.voxels);
}
