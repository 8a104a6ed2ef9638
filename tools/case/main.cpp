// insonate-case: describes a case, a CT file or a DICOM folder; makes cases from patients and phantoms.

#include "tools/case/commands.h"
#include "tools/cli/program.h"

using namespace insonate;

int main(int argc, char** argv) {
  CLI::App program("Looks into cases, CT files and DICOM folders, and makes cases from them and from recipes.",
                   "insonate-case");
  program.footer(
      "Examples:\n"
      "  insonate-case inspect ~/scans/patient7            a DICOM folder, read as the trainer reads it\n"
      "  insonate-case inspect --json abdomen.nii.gz\n"
      "  insonate-case import --ct ~/scans/patient7 --labels ~/segmentations/patient7 --out cases/patient7\n"
      "  insonate-case add-view cases/patient7 --name kidney --targets kidney_right --log expert.igs.mha --at 12.5\n"
      "  insonate-case phantom --set free_fluid=true out/free-fluid");
  program.require_subcommand(1);

  std::string path;
  bool json = false;
  CLI::App* inspect_command = program.add_subcommand("inspect", "Say what a case, CT file or DICOM folder holds");
  inspect_command->add_option("path", path, "A case folder, a .nii, .nrrd, .mha or like file, or a DICOM folder")
      ->required();
  inspect_command->add_flag("--json", json, "For programs: one JSON object");

  std::string recipe, folder;
  std::vector<std::string> settings;
  CLI::App* phantom = program.add_subcommand("phantom", "Make a phantom from a recipe and write it as a case");
  phantom->add_option("--recipe", recipe, "A recipe file; the built-in abdomen without");
  phantom->add_option("--set", settings, "An option of the recipe, KEY=VALUE; may be repeated")
      ->take_all()
      ->expected(1);
  phantom->add_option("folder", folder, "The case folder to write")->required();

  ImportRequest request;
  std::string imported_folder;
  CLI::App* import = program.add_subcommand("import", "Make a case of a CT and what TotalSegmentator found in it");
  import->add_option("--ct", request.ct, "A .nii, .nrrd, .mha or like file, or a DICOM folder")->required();
  import
      ->add_option("--labels", request.labels,
                   "TotalSegmentator's output: one file of many labels, or a folder of a mask for each structure")
      ->required();
  import->add_option("--out", imported_folder, "The case folder to write")->required();
  bool replace = false;
  import->add_flag("--replace", replace, "Write over a case of that folder, with the views that were added to it");
  import->add_option("--name", request.name, "What people see it called (the case folder's name)");
  import->add_option("--label-table", request.label_table,
                     "The standard table that a file of many labels follows, instead of its header's: total "
                     "(TotalSegmentator 2) or total_v1");

  ReferenceView view;
  view.probe = "curvilinear";
  std::string case_folder, pose_file;
  RecordedMoment moment;
  CLI::App* add_view = program.add_subcommand("add-view", "Add a plane that an expert has held to a case");
  add_view->add_option("folder", case_folder, "The case folder")->required();
  add_view->add_option("--name", view.name, "Lower-case letters, digits and underscores")->required();
  add_view->add_option("--title", view.title, "What people see it called (the name)");
  add_view->add_option("--targets", view.targets, "Labels whose area in the picture counts: a,b")->delimiter(',');
  add_view->add_option("--landmarks", view.landmarks, "Landmarks that have to be in the picture: x,y")->delimiter(',');
  add_view->add_option("--probe", view.probe, "curvilinear, linear or phased")->capture_default_str();
  add_view->add_option("--depth", view.depth_mm, "Imaging depth, mm")
      ->check(CLI::Range(20.0, 300.0))
      ->capture_default_str();
  CLI::Option* pose = add_view->add_option("--pose", pose_file, "A file with 16 numbers, row-major patient_from_probe");
  CLI::Option* log = add_view->add_option("--log", moment.log, "Instead: a recorded log (.igs.mha or like file)");
  CLI::Option* at = add_view->add_option("--at", moment.at_s, "When in the log, in seconds after its first frame");
  CLI::Option* transform = add_view->add_option("--transform", moment.transform,
                                                "The probe's transform in the log, as in replay:FILE?transform=");
  log->excludes(pose)->needs(at);
  at->needs(log);
  transform->needs(log);

  return run_program(program, argc, argv, [&] {
    if (inspect_command->parsed())
      inspect(path, json);
    else if (import->parsed())
      import_and_write(request, imported_folder, replace);
    else if (add_view->parsed())
      add_recorded_view(case_folder, view, pose_file, moment);
    else
      make_and_write(recipe, settings, folder);
    return 0;
  });
}
