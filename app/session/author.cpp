#include "app/session/author.h"

#include <algorithm>

#include "scenarios/cases/add_view.h"
#include "scenarios/cases/in_picture.h"

namespace insonate {
namespace {

bool is_letter(char c) {
  return c >= 'a' && c <= 'z';
}

}  // namespace

std::string view_name_of(const std::string& title) {
  std::string name;
  for (char c : title) {
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    if (is_letter(c) || (c >= '0' && c <= '9' && !name.empty()))
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

void Author::see(const Session& session) {
  const auto picture = session.frozen_picture();
  const Machine& machine = session.machine();
  if (picture == picture_ && machine.depth_mm == depth_mm_ && machine.probe == probe_) return;
  picture_ = picture;
  depth_mm_ = machine.depth_mm;
  probe_ = machine.probe;
  parts_.clear();
  if (!picture) return;
  const InPicture seen = in_picture(session.loaded_case().subject, machine.transducer(), machine.depth_mm, *picture);
  const auto add = [&](const std::vector<std::string>& names, std::size_t most, bool landmarks) {
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
      parts_.push_back({names[i], landmarks, wanted_.contains(names[i])});
  };
  add(seen.structures, kMaxStructures, false);
  add(seen.landmarks, kMaxLandmarks, true);
}

void Author::toggle(std::size_t part) {
  if (part >= parts_.size()) return;
  Part& turned = parts_[part];
  turned.wanted = !turned.wanted;
  if (turned.wanted)
    wanted_.insert(turned.name);
  else
    wanted_.erase(turned.name);
}

bool Author::ready() const {
  return picture_ && !view_name_of(title_).empty() &&
         std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.wanted; });
}

std::optional<ReferenceView> Author::keep(const Session& session) {
  if (!ready()) return std::nullopt;
  ReferenceView view;
  view.name = view_name_of(title_);
  view.title = title_;
  view.probe = probe_;
  view.depth_mm = depth_mm_;
  view.patient_from_probe = *picture_;
  for (const Part& part : parts_)
    if (part.wanted) (part.landmark ? view.landmarks : view.targets).push_back(part.name);
  add_view(case_folder_, view, session.loaded_case().tissues);
  kept_ = "Kept as '" + view.name + "' in " + (case_folder_ / "case.toml").string() + ".";
  title_.clear();
  wanted_.clear();
  for (Part& part : parts_) part.wanted = false;
  return view;
}

}  // namespace insonate
