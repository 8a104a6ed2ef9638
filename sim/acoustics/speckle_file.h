#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/acoustics/speckle_volume.h"
#include "sim/core/grid.h"

/// Scattering volumes as files: NRRD, raw little-endian float32, in the patient's frame (LPS), with keys that say what
/// they were computed for.
namespace insonate {

/// What a scattering volume belongs to. It must not be used with anything else.
struct SpeckleKey {
  std::string patient;     ///< digest of the volume that is insonated
  std::string transducer;  ///< the array's name, and the digest of its numbers
  std::uint32_t seed = 1;

  bool operator==(const SpeckleKey&) const = default;
};

/// Returns the array's name with a digest of all its numbers: "C5-2v, 0123456789abcdef".
std::string identity_of(const Transducer& transducer);

/// Returns the header of a volume's file. It holds all that its voxels depend on, so equal headers mean equal files.
std::string speckle_header(const SpeckleKey& key, const SpecklePlan& plan, const Grid& grid);

/// Returns whether `file` begins with this header and is complete.
bool is_speckle_file(const std::filesystem::path& file, const std::string& header, const Grid& grid);

/// Reads a scattering volume. Throws InputError for a file that is not one, and for one of another patient, transducer
/// or seed than `expected`, by name.
Volume<float> read_speckle_file(const std::filesystem::path& file, const SpeckleKey& expected);

}  // namespace insonate
