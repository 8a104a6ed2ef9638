#include "app/registration/registration_options.h"

#include "sim/core/input_error.h"

namespace insonate {

LiveRequest RegistrationOptions::request() const {
  if (sweep.start_file.empty() && sweep.landmarks_file.empty())
    throw InputError("command line", "register", "no start is named",
                     "give the map from the tracker's frame to the CT as --start FILE, or --landmarks FILE");
  LiveRequest request;
  request.tracker = tracker;
  request.subject = subject;
  request.input = sweep.input();
  request.input.file = tracker;
  request.input.slices = settings.slices;
  request.start = sweep.start();
  request.settings = settings;
  request.refines = refines;
  request.gives_way = !headless;
  request.searches = headless;  // nobody can press the button
  return request;
}

void declare_registration(CLI::App& arguments, RegistrationOptions& options) {
  CLI::App& mode = *arguments.add_subcommand(
      "register",
      "Register real ultrasound with a CT while it is scanned: images and transforms come over OpenIGTLink");
  mode.add_option("--tracker", options.tracker,
                  "Take images and transforms from this OpenIGTLink server, such as PLUS, 3D Slicer, or insonate "
                  "--igtl-server: igtl://HOST[:18944][/NAME][?frame=ras]")
      ->type_name("URI")
      ->required();
  mode.add_option("--case,--ct", options.subject, "Take the patient of this case folder, CT file or DICOM folder")
      ->type_name("PATH")
      ->default_str("the built-in patient");
  declare_sweep_options(mode, options.sweep);
  mode.get_option("--start")->default_str("needed, or --landmarks");
  mode.get_option("--image-to-probe")->default_str("none: each IMAGE message places its image in the frame itself");
  mode.add_option("--search-mm", options.settings.search_mm, "Let a wide search go this far around the estimate, mm")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  mode.add_option("--search-deg", options.settings.search_deg, "Likewise, degrees")
      ->check(CLI::Range(1.0, 90.0))
      ->capture_default_str();
  mode.add_option("--slices", options.settings.slices, "Use this many of the newest images, well spread")
      ->check(CLI::Range(int(kMinImages), 100))
      ->capture_default_str();
  CLI::Option* no_refining = mode.add_flag_callback(
      "--no-refining", [&options] { options.refines = false; }, "Do not refine until the button is pressed");
  mode.add_option("--out", options.out, "Save to this new folder, or to the next free name: NAME-2")
      ->type_name("FOLDER")
      ->capture_default_str();
  mode.add_flag("--headless", options.headless,
                "Run without a window: search widely, refine until it has converged, save, and end")
      ->excludes(no_refining);
  mode.add_option("--seconds", options.seconds, "End after this many seconds")
      ->check(CLI::Range(0.0, 86400.0))
      ->default_str("300 without a window");
  mode.add_option("--screenshot", options.screenshot, "Write the whole screen as a PNG at the end")->type_name("FILE");
  mode.add_option("--state-file", options.state_file,
                  "Write what the registration is doing to this JSON file, and keep it up to date")
      ->type_name("FILE");
  mode.add_option("--width", options.width, "Set the width of the window, pixels")
      ->check(CLI::Range(1024, 7680))
      ->capture_default_str();
  mode.add_option("--height", options.height, "Set the height of the window, pixels")
      ->check(CLI::Range(700, 4320))
      ->capture_default_str();
  mode.footer(
      "Example:\n"
      "  insonate register --tracker igtl://localhost:18944/ProbeToReference --image-to-probe image.txt \\\n"
      "    --ct patient.nii.gz --landmarks points.txt\n"
      "\nExit codes: 0 done, 2 input that cannot be used, 3 without a window: not converged, or any other failure.");
  mode.parse_complete_callback([&options] { options.chosen = true; });
}

}  // namespace insonate
