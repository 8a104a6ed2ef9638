// Included before all else where clang compiles what includes ITK: these two headers of Debian's know GCC alone, and
// refuse a compiler that they do not know. GCC is what they take this one for; nothing else does.
#pragma once

#pragma push_macro("__clang__")
#pragma push_macro("__GNUC__")
#undef __clang__
#undef __GNUC__
#define __GNUC__ 12
#include <itk_compiler_detection.h>
#include <vcl_compiler_detection.h>
#pragma pop_macro("__GNUC__")
#pragma pop_macro("__clang__")
