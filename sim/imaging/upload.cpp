#include "sim/imaging/upload.h"

#include <cstdio>

#include "sim/imaging/device_volume.h"

namespace insonate::gl {

InputError too_large_for_device(const std::string& file, const Grid& grid, int limit) {
  char voxels[120];
  std::snprintf(voxels, sizeof voxels, "%d x %d x %d voxels of %.3g x %.3g x %.3g mm", grid.size.x, grid.size.y,
                grid.size.z, grid.spacing.x, grid.spacing.y, grid.spacing.z);
  if (limit > 0) {
    const std::string most = std::to_string(limit - 2 * kAirMargin);
    return {file, "", std::string(voxels) + " are more than the " + most + " a side that the graphics card takes",
            "resample it to at most " + most + " voxels along each axis, or crop it"};
  }
  return {file, "", "the graphics card has no memory for " + std::string(voxels),
          "resample it to larger voxels, or crop it"};
}

void upload_ct(const std::string& file, const Grid& grid, const std::function<void()>& upload) {
  try {
    upload();
  } catch (const TextureRefused& refused) {
    throw too_large_for_device(file, grid, refused.limit());
  }
}

void within_device(const std::string& asked, const std::string& remedy, const std::function<void()>& work) {
  try {
    work();
  } catch (const DeviceRefused& refused) {
    throw InputError(asked, "", refused.what(), remedy);
  }
}

}  // namespace insonate::gl
