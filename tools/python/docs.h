#pragma once

#include "stub_docs.h"

#include <string_view>

namespace insonate::python {

/// Returns the docstring of a class, a function or, as "Class.name", of a part of a class, from the stubs. Does not
/// compile if it has none there.
consteval const char* doc(std::string_view name) {
  for (const StubDoc& known : kStubDocs)
    if (known.name == name) return known.text;
  throw "the stubs do not describe this name";
}

}  // namespace insonate::python
