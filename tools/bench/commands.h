#pragma once

#include <string>
#include <vector>

#include "tools/bench/scene.h"
#include "tools/bench/table.h"

/// The commands of insonate-bench: each prints its table as it goes and returns it for --csv.
namespace insonate::bench {

/// What a frame costs with a moving probe, by configuration, and each stage's share of it.
Table measure_frames(const Request& request);

/// The traversal against the paper's own method, both in turn, and each one's error against the converged reference.
Table measure_paper(const Request& request);

/// The traversal by an invocation a line and by a work group a line, both in turn: of one plane by configuration, and
/// of sweeps.
Table measure_work_divisions(const Request& request);

/// Many images in one call against one a call, by configuration: model W's images, their LC2 with an ultrasound image,
/// and for comparison the trainer's model S.
Table measure_batch(const Request& request);

/// What a volume of a 3D probe costs, by configuration, whose width is also the volume's third side: with a moving
/// probe, scan conversion and on, and with another gain alone.
Table measure_sweep(const Request& request);

/// What the device's linear filter is off by, which exact_filter in Settings mends.
Table measure_filter();

/// What numbers too small for single precision's normal ones cost: a picture behind gas and bone, which is full of
/// them, in turn with one of as many samples in plain tissue.
Table measure_denormals(const Request& request);

/// Run time against error over the settings. Scenes' plots go into one SVG unless `svg` is empty.
Table measure_front(const Request& request, const std::string& svg);

/// What a sample costs the runner of an exam, on one core: scenarios and recorded scans in turn.
Table measure_scoring(const std::vector<std::string>& exams);

/// Prints how the run times of two CSVs differ, setting by setting. Throws InputError.
void compare_runs(const std::string& old_file, const std::string& new_file);

}  // namespace insonate::bench
