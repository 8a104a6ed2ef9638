// insonate-case: describes a case, a CT file or a DICOM folder; makes cases from patients and phantoms.

#include "scenarios/cases/structures.h"
#include "sim/probe/probe.h"
#include "tools/case/commands.h"
#include "tools/cli/program.h"

using namespace insonate;

int main(int argc, char** argv) {
  CLI::App program("Report what cases, CT files and DICOM folders contain, and make cases from them and from recipes.",
                   "insonate-case");
  program.footer(
      "Examples:\n"
      "  insonate-case inspect ~/scans/patient7            a DICOM folder, read as the trainer reads it\n"
      "  insonate-case inspect --json abdomen.nii.gz\n"
      "  insonate-case import --ct ~/scans/patient7 --labels ~/segmentations/patient7 --out cases/patient7\n"
      "  insonate-case add-view cases/patient7 --name kidney --targets kidney_right --log expert.igs.mha --at 12.5\n"
      "  insonate-case picture --ct abdomen.nii.gz --look Bones --from left bones.png\n"
      "  insonate-case phantom --set free_fluid=true out/free-fluid");
  program.require_subcommand(1);

  std::string path;
  bool json = false;
  CLI::App* inspect_command = program.add_subcommand("inspect", "Report what a case, CT file or DICOM folder contains");
  inspect_command->add_option("PATH", path, "Read this case folder, CT file (.nii, .nrrd, .mha) or DICOM folder")
      ->type_name("PATH")
      ->required();
  inspect_command->add_flag("--json", json, "Print one JSON object, for programs");

  std::string recipe, folder;
  std::vector<std::string> settings;
  CLI::App* phantom = program.add_subcommand("phantom", "Make a phantom from a recipe and write it as a case");
  phantom->add_option("--recipe", recipe, "Follow this recipe, a TOML file")
      ->type_name("FILE")
      ->default_str("the recipe of the built-in abdomen");
  phantom->add_option("--set", settings, "Set an option of the recipe; may be repeated")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1);
  phantom->add_option("FOLDER", folder, "Write the case to this folder")->type_name("FOLDER")->required();

  ImportRequest request;
  std::string imported_folder;
  CLI::App* import =
      program.add_subcommand("import", "Make a case from a CT and the structures that TotalSegmentator found in it");
  import->add_option("--ct", request.ct, "Read this CT file (.nii, .nrrd, .mha) or DICOM folder")
      ->type_name("PATH")
      ->required();
  import
      ->add_option(
          "--labels", request.labels,
          "Read this output of TotalSegmentator: one file with all labels, or a folder with one mask per structure")
      ->type_name("PATH")
      ->required();
  import->add_option("--out", imported_folder, "Write the case to this folder")->type_name("FOLDER")->required();
  bool replace = false;
  import->add_flag("--replace", replace, "Replace the case in that folder, including the views that were added to it");
  import->add_option("--name", request.name, "Show the patient under this name")
      ->type_name("NAME")
      ->default_str("the case folder's name");
  import
      ->add_option(
          "--label-table", request.label_table,
          "Read the labels of a file by this standard table: total for TotalSegmentator 2, total_v1 for version 1")
      ->type_name(one_of(standard_label_tables()))
      ->default_str("the table in the file's header");

  ReferenceView view;
  view.probe = "curvilinear";
  std::string case_folder, pose_file;
  RecordedMoment moment;
  CLI::App* add_view =
      program.add_subcommand("add-view", "Add a plane that an expert has held to a case, as a reference view");
  add_view->add_option("FOLDER", case_folder, "Add the view to this case")->type_name("FOLDER")->required();
  add_view->add_option("--name", view.name, "Name the view: lower-case letters, digits and underscores")
      ->type_name("NAME")
      ->required();
  add_view->add_option("--title", view.title, "Show the view under this title")
      ->type_name("TITLE")
      ->default_str("the name");
  add_view->add_option("--targets", view.targets, "Count the area of these labels in the picture")
      ->type_name("LABEL,...")
      ->delimiter(',');
  add_view->add_option("--landmarks", view.landmarks, "Require these landmarks in the picture")
      ->type_name("LANDMARK,...")
      ->delimiter(',');
  add_view->add_option("--probe", view.probe, "Use this probe")
      ->type_name(one_of(probe_names()))
      ->capture_default_str();
  add_view->add_option("--depth", view.depth_mm, "Set the imaging depth, mm")
      ->check(CLI::Range(20.0, 300.0))
      ->capture_default_str();
  CLI::Option* pose =
      add_view
          ->add_option("--pose", pose_file, "Read the pose from this file: 16 numbers, row-major patient_from_probe")
          ->type_name("FILE");
  CLI::Option* log =
      add_view
          ->add_option("--log", moment.log, "Take the pose from this recorded log (.igs.mha, .seq.mha or .seq.nrrd)")
          ->type_name("FILE");
  CLI::Option* at =
      add_view->add_option("--at", moment.at_s, "Take the pose at this time of the log, seconds after its first frame");
  CLI::Option* transform = add_view
                               ->add_option("--transform", moment.transform,
                                            "Take the pose from this transform of the log, such as ProbeToTracker")
                               ->type_name("NAME")
                               ->default_str("the one from Probe to Patient, Reference or Tracker");
  log->excludes(pose)->needs(at);
  at->needs(log);
  transform->needs(log);

  PatientPicture picture;
  CLI::App* draw = program.add_subcommand("picture", "Draw the patient in 3D, with the ultrasound of a view if named");
  draw->add_option("--case,--ct", picture.subject, "Draw the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  draw->add_option("--look", picture.look,
                   "Show this transfer function of assets/transfer_functions by its name, that of a TOML file, or "
                   "'Surfaces'")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  draw->add_option("--structure", picture.structures,
                   "Show the surface of this labelled structure within the CT; may be repeated")
      ->type_name("NAME");
  draw->add_option("--view", picture.view, "Show the ultrasound of this view of the case in its place")
      ->type_name("NAME");
  draw->add_option("--from", picture.from, "Look from this side")
      ->check(CLI::IsMember(std::vector<std::string>(kSideNames.begin(), kSideNames.end())))
      ->default_str("towards the view's plane, or from the front");
  draw->add_option("--turn", picture.turn_deg, "Turn the patient from there about the long axis, degrees")
      ->check(CLI::Range(-180.0, 180.0));
  draw->add_option("--tilt", picture.tilt_deg, "Tilt the patient's head towards the viewer, degrees")
      ->check(CLI::Range(-90.0, 90.0));
  draw->add_flag("--cut", picture.cut, "Remove what lies between the viewer and the view's plane");
  draw->add_option("--width", picture.width, "Set the picture's width, pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  draw->add_option("--height", picture.height, "Set the picture's height, pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  draw->add_option("IMAGE", picture.out, "Write this PNG")->type_name("FILE")->required();

  SpeckleRequest speckle;
  CLI::App* scatter = program.add_subcommand(
      "speckle",
      "Compute a scattering volume: the speckle of a case from one of its views, by the waves of a real transducer, "
      "for "
      "insonate-render --speckle-volume. A run that was killed goes on when it is started again");
  scatter->add_option("--case,--ct", speckle.subject, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  scatter->add_option("--view", speckle.view, "Look from this view of the case")
      ->type_name("NAME")
      ->default_str("its first view");
  scatter->add_option("--transducer", speckle.transducer, "Take this transducer's file (TOML)")
      ->type_name("FILE")
      ->default_str("the one that stands for the view's probe");
  scatter->add_option("--seed", speckle.seed, "Draw the scatterers from this seed")->capture_default_str();
  scatter
      ->add_option("--voxel", speckle.voxel_mm,
                   "Set the voxels' size along the central line, mm; they are twice as wide and three times as thick")
      ->check(CLI::Range(0.05, 2.0))
      ->capture_default_str();
  scatter->add_option("--thickness", speckle.thickness_mm, "Set the volume's thickness across the view's plane, mm")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  scatter->add_option("FILE", speckle.out, "Write this NRRD")->type_name("FILE")->required();

  return run_program(program, argc, argv, [&] {
    if (inspect_command->parsed())
      inspect(path, json);
    else if (import->parsed())
      import_and_write(request, imported_folder, replace);
    else if (add_view->parsed())
      add_recorded_view(case_folder, view, pose_file, moment);
    else if (scatter->parsed())
      compute_speckle(speckle);
    else if (draw->parsed())
      draw_patient(picture);
    else
      make_and_write(recipe, settings, folder);
    return 0;
  });
}
