// Linked into programs that are built with AddressSanitizer: a driver that is unloaded before the leak check has no
// name by which its leaks could be told from ours (tests/mesa-leaks.supp).
extern "C" int dlclose(void*) {
  return 0;
}
