// The working files that a killed recording left behind: up to the first NUL the frames' lines, then the pictures.
#include "devices/record/recording_files.h"
#include "devices/sequence/probe_samples.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target recovery_target("recovery", [](std::string_view bytes) -> std::string {
  const std::size_t end = std::min(bytes.find('\0'), bytes.size());
  const std::filesystem::path file = file_with("run.mha", "");
  std::filesystem::remove(file);
  file_with("run.mha.recording", bytes.substr(0, end));
  file_with("run.mha.recording.images", bytes.substr(std::min(end + 1, bytes.size())));
  if (recover_recording(file) == 0) return "a recording without frames was recovered";
  if (!std::filesystem::exists(file) || std::filesystem::exists(working_file(file)))
    return "the sequence file did not take the place of the working file";
  read_recorded_scan(file);
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
