// A DICOM file as the middle slice of a series, beside the two others.
//
// Insonate decodes DICOM in a subprocess (sim/volume/subprocess.h), because GDCM asserts on damaged files and allocates
// whatever length they state. The tests read the seeds that way. The fuzzer decodes in its own process, because a
// subprocess per input is slow and hides coverage. There, whatever ends the subprocess ends the input and is no
// finding: an assertion or a signal from a library, an allocation that no valid input needs, and a codec that takes
// more than a second of processor time, as JPEG-LS does for a damaged header. The findings that remain are those in
// Insonate's own code, which alone is instrumented, and exceptions other than InputError.
#include <algorithm>
#include <fstream>

#include "sim/files/files.h"
#include "sim/volume/dicom_image.h"
#include "sim/volume/dicom_series.h"
#include "tests/fuzz/volume_promises.h"

#ifdef INSONATE_FUZZ_IN_PROCESS
#include <dlfcn.h>
#include <sys/time.h>
#include <ucontext.h>

#include <csetjmp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <string_view>

namespace {

sigjmp_buf input_ends;
volatile sig_atomic_t decoding = 0;

/// Whether an address lies in this program and not in one of its libraries.
bool is_own(const void* address) {
  Dl_info there{}, here{};
  return dladdr(address, &there) != 0 && dladdr(reinterpret_cast<const void*>(&is_own), &here) != 0 &&
         there.dli_fbase == here.dli_fbase;
}

/// Whether an address lies in GDCM or in one of the codecs that it uses.
bool is_of_codec(const void* address) {
  Dl_info there{};
  if (dladdr(address, &there) == 0 || there.dli_fname == nullptr) return false;
  const std::string_view library = there.dli_fname;
  return library.find("libgdcm") != std::string_view::npos || library.find("libcharls") != std::string_view::npos ||
         library.find("libopenjp2") != std::string_view::npos;
}

void on_signal(int number, siginfo_t*, void* context) {
#ifdef __x86_64__
  const auto at = static_cast<const ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
  const void* const place = reinterpret_cast<const void*>(at);
  if (decoding && (number == SIGPROF ? is_of_codec(place) : !is_own(place))) siglongjmp(input_ends, number);
#endif
  // AddressSanitizer's allocator, which holds locks, is part of this program, and Insonate's own code calls other
  // libraries: the timer tries again. libFuzzer ends an input that never leaves them.
  if (number == SIGPROF) return;
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

extern "C" void __assert_fail(const char* assertion, const char* file, unsigned line, const char*) noexcept {
  if (decoding) siglongjmp(input_ends, SIGABRT);
  std::fprintf(stderr, "%s:%u: assertion failed: %s\n", file, line, assertion);
  std::abort();
}

// GDCM allocates the lengths that a file states. In the subprocess a limit of memory makes that fail. Here operator new
// fails, before AddressSanitizer spends its time on the block, and what malloc returned ends the input.
constexpr std::size_t kMax = std::size_t(256) << 10;

void* operator new(std::size_t size) {
  if (decoding && size > kMax) throw std::bad_alloc();
  if (void* const block = std::malloc(size)) return block;
  throw std::bad_alloc();
}

void* operator new[](std::size_t size) {
  return operator new(size);
}

void operator delete(void* block) noexcept {
  std::free(block);
}

void operator delete[](void* block) noexcept {
  std::free(block);
}

void operator delete(void* block, std::size_t) noexcept {
  std::free(block);
}

void operator delete[](void* block, std::size_t) noexcept {
  std::free(block);
}

extern "C" void __sanitizer_malloc_hook(const volatile void*, std::size_t size) {
  if (decoding && size > kMax) siglongjmp(input_ends, SIGABRT);
}
#endif

namespace insonate::fuzz {
namespace {

namespace fs = std::filesystem;

/// Reads the grid of a series, and the voxels of the slice in the middle. The tests compile it as well, so that it
/// follows the room's changes.
[[maybe_unused]] std::string broken_by_series(const fs::path& folder, const fs::path& middle) {
  const DicomSeries series = find_dicom_series(folder);
  if (series.slices.size() != std::size_t(series.grid.size.z)) return "there are not as many slices as the grid has";
  if (const std::string broken = broken_in_grid(series.grid, series.grid.count()); !broken.empty()) return broken;
  if (std::find(series.slices.begin(), series.slices.end(), middle) == series.slices.end()) return "";
  check_dicom_slice(middle);
  read_dicom_image(middle, glm::uvec2(series.grid.size));
  return "";
}

#ifdef INSONATE_FUZZ_IN_PROCESS
/// Sends SIGPROF after `first_s` of processor time, and then every 10 ms. With 0 it sends none.
void start_timer(time_t first_s) {
  const itimerval timer{{0, first_s > 0 ? 10'000 : 0}, {first_s, 0}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

std::string broken_in(const fs::path& folder, const fs::path& middle) {
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  action.sa_flags = SA_SIGINFO | SA_NODEFER | SA_ONSTACK;
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGPROF}) sigaction(number, &action, nullptr);
  std::string broken;
  if (sigsetjmp(input_ends, 1) == 0) {
    decoding = 1;
    start_timer(1);
    try {
      broken = broken_by([&] { return broken_by_series(folder, middle); });
    } catch (const std::bad_alloc&) {
    }
  }
  decoding = 0;
  start_timer(0);
  return broken;
}
#else
std::string broken_in(const fs::path& folder, const fs::path&) {
  const Volume<std::int16_t> ct = read_ct(folder);
  return broken_in_grid(ct.grid, ct.voxels.size());
}
#endif

/// The slices to either side, which the corpus holds as any other seed.
fs::path folder_with_slices() {
  fs::path folder;
  for (const char* name : {"slice_below", "slice_above"})
    folder = file_with(std::string("dicom/") + name, read_file(fs::path(INSONATE_FUZZ_CORPORA) / "dicom" / name))
                 .parent_path();
  return folder;
}

const Target dicom_target("dicom", [](std::string_view bytes) {
  static const fs::path folder = folder_with_slices();
  return broken_in(folder, file_with("dicom/slice_between", bytes));
});

}  // namespace
}  // namespace insonate::fuzz
