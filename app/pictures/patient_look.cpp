#include "app/pictures/patient_look.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "scenarios/words.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/view/body/transfer_function_file.h"

namespace insonate {
namespace fs = std::filesystem;
using view::TransferFunction;
using view::TransferPoint;

namespace {

// Every 13th voxel gives the histogram of any CT to within what the eye can see, in some milliseconds.
constexpr std::size_t kEachVoxel = 13;

std::vector<float> histogram_of(const Volume<std::int16_t>& ct) {
  std::vector<float> bins(view::TransferTable::kEntries / PatientLook::kBin_hu, 0.0f);
  for (std::size_t i = 0; i < ct.voxels.size(); i += kEachVoxel) {
    const int bin = (ct.voxels[i] - view::kFirstTransfer_hu) / PatientLook::kBin_hu;
    if (bin >= 0 && bin < int(bins.size())) bins[std::size_t(bin)] += 1;
  }
  for (float& bin : bins) bin = std::log1p(bin);
  const float most = *std::max_element(bins.begin(), bins.end());
  for (float& bin : bins) bin /= std::max(most, 1.0f);
  return bins;
}

/// Returns a file name for a function. Names in other scripts would all become underscores, so they also have a digest.
std::string file_name(const std::string& name) {
  std::string text;
  for (const char c : name) text += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return text.substr(0, 40) + "-" + digest_of(name).substr(0, 8) + ".toml";
}

}  // namespace

PatientLook::PatientLook() : offered_(view::bundled_transfer_functions()), bundled_(offered_.size()) {}

std::vector<std::string> PatientLook::use_folder(const fs::path& folder) {
  folder_ = folder;
  std::vector<std::string> problems;
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".toml" && entry.path().filename().string().front() != '.')
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    try {
      offered_.push_back(view::read_transfer_function(file));
      own_files_.emplace(offered_.back().name, file);
    } catch (const InputError& error) {
      problems.push_back(error.what());
    }
  }
  return problems;
}

void PatientLook::choose(const std::optional<std::size_t>& index) {
  chosen_ = index;
  base_ = index ? std::optional(offered_[*index]) : std::nullopt;
  shift_hu_ = 0;
  scale_ = 1;
  shown_ = base_;
}

void PatientLook::take(const TransferFunction& function) {
  const auto same = std::find_if(offered_.begin(), offered_.end(),
                                 [&](const TransferFunction& offered) { return offered.name == function.name; });
  const std::size_t index = std::size_t(same - offered_.begin());
  if (same == offered_.end()) offered_.push_back(function);
  choose(index);
  base_ = shown_ = function;
}

void PatientLook::edited() {
  shift_hu_ = 0;
  scale_ = 1;
  base_ = shown_;
}

void PatientLook::move_point(std::size_t index, double hu, double opacity) {
  std::vector<TransferPoint>& points = shown_->points;
  const double least = index == 0 ? view::kFirstTransfer_hu : points[index - 1].hu + 1;
  const double most = index + 1 == points.size() ? view::kLastTransfer_hu : points[index + 1].hu - 1;
  points[index].hu = std::clamp(hu, std::min(least, most), most);
  points[index].opacity = std::clamp(opacity, 0.0, view::kMaxOpacity);
  edited();
}

void PatientLook::colour_point(std::size_t index, const glm::dvec3& colour) {
  shown_->points[index].colour = colour;
  edited();
}

std::optional<std::size_t> PatientLook::add_point(double hu, double opacity) {
  std::vector<TransferPoint>& points = shown_->points;
  if (points.size() >= view::kMaxTransferPoints) return std::nullopt;
  const auto after = std::find_if(points.begin(), points.end(), [&](const TransferPoint& p) { return p.hu >= hu; });
  const std::size_t index = std::size_t(after - points.begin());
  TransferPoint point = shown_->at(hu);
  point.opacity = opacity;
  points.insert(after, point);
  move_point(index, hu, opacity);
  return index;
}

void PatientLook::remove_point(std::size_t index) {
  if (shown_->points.size() <= 2) return;
  shown_->points.erase(shown_->points.begin() + std::ptrdiff_t(index));
  edited();
}

void PatientLook::shift(double hu) {
  shift_hu_ = hu;
  shown_ = base_->moved(shift_hu_, scale_);
}

void PatientLook::scale(double factor) {
  scale_ = factor;
  shown_ = base_->moved(shift_hu_, scale_);
}

bool PatientLook::hides_plane() const {
  constexpr double kFat_hu = -200, kOrgan_hu = 130;  // from the skin to organs with contrast medium
  constexpr double kClear = 0.01;                    // opacity of 1 mm: 5 cm of it let more than half through
  if (!shown_ || !shown_structures().empty()) return true;
  const auto hides = [](const view::TransferPoint& point) { return point.opacity > kClear; };
  const auto is_of_soft_tissue = [](const view::TransferPoint& point) {
    return point.hu > kFat_hu && point.hu < kOrgan_hu;
  };
  return hides(shown_->at(kFat_hu)) || hides(shown_->at(kOrgan_hu)) ||
         std::ranges::any_of(shown_->points, [&](const view::TransferPoint& point) {
           return is_of_soft_tissue(point) && hides(point);
         });
}

fs::path PatientLook::save() {
  if (folder_.empty()) throw std::logic_error("a look is saved without a folder");
  TransferFunction saved = *shown_;
  const auto bundled_end = offered_.begin() + std::ptrdiff_t(bundled_);
  if (std::any_of(offered_.begin(), bundled_end, [&](const auto& bundled) { return bundled.name == saved.name; }))
    saved.name += " (edited)";
  const fs::path file = own_files_.emplace(saved.name, folder_ / file_name(saved.name)).first->second;
  fs::create_directories(folder_);
  view::write_transfer_function(file, saved);
  const auto same = std::find_if(bundled_end, offered_.end(), [&](const auto& own) { return own.name == saved.name; });
  const std::size_t index = std::size_t(same - offered_.begin());
  if (same == offered_.end())
    offered_.push_back(saved);
  else
    *same = saved;
  choose(index);
  return file;
}

fs::path PatientLook::file_of_patient() const {
  return folder_ / "patients" / (digest_of(patient_) + ".toml");
}

void PatientLook::begin(const std::string& patient, const Volume<std::int16_t>& ct) {
  patient_ = patient;
  histogram_ = histogram_of(ct);
  choose(std::nullopt);
  if (!folder_.empty() && fs::exists(file_of_patient())) {
    try {
      take(view::read_transfer_function(file_of_patient()));
    } catch (const InputError&) {  // a look is not worth a dialog
    }
  }
  kept_ = shown_;
}

void PatientLook::offer(const std::vector<Label>& labels, const view::OrganColours& colours) {
  structures_.clear();
  for (const Label& label : labels)
    if (colours[label.value].opacity > 0)
      structures_.push_back({label.value, in_words(label.name), colours[label.value].colour, false});
  // Bones come last, because looks of the CT show them anyway.
  const auto is_bone = [&](const StructureChoice& choice) {
    const auto label =
        std::find_if(labels.begin(), labels.end(), [&](const Label& l) { return l.value == choice.label; });
    return label->tissue.find("bone") != std::string::npos || label->tissue == "cartilage";
  };
  std::stable_partition(structures_.begin(), structures_.end(), std::not_fn(is_bone));
}

std::vector<std::uint8_t> PatientLook::shown_structures() const {
  std::vector<std::uint8_t> shown;
  for (const StructureChoice& structure : structures_)
    if (structure.shown) shown.push_back(structure.label);
  return shown;
}

void PatientLook::keep() {
  if (folder_.empty() || patient_.empty() || shown_ == kept_) return;
  if (shown_) {
    fs::create_directories(file_of_patient().parent_path());
    view::write_transfer_function(file_of_patient(), *shown_);
  } else {
    fs::remove(file_of_patient());
  }
  kept_ = shown_;
}

}  // namespace insonate
