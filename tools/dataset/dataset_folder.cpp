#include "tools/dataset/dataset_folder.h"

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>

#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/files/new_folder.h"
#include "tools/cli/about.h"
#include "tools/dataset/shard_file.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kManifestFormat = 1;
constexpr std::size_t kLargestManifest = 1u << 28;

std::string number_of(std::uint32_t shard) {
  std::string digits = std::to_string(shard);
  constexpr std::size_t kDigits = 5;  // enough for kMaxShards
  return std::string(kDigits - std::min(kDigits, digits.size()), '0') + digits;
}

std::string name_in_manifest(std::uint32_t shard) {
  return "shards/" + number_of(shard) + ".h5";
}

std::string about(const std::string& name) {
  for (const AboutLine& line : about_this_build())
    if (line.name == name) return line.text;
  return "";
}

enum class Renamed { done, taken, on_another_disk };

/// Gives a file a name, unless something has it.
Renamed rename_to_new(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return Renamed::done;
  if (errno == EINVAL || errno == ENOSYS) {  // file systems such as NFS, which can give a second name instead
    if (link(from.c_str(), to.c_str()) == 0) {
      unlink(from.c_str());
      return Renamed::done;
    }
  }
  if (errno == EEXIST) return Renamed::taken;
  if (errno == EXDEV) return Renamed::on_another_disk;
  throw InputError(to.string(), "", std::string("it cannot be written (") + std::strerror(errno) + ")",
                   "check the folder's permissions and free space");
}

/// Returns the manifest before there is any shard.
Json manifest_of(const Study& study, const std::vector<StudyPatient>& patients) {
  const DatasetTissues tissues = dataset_tissues();
  Json json;
  json["format"] = kManifestFormat;
  json["name"] = study.name;
  json["program"] = {{"name", "Insonate"}, {"version", about("Version")}, {"commit", about("Commit")}};
  json["images"] = study.images;
  json["shard_images"] = study.shard_images;
  json["shard_count"] = study.shards();
  json["complete"] = false;
  for (const StudyPatient& patient : patients) {
    Json entry;
    entry["name"] = patient.name;
    entry["case"] = patient.of->given;
    entry["licence"] = patient.of->licence;
    entry["options"] = Json::object();
    for (const auto& [option, value] : patient.options) entry["options"][option] = value;
    entry["first_shard"] = patient.first_shard;
    entry["shards"] = patient.shards;
    json["patients"].push_back(std::move(entry));
  }
  json["study"] = {{"digest", study.digest}, {"text", study.text}};
  json["tissue_table"] = {{"digest", tissues.digest}, {"text", tissues.text}};
  return json;
}

/// Returns whether a key holds a whole number from 0 to `most`.
bool has_number(const Json& json, const char* key, std::uint64_t most) {
  return json.at(key).is_number_unsigned() && json.at(key).get<std::uint64_t>() <= most;
}

/// Returns whether a manifest has everything that is read of it.
bool is_complete_manifest(const Json& json) {
  if (json.at("format") != kManifestFormat || !has_number(json, "shard_count", kMaxShards) ||
      !json.at("study").at("digest").is_string() || !json.at("program").at("version").is_string() ||
      !json.at("program").at("commit").is_string() || !json.at("tissue_table").at("digest").is_string() ||
      !json.at("patients").is_array() || !json.at("complete").is_boolean())
    return false;
  const std::uint64_t shards = json.at("shard_count").get<std::uint64_t>();
  for (const Json& patient : json.at("patients"))
    if (!patient.at("name").is_string() || !has_number(patient, "first_shard", shards) ||
        !has_number(patient, "shards", shards - patient.at("first_shard").get<std::uint64_t>()))
      return false;
  if (!json.contains("shards")) return true;
  const auto has_digest = [](const Json& shard) { return shard.at("digest").is_string(); };
  return json.at("shards").is_array() && std::ranges::all_of(json.at("shards"), has_digest);
}

Json read_manifest(const fs::path& file) {
  if (std::error_code error; !fs::exists(file, error))
    throw InputError(file.parent_path().string(), "", "it is not the folder of a dataset: manifest.json is missing",
                     "begin one with insonate-dataset plan, or check the name");
  const std::string text = read_file(file, kLargestManifest);
  const char* const remedy = "name the folder of a dataset, or make it anew";
  try {
    Json json = Json::parse(text);
    if (!is_complete_manifest(json))
      throw InputError(file.string(), "", "it is not the manifest of a dataset of this version", remedy);
    return json;
  } catch (const Json::exception&) {
    throw InputError(file.string(), "", "it is not the manifest of a dataset", remedy);
  }
}

}  // namespace

DatasetTissues dataset_tissues() {
  const fs::path file = assets_folder() / "tissues.toml";
  DatasetTissues tissues;
  tissues.text = read_file(file);
  tissues.digest = digest_of(tissues.text);
  tissues.table = read_tissue_table(file);
  return tissues;
}

void DatasetFolder::begin(const Study& study, const std::vector<StudyPatient>& patients) const {
  if (!has_begun()) {
    std::error_code error;
    fs::create_directories(path_ / "shards", error);
    if (error)
      throw InputError(path_.string(), "", "the folder cannot be made (" + error.message() + ")",
                       "name a folder that may be written");
    const fs::path temporary = write_beside(manifest_file(), manifest_of(study, patients).dump(2) + "\n");
    if (rename_to_new(temporary, manifest_file()) != Renamed::done) fs::remove(temporary, error);
  }
  check_is_of(study);
}

void DatasetFolder::check_may_begin() const {
  std::error_code error;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error))
    if (const std::string name = entry->path().filename().string();
        name != "shards" && name != "manifest.json" && !name.starts_with("."))
      throw InputError(path_.string(), "", "the folder holds other files, such as " + in_quotes(name),
                       "name a new folder");
  refuse_unwritable(fs::exists(path_, error) ? path_ / "shards" : path_);
}

bool DatasetFolder::has_begun() const {
  std::error_code error;
  return fs::exists(manifest_file(), error);
}

void DatasetFolder::check_is_of(const Study& study) const {
  const Json json = read_manifest(manifest_file());
  if (json.at("study").at("digest") != study.digest)
    throw InputError(manifest_file().string(), "",
                     "this folder holds the dataset of another study, or of an earlier text of it",
                     "name a new folder");
  if (json.at("program").at("version") != about("Version") || json.at("program").at("commit") != about("Commit"))
    throw InputError(manifest_file().string(), "",
                     "this dataset was begun by Insonate " + json.at("program").at("version").get<std::string>() +
                         ", commit " + json.at("program").at("commit").get<std::string>(),
                     "go on with the same program, or name a new folder");
  if (json.at("tissue_table").at("digest") != dataset_tissues().digest)
    throw InputError(manifest_file().string(), "", "this dataset was begun with another tissue table",
                     "go on with the same one, or name a new folder");
}

fs::path DatasetFolder::shard_file(std::uint32_t shard) const {
  return path_ / name_in_manifest(shard);
}

bool DatasetFolder::has_shard(std::uint32_t shard) const {
  std::error_code error;
  return fs::exists(shard_file(shard), error);
}

fs::path DatasetFolder::temporary_for(std::uint32_t shard) const {
  return temporary_beside(shard_file(shard));
}

void DatasetFolder::put_in_place(const fs::path& temporary, std::uint32_t shard) const {
  std::error_code error;
  if (rename_to_new(temporary, shard_file(shard)) != Renamed::done) fs::remove(temporary, error);
}

std::uint32_t DatasetFolder::shards() const {
  return read_manifest(manifest_file()).at("shard_count").get<std::uint32_t>();
}

std::vector<std::uint32_t> DatasetFolder::missing() const {
  std::vector<std::uint32_t> all;
  const std::uint32_t count = shards();
  for (std::uint32_t shard = 0; shard < count; ++shard)
    if (!has_shard(shard)) all.push_back(shard);
  return all;
}

void DatasetFolder::complete() const {
  Json json = read_manifest(manifest_file());
  json["complete"] = true;
  std::set<std::string> devices;
  Json shards = Json::array();
  for (Json& patient : json["patients"]) {
    const auto first = patient.at("first_shard").get<std::uint32_t>(),
               count = patient.at("shards").get<std::uint32_t>();
    for (std::uint32_t shard = first; shard < first + count; ++shard) {
      const ShardSummary summary = read_shard_summary(shard_file(shard));
      if (summary.study_digest != json.at("study").at("digest").get<std::string>())
        throw InputError(shard_file(shard).string(), "", "it is a shard of another study",
                         "remove it, and make the shard again");
      if (shard > first && patient["digest"] != summary.case_digest)
        throw InputError(shard_file(shard).string(), "",
                         "its patient is not that of the shards before: the files of '" +
                             patient.at("name").get<std::string>() + "' have changed meanwhile",
                         "remove the shards of this patient, and make them again");
      devices.insert(summary.device);
      patient["digest"] = summary.case_digest;
      shards.push_back(
          {{"file", name_in_manifest(shard)}, {"patient", patient.at("name")}, {"digest", summary.digest}});
    }
  }
  json["devices"] = devices;
  json["shards"] = std::move(shards);
  // The name of a device comes from a shard, which may be damaged.
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  read_file(manifest_file(), kLargestManifest) == text ? remove_old_temporaries(manifest_file())
                                                       : write_file(manifest_file(), text);

  // All shards are there, so a process that still writes one does so in vain.
  std::error_code error;
  for (fs::directory_iterator entry(path_ / "shards", error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (name.starts_with(".") && name.ends_with(".partial.h5")) fs::remove(entry->path(), ignored);
  }
}

bool DatasetFolder::is_complete() const {
  return read_manifest(manifest_file()).at("complete").get<bool>();
}

std::uint32_t DatasetFolder::take_shards_of(const DatasetFolder& other) const {
  const Json here = read_manifest(manifest_file()), there = read_manifest(other.manifest_file());
  for (const char* part : {"study", "program", "tissue_table"})
    if (here.at(part) != there.at(part))
      throw InputError(other.path_.string(), "", "it holds the dataset of another study, program or tissue table",
                       "merge folders of the same study alone");
  std::uint32_t moved = 0;
  const std::uint32_t count = shards();
  for (std::uint32_t shard = 0; shard < count; ++shard) {
    if (has_shard(shard) || !other.has_shard(shard)) continue;
    const fs::path from = other.shard_file(shard);
    if (rename_to_new(from, shard_file(shard)) == Renamed::on_another_disk) {
      std::error_code error;
      const fs::path near = temporary_for(shard);
      fs::copy_file(from, near, fs::copy_options::overwrite_existing, error);
      if (error || !flush_to_disk(near)) {
        const std::string why = error ? error.message() : "it cannot be flushed to the disk";
        fs::remove(near, error);
        throw InputError(from.string(), "", "it cannot be copied (" + why + ")",
                         "check the permissions and free space of both folders");
      }
      put_in_place(near, shard);
      fs::remove(from, error);
    }
    ++moved;
  }
  return moved;
}

std::vector<std::string> DatasetFolder::damage() const {
  const Json json = read_manifest(manifest_file());
  std::vector<std::string> all;
  const std::uint32_t count = shards();
  const Json listed = json.value("shards", Json::array());
  for (std::uint32_t shard = 0; shard < count; ++shard) {
    if (!has_shard(shard)) continue;
    const fs::path file = shard_file(shard);
    std::string problem = damage_of_shard(file);
    if (problem.empty()) {
      const ShardSummary summary = read_shard_summary(file);
      if (summary.study_digest != json.at("study").at("digest").get<std::string>())
        problem = "it is a shard of another study";
      else if (shard < listed.size() && listed[shard].value("digest", "") != summary.digest)
        problem = "it is not the shard that the manifest lists";
    }
    if (!problem.empty())
      all.push_back(InputError(file.string(), "", problem, "remove it, and make the shard again").what());
  }
  return all;
}

}  // namespace insonate
