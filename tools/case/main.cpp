// insonate-case: describes a case, a CT file or a DICOM folder; makes cases from patients and phantoms.

#include <functional>
#include <memory>

#include "scenarios/cases/structures.h"
#include "sim/probe/probe.h"
#include "tools/case/commands.h"
#include "tools/cli/program.h"

using namespace insonate;

namespace {

/// What the chosen command does, set when it is parsed.
using Run = std::function<void()>;

void add_inspect(CLI::App& program, Run& run) {
  struct Given {
    std::string path;
    bool json = false;
  };
  const auto given = std::make_shared<Given>();
  CLI::App* command = program.add_subcommand("inspect", "Report what a case, CT file or DICOM folder contains");
  command->add_option("PATH", given->path, "Read this case folder, CT file (.nii, .nrrd, .mha) or DICOM folder")
      ->type_name("PATH")
      ->required();
  command->add_flag("--json", given->json, "Print one JSON object, for programs");
  command->callback([given, &run] { run = [given] { inspect(given->path, given->json); }; });
}

void add_phantom(CLI::App& program, Run& run) {
  struct Given {
    std::string recipe, folder;
    std::vector<std::string> settings;
    bool replace = false;
  };
  const auto given = std::make_shared<Given>();
  CLI::App* command = program.add_subcommand("phantom", "Make a phantom from a recipe and write it as a case");
  command->add_option("--recipe", given->recipe, "Follow this recipe, a TOML file")
      ->type_name("FILE")
      ->default_str("the recipe of the built-in abdomen");
  command->add_option("--set", given->settings, "Set an option of the recipe; may be repeated")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1);
  command->add_option("FOLDER", given->folder, "Write the case to this folder")->type_name("FOLDER")->required();
  command->add_flag("--replace", given->replace,
                    "Replace the case in that folder, including the views that were added to it");
  command->callback([given, &run] {
    run = [given] { make_and_write(given->recipe, given->settings, given->folder, given->replace); };
  });
}

void add_import(CLI::App& program, Run& run) {
  struct Given {
    ImportRequest request;
    std::string folder;
    bool replace = false;
  };
  const auto given = std::make_shared<Given>();
  CLI::App* command =
      program.add_subcommand("import", "Make a case from a CT and the structures that TotalSegmentator found in it");
  command->add_option("--ct", given->request.ct, "Read this CT file (.nii, .nrrd, .mha) or DICOM folder")
      ->type_name("PATH")
      ->required();
  command
      ->add_option(
          "--labels", given->request.labels,
          "Read this output of TotalSegmentator: one file with all labels, or a folder with one mask per structure")
      ->type_name("PATH")
      ->required();
  command->add_option("--out", given->folder, "Write the case to this folder")->type_name("FOLDER")->required();
  command->add_flag("--replace", given->replace,
                    "Replace the case in that folder, including the views that were added to it");
  command->add_option("--name", given->request.name, "Show the patient under this name")
      ->type_name("NAME")
      ->default_str("the case folder's name");
  command
      ->add_option(
          "--label-table", given->request.label_table,
          "Read the labels of a file by this standard table: total for TotalSegmentator 2, total_v1 for version 1")
      ->type_name(one_of(standard_label_tables()))
      ->default_str("the table in the file's header");
  command->callback(
      [given, &run] { run = [given] { import_and_write(given->request, given->folder, given->replace); }; });
}

void add_view(CLI::App& program, Run& run) {
  struct Given {
    std::string folder, pose_file;
    ReferenceView view;
    RecordedMoment moment;
  };
  const auto given = std::make_shared<Given>();
  given->view.probe = "curvilinear";
  CLI::App* command =
      program.add_subcommand("add-view", "Add a plane that an expert has held to a case, as a reference view");
  command->add_option("FOLDER", given->folder, "Add the view to this case")->type_name("FOLDER")->required();
  command->add_option("--name", given->view.name, "Name the view: lower-case letters, digits and underscores")
      ->type_name("NAME")
      ->required();
  command->add_option("--title", given->view.title, "Show the view under this title")
      ->type_name("TITLE")
      ->default_str("the name");
  command->add_option("--targets", given->view.targets, "Count the area of these labels in the picture")
      ->type_name("LABEL,...")
      ->delimiter(',');
  command->add_option("--landmarks", given->view.landmarks, "Require these landmarks in the picture")
      ->type_name("LANDMARK,...")
      ->delimiter(',');
  command->add_option("--probe", given->view.probe, "Use this probe")
      ->type_name(one_of(probe_names()))
      ->capture_default_str();
  command->add_option("--depth", given->view.depth_mm, "Set the imaging depth, mm")
      ->check(CLI::Range(20.0, 300.0))
      ->capture_default_str();
  CLI::Option* pose = command
                          ->add_option("--pose", given->pose_file,
                                       "Read the pose from this file: 16 numbers, row-major patient_from_probe")
                          ->type_name("FILE");
  CLI::Option* log = command
                         ->add_option("--log", given->moment.log,
                                      "Take the pose from this recorded log (.igs.mha, .seq.mha or .seq.nrrd)")
                         ->type_name("FILE");
  CLI::Option* at = command->add_option("--at", given->moment.at_s,
                                        "Take the pose at this time of the log, seconds after its first frame");
  CLI::Option* transform = command
                               ->add_option("--transform", given->moment.transform,
                                            "Take the pose from this transform of the log, such as ProbeToTracker")
                               ->type_name("NAME")
                               ->default_str("the one from Probe to Patient, Reference or Tracker");
  log->excludes(pose)->needs(at);
  at->needs(log);
  transform->needs(log);
  command->callback([given, &run] {
    run = [given] { add_recorded_view(given->folder, given->view, given->pose_file, given->moment); };
  });
}

void add_picture(CLI::App& program, Run& run) {
  const auto given = std::make_shared<PatientPicture>();
  CLI::App* command =
      program.add_subcommand("picture", "Draw the patient in 3D, with the ultrasound of a view if named");
  command->add_option("--case,--ct", given->subject, "Draw the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  command
      ->add_option("--look", given->look,
                   "Show this transfer function of assets/transfer_functions by its name, that of a TOML file, or "
                   "'Surfaces'")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  command
      ->add_option("--structure", given->structures,
                   "Show the surface of this labelled structure within the CT; may be repeated")
      ->type_name("NAME");
  command->add_option("--view", given->view, "Show the ultrasound of this view of the case in its place")
      ->type_name("NAME");
  command->add_option("--from", given->from, "Look from this side")
      ->check(CLI::IsMember(std::vector<std::string>(kSideNames.begin(), kSideNames.end())))
      ->default_str("towards the view's plane, or from the front");
  command->add_option("--turn", given->turn_deg, "Turn the patient from there about the long axis, degrees")
      ->check(CLI::Range(-180.0, 180.0));
  command->add_option("--tilt", given->tilt_deg, "Tilt the patient's head towards the viewer, degrees")
      ->check(CLI::Range(-90.0, 90.0));
  command->add_flag("--cut", given->cut, "Remove what lies between the viewer and the view's plane");
  command->add_option("--width", given->width, "Set the picture's width, pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("--height", given->height, "Set the picture's height, pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("IMAGE", given->out, "Write this PNG")->type_name("FILE")->required();
  command->callback([given, &run] { run = [given] { draw_patient(*given); }; });
}

void add_speckle(CLI::App& program, Run& run) {
  const auto given = std::make_shared<SpeckleRequest>();
  CLI::App* command = program.add_subcommand(
      "speckle",
      "Compute a scattering volume: the speckle of a case from one of its views, by the waves of a real transducer, "
      "for insonate-render --speckle-volume. A run that was killed goes on when it is started again");
  command->add_option("--case,--ct", given->subject, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  command->add_option("--view", given->view, "Look from this view of the case")
      ->type_name("NAME")
      ->default_str("its first view");
  command->add_option("--transducer", given->transducer, "Take this transducer's file (TOML)")
      ->type_name("FILE")
      ->default_str("the one that stands for the view's probe");
  command->add_option("--seed", given->seed, "Draw the scatterers from this seed")->capture_default_str();
  command
      ->add_option("--voxel", given->voxel_mm,
                   "Set the voxels' size along the central line, mm; they are twice as wide and three times as thick")
      ->check(CLI::Range(0.05, 2.0))
      ->capture_default_str();
  command->add_option("--thickness", given->thickness_mm, "Set the volume's thickness across the view's plane, mm")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  command->add_option("FILE", given->out, "Write this NRRD")->type_name("FILE")->required();
  command->callback([given, &run] { run = [given] { compute_speckle(*given); }; });
}

}  // namespace

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

  Run run;
  add_inspect(program, run);
  add_phantom(program, run);
  add_import(program, run);
  add_view(program, run);
  add_picture(program, run);
  add_speckle(program, run);
  return run_program(program, argc, argv, [&run] {
    run();
    return 0;
  });
}
