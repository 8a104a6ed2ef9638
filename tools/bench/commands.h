#pragma once

#include <string>
#include <vector>

#include "sim/registration/free_form.h"
#include "sim/registration/registration.h"
#include "tools/bench/scene.h"
#include "tools/bench/tables/table.h"

/// The commands of insonate-bench. Each prints its table while it runs and returns it for --csv.
namespace insonate::bench {

/// Measures the time of a frame with a moving probe, by configuration, and the share of each stage.
Table measure_frames(const Request& request);

/// Compares the traversal with the paper's own method, frame by frame in alternation. Reports the error of each against
/// the converged reference.
Table measure_paper(const Request& request);

/// Compares the two work divisions of the traversal in alternation: one invocation per line, and one work group per
/// line. Measures a single plane by configuration, and sweeps.
Table measure_work_divisions(const Request& request);

/// Compares many images in one call with one image per call, by configuration: model W's images, their LC2 with an
/// ultrasound image, and for comparison the trainer's model S.
Table measure_batch(const Request& request);

/// Compares model W's images with the processor's own implementations, plain and vectorised, in alternation: single
/// images by configuration, and 1 to 512 images of 256 x 256 in one call. Writes the plots to `svg` unless it is empty.
Table measure_throughput(const Request& request, const std::string& svg);

/// Measures the time of a 3D probe's volume, by configuration; the width is also the volume's third side. The cases are
/// a moving probe, a repeated scan conversion, and a change of the gain only.
Table measure_sweep(const Request& request);

/// What measure_registration() measures.
struct RegistrationRequest {
  /// "lc2", "mi" or "cr"; with "-local" behind it, the search begins at the start alone.
  std::vector<std::string> measures{"lc2", "lc2-local", "mi-local", "cr-local"};
  int starts = 200;
  int first_start = 0;  ///< number of the first start, for measurements in parts
  int images = 20;      ///< of the sweep
  double tilt_deg = 20, slide_mm = 20;
  RegistrationSettings settings = RegistrationSettings();
};

/// Registers a synthetic sweep of model S from many starts that are off by known amounts, by each measure: half of them
/// by up to 40 mm and 40 degrees, the others by up to 20 mm and 15 degrees.
Table measure_registration(const Request& request, const RegistrationRequest& wanted);

/// What measure_deformation() measures.
struct DeformationRequest {
  std::vector<double> breaths_mm{0, 3, 4.5, 6};
  int images = 40;  ///< of the sweep; half of them are fitted
  double tilt_deg = 20, slide_mm = 20;
  FreeFormSettings settings = FreeFormSettings();
};

/// Registers synthetic sweeps of model S of patients that have breathed since the CT: breath() about the middle of the
/// sweep. Compares the errors of the rigid and affine maps and of the deformation with the known truth.
Table measure_deformation(const Request& request, const DeformationRequest& wanted);

/// Measures the error of the device's linear filter, which `exact_filter` in Settings avoids.
Table measure_filter();

/// Measures the cost of denormal numbers in single precision. A picture behind gas and bone, which is full of them,
/// alternates with one of equally many samples in plain tissue.
Table measure_denormals(const Request& request);

/// Measures the live simulator's speckle in a uniform block, beside what theory expects of its pulse, beam and slice:
/// the envelope's statistics, the display's, the grain, and how alike it is after a move of the probe.
Table measure_grain();

/// Measures run time and error over the settings. Writes the scenes' plots to one SVG unless `svg` is empty.
Table measure_front(const Request& request, const std::string& svg);

/// Measures simulation and visualisation together, as Table 1 of the paper does, by what changes from frame to frame:
/// for several transfer functions, at 640 x 480 with up to 512 steps a ray.
Table measure_view(const Request& request);

/// Measures run time and error of the volume rendering over its settings. The error is that against the reference in
/// double precision with a tenth of half a voxel as its step, shaded and pre-integrated.
Table measure_view_front(const Request& request);

/// Measures the time that the runner of an exam takes per sample, on one core. Scenarios and recorded scans alternate
/// in `exams`.
Table measure_scoring(const std::vector<std::string>& exams);

struct WindowSize {
  int width, height;
};
/// Measures the trainer's window: pictures per second with a moving probe, what it takes at rest, and where the time
/// goes. Starts the trainer, which lies beside this program, twice per size with the bundled scan. Throws InputError if
/// there is no display or the trainer fails.
Table measure_window(const std::vector<WindowSize>& sizes);

/// Prints the differences between the run times of two CSVs, setting by setting. Throws InputError.
void compare_runs(const std::string& old_file, const std::string& new_file);

}  // namespace insonate::bench
