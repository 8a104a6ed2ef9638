// The folder of a dataset without its program: manifests and shards that cannot be used, and what is made of them.
#include "tools/dataset/dataset_folder.h"

#include <catch2/catch.hpp>
#include <hdf5.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <utility>
#include <vector>

#include "sim/core/input_error.h"
#include "tests/tools/dataset/study_folder.h"
#include "tools/cli/about.h"
#include "tools/dataset/shard_file.h"

using namespace insonate;
using Catch::Contains;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr int kSide = 2;

/// Writes a shard of two images, as insonate-dataset would.
void write_shard(const fs::path& file, std::uint32_t shard, const std::string& study_digest = "0123456789abcdef",
                 const std::string& case_digest = "00112233445566778899aabbccddeeff") {
  const std::vector<std::pair<std::string, std::string>> about{
      {"study_digest", study_digest}, {"case_digest", case_digest}, {"device", "llvmpipe"}};
  fs::create_directories(file.parent_path());
  ShardWriter writer(file, file, {2, kSide, kSide, 3}, about);
  for (std::uint32_t row = 0; row < 2; ++row) {
    DatasetImage image;
    image.shot.probe = *find_probe("linear");
    image.shot.pose_source = "skin";
    image.shot.depth_mm = 40;
    image.grey = image.truth.label = image.truth.visible_label = image.truth.reach =
        Image<std::uint8_t>(kSide, kSide, std::uint8_t(10 * shard + row));
    image.truth.skin_mm = {0.5f, -1.0f};
    image.settings = "{}";
    image.digest = "000000000000000" + std::to_string(2 * shard + row);
    writer.put(row, image);
  }
  writer.finish();
}

/// A set of two shards, of which the manifest says what `change` makes of it.
struct Set {
  test::StudyFolder place;
  DatasetFolder folder{place.path / "set"};
  fs::path manifest = place.path / "set" / "manifest.json";

  Set() {
    put([](Json&) {});
    for (std::uint32_t shard = 0; shard < 2; ++shard) write_shard(folder.shard_file(shard), shard);
  }
  void put(const std::function<void(Json&)>& change) const {
    Json json{{"format", 1}, {"shard_count", 2}, {"complete", false}};
    json["program"] = {{"name", "Insonate"}, {"version", "0"}, {"commit", "0"}};
    json["patients"] = {{{"name", "abdomen"}, {"first_shard", 0}, {"shards", 2}}};
    json["study"] = {{"digest", "0123456789abcdef"}, {"text", ""}};
    json["tissue_table"] = {{"digest", "0"}, {"text", ""}};
    change(json);
    place.file("set/manifest.json", json.dump());
  }
};

template <typename Value>
std::function<void(Json&)> with(const char* pointer, Value value) {
  return [=](Json& json) { json[Json::json_pointer(pointer)] = value; };
}

/// Changes an attribute of a shard, as a damaged or foreign file may have it.
void put_attribute(const fs::path& file, const char* name, hid_t type, hid_t space, const void* value) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(H5Adelete(opened, name) >= 0);
  const hid_t attribute = H5Acreate2(opened, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE(H5Awrite(attribute, type, value) >= 0);
  H5Aclose(attribute);
  H5Sclose(space);
  REQUIRE(H5Fclose(opened) >= 0);
}

/// Puts a dataset of other sizes, without values, in the place of one of a shard.
void put_data(const fs::path& file, const char* name, hid_t type, const std::vector<hsize_t>& size) {
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(H5Ldelete(opened, name, H5P_DEFAULT) >= 0);
  const hid_t space = H5Screate_simple(int(size.size()), size.data(), nullptr), how = H5Pcreate(H5P_DATASET_CREATE);
  const std::vector<hsize_t> chunk(size.size(), 1);
  H5Pset_chunk(how, int(chunk.size()), chunk.data());
  const hid_t data = H5Dcreate2(opened, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT);
  REQUIRE(data >= 0);
  H5Dclose(data);
  H5Pclose(how);
  H5Sclose(space);
  REQUIRE(H5Fclose(opened) >= 0);
}

}  // namespace

TEST_CASE("a dataset is completed by what its shards state, once and for all") {
  const Set set;
  CHECK(set.folder.missing().empty());
  CHECK_FALSE(set.folder.is_complete());
  set.place.file("set/shards/.00001.host.7.partial.h5", "left behind");
  set.folder.complete();
  CHECK(set.folder.is_complete());
  CHECK_FALSE(fs::exists(set.place.path / "set/shards/.00001.host.7.partial.h5"));
  const std::string text = read_file(set.manifest);
  CHECK_THAT(text, Contains("\"devices\": [\n    \"llvmpipe\"\n  ]"));
  // A program that was killed a day ago left this, when the manifest was already the one above.
  const fs::path left = set.place.file("set/.manifest.0123456789abcdef.partial.json", "{");
  fs::last_write_time(left, fs::file_time_type::clock::now() - std::chrono::hours(25));
  set.folder.complete();
  CHECK(read_file(set.manifest) == text);
  CHECK_FALSE(fs::exists(left));
  CHECK(set.folder.damage().empty());
  // A shard may hold any bytes as the name of its device.
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, 4);
  put_attribute(set.folder.shard_file(1), "device", type, H5Screate(H5S_SCALAR), "a\xff\xfe");
  H5Tclose(type);
  set.folder.complete();
  CHECK_THAT(read_file(set.manifest), Contains("a\xef\xbf\xbd"));
}

TEST_CASE("shards of one patient whose files have changed meanwhile do not make a set") {
  const Set set;
  fs::remove(set.folder.shard_file(1));
  write_shard(set.folder.shard_file(1), 1, "0123456789abcdef", "ffeeddccbbaa99887766554433221100");
  CHECK_THROWS_WITH(set.folder.complete(), Contains("the files of 'abdomen' have changed meanwhile"));
  CHECK_FALSE(set.folder.is_complete());
}

TEST_CASE("a manifest that is damaged or foreign is refused before its numbers are used") {
  const Set set;
  const auto refused = [&](const std::function<void(Json&)>& change) {
    set.put(change);
    const std::string says = "it is not the manifest of a dataset";
    CHECK_THROWS_WITH(set.folder.shards(), Contains(set.manifest.string() + ": " + says));
    CHECK_THROWS_AS(set.folder.complete(), InputError);
    CHECK_THROWS_AS(set.folder.damage(), InputError);
  };
  refused(with("/format", 2));
  refused(with("/shard_count", 100001));
  refused(with("/shard_count", -1));
  refused(with("/shard_count", "2"));
  refused(with("/complete", 1));
  refused(with("/study", "text"));
  refused(with("/study/digest", 1));
  refused(with("/program/commit", 1));
  refused(with("/program/version", nullptr));
  refused(with("/tissue_table/digest", 1));
  refused(with("/patients", 1));
  refused(with("/patients/0", 1));
  refused(with("/patients/0/name", 1));
  refused(with("/patients/0/first_shard", 3));
  refused(with("/patients/0/shards", 3));
  refused(with("/patients/0/first_shard", 4294967295u));
  refused([](Json& json) { json["patients"][0].erase("shards"); });
  refused(with("/shards", Json::object()));
  refused(with("/shards/0", 1));
  refused(with("/shards/0/digest", 1));
  refused([](Json& json) { json = Json::array({1}); });
  for (const char* text : {"", "not json", "3", "{\"format\": 1", "\"\xff\""}) {
    if (*text) set.place.file("set/manifest.json", text);
    if (*text) CHECK_THROWS_AS(set.folder.shards(), InputError);
  }
}

TEST_CASE("a dataset of another study or program is not continued, and not merged") {
  const Set set;
  Study study;
  study.digest = "other";
  CHECK_THROWS_WITH(set.folder.check_is_of(study), Contains("this folder holds the dataset of another study"));
  study.digest = "0123456789abcdef";
  CHECK_THROWS_WITH(set.folder.check_is_of(study), Contains("this dataset was begun by Insonate 0, commit 0"));
  set.put([](Json& json) {
    for (const AboutLine& line : about_this_build()) {
      if (line.name == "Version") json["program"]["version"] = line.text;
      if (line.name == "Commit") json["program"]["commit"] = line.text;
    }
  });
  CHECK_THROWS_WITH(set.folder.check_is_of(study), Contains("this dataset was begun with another tissue table"));
  const DatasetFolder other(set.place.path / "other");
  set.place.file("other/manifest.json", read_file(set.manifest));
  CHECK(set.folder.take_shards_of(other) == 0);
  write_shard(other.shard_file(1), 1);
  fs::remove(set.folder.shard_file(1));
  CHECK(set.folder.take_shards_of(other) == 1);
  CHECK(set.folder.missing().empty());
  set.put(with("/study/digest", "another"));
  CHECK_THROWS_WITH(set.folder.take_shards_of(other), Contains("it holds the dataset of another study, program or"));
  CHECK_THROWS_WITH(set.folder.complete(), Contains("00000.h5: it is a shard of another study; remove it"));
}

TEST_CASE("a shard that claims what it does not hold is damaged, and harms nothing") {
  const Set set;
  const fs::path shard = set.folder.shard_file(0);
  const auto damaged = [&](const std::string& says) {
    CHECK_THAT(damage_of_shard(shard), Contains(says));
    const std::vector<std::string> all = set.folder.damage();
    REQUIRE(all.size() == 1);
    CHECK_THAT(all[0], Catch::StartsWith(shard.string() + ": ") && Contains("remove it, and make the shard again."));
    fs::remove(shard);
    write_shard(shard, 0);
  };
  CHECK(damage_of_shard(shard).empty());
  put_data(shard, "image", H5T_STD_U8LE, {100001, 2, 2});
  damaged("the size of its data 'image' is damaged");
  put_data(shard, "label", H5T_STD_U8LE, {1, hsize_t(1) << 40, hsize_t(1) << 40});
  damaged("the size of its data 'label' is damaged");
  put_data(shard, "reach", H5T_STD_U8LE, {2, 2});
  damaged("it has no data 'reach'");
  put_data(shard, "depth_mm", H5T_IEEE_F64LE, {hsize_t(1) << 40});
  damaged("the size of its data 'depth_mm' is damaged");
  const hid_t texts = H5Tcopy(H5T_C_S1);
  H5Tset_size(texts, H5T_VARIABLE);
  put_data(shard, "settings", texts, {2});
  damaged("the size of its data 'settings' is damaged");
  put_data(shard, "digest", H5T_C_S1, {hsize_t(1) << 40});
  damaged("its list of digests is damaged");
  put_data(shard, "digest", H5T_IEEE_F64LE, {2});
  damaged("its list of digests is damaged");
  // Sixteen bytes for one text, where the file claims many: HDF5 would write beyond them.
  const hid_t text = H5Tcopy(H5T_C_S1);
  H5Tset_size(text, 16);
  const hsize_t many = 1000;
  const std::vector<char> values(16 * many, 'x');
  put_attribute(shard, "digest", text, H5Screate_simple(1, &many, nullptr), values.data());
  CHECK_THROWS_WITH(read_shard_summary(shard), Contains("it is not a shard of a dataset, or it is damaged"));
  damaged("its list of digests is not the one that it was written with");
  const char* pointer = "0123456789abcdef";
  put_attribute(shard, "study_digest", texts, H5Screate(H5S_SCALAR), &pointer);
  CHECK_THROWS_WITH(read_shard_summary(shard), Contains("it is not a shard of a dataset, or it is damaged"));
  H5Tclose(text);
  H5Tclose(texts);
  fs::remove(shard);
  write_shard(shard, 0, "another");
  damaged("");
}

TEST_CASE("what cannot be written in a dataset's folder is said in a sentence") {
  const Set set;
  set.place.file("file", "x");
  CHECK_THROWS_WITH(DatasetFolder(set.place.path / "file" / "set").begin(Study(), {}),
                    Contains("set: the folder cannot be made ("));
  // A folder on another disk that has the name of a shard.
  const fs::path elsewhere = fs::path("/dev/shm") / ("insonate_dataset_test_" + std::to_string(getpid()));
  std::error_code no_such_disk;
  if (fs::create_directories(elsewhere / "shards" / "00000.h5", no_such_disk) && !no_such_disk) {
    fs::copy_file(set.manifest, elsewhere / "manifest.json");
    fs::remove(set.folder.shard_file(0));
    CHECK_THROWS_WITH(set.folder.take_shards_of(DatasetFolder(elsewhere)),
                      Contains("00000.h5: it cannot be copied (") && Contains("check the permissions"));
    fs::remove_all(elsewhere);
  }
  // The temporary file is not there.
  fs::remove(set.folder.shard_file(1));
  CHECK_THROWS_WITH(set.folder.put_in_place(set.place.path / "nothing", 1),
                    Contains("00001.h5: it cannot be written (No such file or directory)"));
  // Behind this, the library closes nothing any more.
  CHECK_THROWS_WITH(ShardWriter(set.place.path / "nowhere" / "a.h5", "shown.h5", {1, 2, 2, 1}, {}),
                    Contains("shown.h5: it cannot be written (No such file or directory); check the folder's"));
}
