// case.toml beside small volumes, and a view appended to it.
#include "sim/volume/case.h"

#include <algorithm>
#include <set>

#include "sim/volume/ct_reader.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

std::filesystem::path folder_with_volumes() {
  Volume<std::int16_t> ct;
  ct.grid.size = {3, 3, 3};
  ct.voxels.assign(27, 40);
  Volume<std::uint8_t> labels{ct.grid, std::vector<std::uint8_t>(27, 1)};
  const std::filesystem::path folder = file_with("case/case.toml", "").parent_path();
  write_ct(folder / "ct.nrrd", ct);
  write_labels(folder / "labels.nrrd", labels);
  return folder;
}

template <typename Named>
bool names_differ(const std::vector<Named>& all) {
  std::set<std::string> names;
  return std::all_of(all.begin(), all.end(), [&](const Named& one) { return names.insert(one.name).second; });
}

const Target case_target("case", [](std::string_view bytes) -> std::string {
  static const std::filesystem::path folder = folder_with_volumes();
  file_with("case/case.toml", bytes);
  const Case subject = read_case(folder);
  if (!names_differ(subject.label_table) || !names_differ(subject.landmarks) || !names_differ(subject.views))
    return "a name is used twice";
  std::set<int> values;
  for (const Label& label : subject.label_table)
    if (label.value == 0 || !values.insert(label.value).second) return "a label's value is 0 or used twice";
  for (const ReferenceView& view : subject.views) {
    if (why_not_rigid(view.patient_from_probe.matrix())) return "a view is not rigid";
    for (const std::string& name : view.landmarks)
      if (!subject.find_landmark(name)) return "a view names a landmark that is not there";
    for (const std::string& name : view.targets)
      if (!subject.find_label(name)) return "a view names a label that is not there";
  }
  append_view(folder, {"one_view_more", "One \"view\" more", "curvilinear", 120, {}, {}, Pose{}});
  return read_case(folder).views.size() == subject.views.size() + 1 ? "" : "an appended view is not there";
});

}  // namespace
}  // namespace insonate::fuzz
