// insonate-case speckle: the scattering volume of a case from a view.

#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include "sim/acoustics/response_table.h"
#include "sim/acoustics/speckle_file.h"
#include "sim/acoustics/speckle_volume.h"
#include "sim/core/input_error.h"
#include "sim/core/suggest.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"
#include "tools/case/commands.h"
#include "tools/cli/subject.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

const ReferenceView& chosen_view(const Case& subject, const SpeckleRequest& request) {
  std::vector<std::string> names;
  for (const ReferenceView& view : subject.views) names.push_back(view.name);
  if (names.empty())
    throw InputError(request.subject, "", "no view is marked and no body was found",
                     "add a view with insonate-case add-view");
  if (request.view.empty()) return subject.views.front();
  if (const ReferenceView* view = subject.find_view(request.view)) return *view;
  throw InputError("--view", "", "there is no view named '" + request.view + "'", suggest(request.view, names));
}

/// Shows how much is done and the time that is left, on standard error.
class TimeLeft {
public:
  explicit TimeLeft(int total) : total_(total) {}

  void step() {
    const std::lock_guard lock(mutex_);
    ++done_;
    const double spent_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    const double left_s = spent_s / done_ * (total_ - done_);
    const bool terminal = isatty(STDERR_FILENO) != 0;
    if (!terminal && done_ * 10 / total_ == (done_ - 1) * 10 / total_) return;
    std::fprintf(stderr, "%sScattering volume: %d %%, %.0f s left%s", terminal ? "\r" : "", 100 * done_ / total_,
                 left_s, terminal && done_ < total_ ? "   " : "\n");
  }

private:
  std::mutex mutex_;
  int total_, done_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// The strips of a volume on their way, in a folder beside it that is named after all that they depend on. So a run
/// that was killed goes on, another volume's strips are never taken, and runs that share a volume share its strips.
class Strips {
public:
  Strips(const fs::path& out, const std::string& header, const Grid& grid)
      : folder_(out.string() + ".strips-" + digest_of(header)), grid_(grid) {}

  fs::path file(int strip) const { return folder_ / ("strip-" + std::to_string(strip)); }
  std::size_t bytes(int strip) const {
    const int height = std::min(kStripVoxels, grid_.size.y - strip * kStripVoxels);
    return std::size_t(grid_.size.x) * std::size_t(height) * std::size_t(grid_.size.z) * sizeof(float);
  }
  bool has(int strip) const {
    std::error_code error;
    return fs::file_size(file(strip), error) == bytes(strip) && !error;
  }
  void store(int strip, const std::vector<float>& voxels) const {
    write_file(file(strip), {reinterpret_cast<const char*>(voxels.data()), voxels.size() * sizeof(float)});
  }
  void remove() const {
    std::error_code error;
    fs::remove_all(folder_, error);
  }

private:
  fs::path folder_;
  const Grid& grid_;
};

/// Puts the strips together. Returns false if one has gone: another run was faster.
bool assemble(const fs::path& out, const std::string& header, const Grid& grid, const Strips& strips) {
  std::vector<std::ifstream> files;  // an open file stays readable when another run removes it
  for (int strip = 0; strip < strip_count(grid); ++strip)
    if (!files.emplace_back(strips.file(strip), std::ios::binary)) return false;
  write_atomically(out, [&](const fs::path& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    stream << header;
    std::string rows;
    for (int k = 0; k < grid.size.z; ++k)
      for (int strip = 0; strip < strip_count(grid); ++strip) {
        rows.resize(strips.bytes(strip) / std::size_t(grid.size.z));
        if (!files[std::size_t(strip)].read(rows.data(), std::streamsize(rows.size())))
          throw InputError(strips.file(strip).string(), "", "it cannot be read", "run the command again");
        stream.write(rows.data(), std::streamsize(rows.size()));
      }
    stream.close();
    if (!stream)
      throw InputError(out.string(), "", "it cannot be written", "check the folder's permissions and free space");
  });
  return true;
}

}  // namespace

void compute_speckle(const SpeckleRequest& request) {
  if (fs::path(request.out).extension() != ".nrrd")
    throw InputError(request.out, "", "a scattering volume is written as NRRD", "name a file that ends in .nrrd");
  const TissueTable table = read_tissue_table(assets_folder() / "tissues.toml");
  const Case subject = open_subject(request.subject);
  const ReferenceView& view = chosen_view(subject, request);
  const Probe* probe = find_probe(view.probe);
  if (!probe || probe->kind == ProbeKind::phased)
    throw InputError(request.subject, "view '" + view.name + "'",
                     "its probe '" + view.probe +
                         "' has no scattering volume: lines of a phased array do not leave the "
                         "face side by side",
                     "take a view of a linear or curvilinear probe");
  const Transducer transducer =
      request.transducer.empty() ? bundled_transducer(probe->name) : read_transducer(request.transducer);
  const AcousticVolume volume = make_acoustic_volume(subject.ct, subject.labels, tissue_by_label(subject), table);

  SpecklePlan plan = speckle_plan(*probe, transducer, view.patient_from_probe, view.depth_mm);
  plan.seed = request.seed;
  plan.voxel_mm = request.voxel_mm;
  plan.thickness_mm = request.thickness_mm;
  const Grid grid = speckle_grid(plan);
  const std::string header = speckle_header({digest_of(volume), identity_of(transducer), plan.seed}, plan, grid);
  const Strips strips(request.out, header, grid);
  if (is_speckle_file(request.out, header, grid)) {
    std::printf("%s is there already.\n", request.out.c_str());
    strips.remove();
    return;
  }
  std::printf("%d x %d x %d voxels, %.0f MB.\n", grid.size.x, grid.size.y, grid.size.z, double(grid.count()) * 4e-6);
  std::fflush(stdout);

  const ResponseTable response(transducer, plan.beamforming, plan.depth_mm, 1 / std::pow(plan.cell_mm, 3));
  const AmplitudeAt amplitude = [&volume, inverse = glm::inverse(volume.grid.matrix())](const glm::dvec3& at) {
    return scatterer_amplitude_at(volume, inverse, at);
  };
  do {
    TimeLeft left(strip_count(grid));
    tbb::parallel_for(
        0, strip_count(grid),
        [&](int strip) {
          if (!strips.has(strip)) strips.store(strip, speckle_strip(plan, grid, response, amplitude, strip));
          left.step();
        },
        tbb::simple_partitioner());
  } while (!assemble(request.out, header, grid, strips) && !is_speckle_file(request.out, header, grid));
  strips.remove();
}

}  // namespace insonate
