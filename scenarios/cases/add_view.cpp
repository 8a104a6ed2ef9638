#include "scenarios/cases/add_view.h"

#include "scenarios/cases/in_picture.h"
#include "scenarios/metrics/view_meter.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/core/text.h"
#include "sim/tissue/skin_contact.h"

namespace insonate {
void add_view(const std::filesystem::path& case_folder, const ReferenceView& view, const TissueTable& tissues) {
  Case subject = read_case(case_folder);
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw InputError(case_folder.string(), "view '" + view.name + "'", problem, remedy);
  };
  if (subject.find_view(view.name)) refuse("the case has a view of this name", "choose another name");
  const Probe* probe = find_probe(view.probe);
  if (!probe) refuse("there is no probe '" + view.probe + "'", suggest(view.probe, probe_names()));
  for (const std::string& name : view.targets)
    if (!subject.find_label(name))
      refuse("no label is called '" + name + "'", suggest(name, names_of(subject.label_table)));
  for (const std::string& name : view.landmarks) {
    const Landmark* landmark = subject.find_landmark(name);
    if (!landmark) refuse("no landmark is called '" + name + "'", suggest(name, names_of(subject.landmarks)));
    if (const std::string why = why_not_in_picture(*landmark, *probe, view.depth_mm, view.patient_from_probe);
        !why.empty())
      refuse("the landmark '" + name + "' " + why, "hold the probe so that it is in the picture, or leave it out");
  }
  if (!SkinContact(subject.ct, *probe).at(view.patient_from_probe))
    refuse("the probe's face is not on the skin", "take a moment at which the probe touches the patient");
  for (const std::string& target : view.targets) {
    // One target at a time: with several, ViewMeter accepts any one of them.
    ReferenceView alone = view;
    alone.targets = {target};
    try {
      ViewMeter(subject, alone, tissues);
    } catch (const InputError&) {
      refuse("the target '" + target + "' is not in its picture", "hold the probe so that it is, or leave it out");
    }
  }
  append_view(case_folder, view);
}

}  // namespace insonate
