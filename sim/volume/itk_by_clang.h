// CMakeLists.txt includes this first in the source that includes ITK, where the compiler is clang. These two headers of
// Debian's know only GCC and refuse any other compiler. They see this compiler as GCC; no other header does.
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
