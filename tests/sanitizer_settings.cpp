// How the sanitizers look at every program of the project; linked into each that is built with AddressSanitizer, so
// that one started by hand is looked at as the tests are.

// These are called before a program's counters of coverage are there (preset coverage).
#define UNCOUNTED __attribute__((no_profile_instrument_function))

// intercept_tls_get_addr=0: up to GCC 13 LeakSanitizer takes a library's thread-local memory for a block of glibc 2.19
// where it happens to begin 16 bytes into a page, and dies of the address it reads in front of it
// (github.com/google/sanitizers/issues/1322).
//
// quarantine_size_mb: freed memory is kept from reuse for a while, to find who still uses it. llvmpipe frees so much
// that the default of 256 MB fills 24 GiB in a minute of registration; 4 MB keep it below 2 GiB.
extern "C" UNCOUNTED const char* __asan_default_options() {
  return "detect_odr_violation=1:intercept_tls_get_addr=0:quarantine_size_mb=4";
}

extern "C" UNCOUNTED const char* __lsan_default_options() {
  return "print_suppressions=0";
}

// What Mesa's software renderer and the loader beneath it keep until the process ends, and GLib beneath umockdev. HDF5
// keeps some memory of damaged files.
extern "C" UNCOUNTED const char* __lsan_default_suppressions() {
  return "leak:swrast_dri.so\n"
         "leak:libgallium\n"
         "leak:libEGL_mesa.so\n"
         "leak:libGLX_mesa.so\n"
         "leak:libLLVM\n"
         "leak:libglib\n"
         "leak:libgobject\n"
         "leak:libgio\n"
         "leak:libumockdev\n"
         "leak:libhdf5\n";
}

// A driver that is unloaded before the leak check has no name by which its leaks could be distinguished from ours.
extern "C" UNCOUNTED int dlclose(void*) {
  return 0;
}
