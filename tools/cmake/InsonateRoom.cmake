# A room is one folder, one library target, and the only headers its users see.
#
# Every include is written from the repository's root ("sim/core/pose.h"), but no target has the root on its
# include path. Each room's folder is linked into an include folder of its own, which only targets that link the room
# get. So an include that the architecture forbids does not compile.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

option(INSONATE_WERROR "Treat the project's own warnings as errors" OFF)

# Compiler options of all targets of the project's own code. Contraction is off because a fused multiply-add
# rounds differently from the pair it replaces, and scores must be identical to the last bit everywhere. All code is
# position independent, so that shared objects such as the Python module can contain it; programs too, because a
# precompiled header serves only one kind. Nothing is interposed, so that GCC may inline as in a program.
add_library(insonate_options INTERFACE)
target_compile_options(insonate_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -ffp-contract=off
                                                  -fPIC $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>
                                                  $<$<BOOL:${INSONATE_WERROR}>:-Werror>)

# For sources that need more than -O2. Under UndefinedBehaviorSanitizer g++ 12 itself crashes on some of them at -O3.
set(INSONATE_O3 -O3)
if(CMAKE_CXX_FLAGS MATCHES "fsanitize" OR CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(INSONATE_O3 "")
endif()

# ccache needs permission to use a precompiled header in place of its text.
find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${CCACHE}")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(insonate_options INTERFACE -fpch-preprocess)
  endif()
endif()

# The headers that most files include, compiled once. A file must still include everything that it uses: the presets
# clang, tsan and fuzz compile every file alone and without precompiled headers.
add_library(insonate_precompiled OBJECT "${CMAKE_SOURCE_DIR}/tools/cmake/precompiled.cpp")
target_link_libraries(insonate_precompiled PRIVATE insonate_options)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  # With a precompiled header, GCC 12 and 14 report false overflows within std::string's own functions.
  target_compile_options(insonate_options INTERFACE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow)
  # GCC 14 takes the value of an empty std::optional as read where it is replaced.
  if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
    target_compile_options(insonate_options INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
target_precompile_headers(insonate_precompiled PRIVATE "${CMAKE_SOURCE_DIR}/tools/cmake/precompiled.h")

# Compiled with others, a source counts as a header, in which a class may not have members of unnamed namespaces.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(insonate_options INTERFACE -Wno-subobject-linkage)
endif()

# The rooms' include folders are made anew, because a room of an earlier build may have stood where a folder is now. They
# hold links alone.
file(REMOVE_RECURSE "${CMAKE_BINARY_DIR}/rooms")

# The input of tools/room-diagram: each room's folder, and the rooms that it uses.
file(WRITE "${CMAKE_BINARY_DIR}/rooms/folders.txt" "")
file(WRITE "${CMAKE_BINARY_DIR}/rooms/uses.txt" "")

# insonate_room(<name> SOURCES <file>... [NO_UNITY <file>...] [USES <room or library>...] [PRIVATELY <library>...])
# makes the target insonate_<name> (alias insonate::<name>) of the current folder. USES are seen by the room's users
# too, because its headers include them; libraries linked PRIVATELY are not visible to them. Files NO_UNITY are never
# compiled together with others: they have names of their own that others have too, such as the measures of a drawing.
function(insonate_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;NO_UNITY;USES;PRIVATELY" ${ARGN})
  file(RELATIVE_PATH folder "${CMAKE_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  set(include_root "${CMAKE_BINARY_DIR}/rooms/${name}")
  cmake_path(GET folder PARENT_PATH parent)
  file(MAKE_DIRECTORY "${include_root}/${parent}")
  file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}" "${include_root}/${folder}" SYMBOLIC)

  if(ROOM_SOURCES OR ROOM_NO_UNITY)
    add_library(insonate_${name} STATIC ${ROOM_SOURCES} ${ROOM_NO_UNITY})
    set_source_files_properties(${ROOM_NO_UNITY} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    target_include_directories(insonate_${name} PUBLIC "$<BUILD_INTERFACE:${include_root}>")
    target_link_libraries(insonate_${name} PUBLIC ${ROOM_USES}
                                           PRIVATE $<BUILD_INTERFACE:insonate_options> ${ROOM_PRIVATELY})
    target_precompile_headers(insonate_${name} REUSE_FROM insonate_precompiled)
  else()
    add_library(insonate_${name} INTERFACE)
    target_include_directories(insonate_${name} INTERFACE "$<BUILD_INTERFACE:${include_root}>")
    target_link_libraries(insonate_${name} INTERFACE ${ROOM_USES})
  endif()
  add_library(insonate::${name} ALIAS insonate_${name})
  foreach(used IN LISTS ROOM_USES)
    if(used MATCHES "^insonate::(.+)$")
      file(APPEND "${CMAKE_BINARY_DIR}/rooms/uses.txt" "${name} ${CMAKE_MATCH_1}\n")
    endif()
  endforeach()
  file(APPEND "${CMAKE_BINARY_DIR}/rooms/folders.txt" "${name} ${folder}\n")
endfunction()

# insonate_embed(<variable> FUNCTION <name> HEADER <header> [FOLDER <folder>] FILES <file>...) adds to the build a C++
# file, named in the variable, that holds the text of files of the current folder or of a folder in it. It defines the
# function that the header declares, std::string_view FUNCTION(std::string_view name), with its namespace in FUNCTION.
# It returns a file's text, or an empty one for an unknown name.
function(insonate_embed variable)
  cmake_parse_arguments(EMBED "" "FUNCTION;HEADER;FOLDER" "FILES" ${ARGN})
  set(folder "${CMAKE_CURRENT_SOURCE_DIR}")
  if(EMBED_FOLDER)
    string(APPEND folder "/${EMBED_FOLDER}")
  endif()
  list(TRANSFORM EMBED_FILES PREPEND "${folder}/" OUTPUT_VARIABLE files)
  list(JOIN EMBED_FILES "," names)
  set(embedded "${CMAKE_CURRENT_BINARY_DIR}/embedded_files.cpp")
  set(script "${CMAKE_SOURCE_DIR}/tools/cmake/EmbedFiles.cmake")
  add_custom_command(
    OUTPUT "${embedded}"
    COMMAND "${CMAKE_COMMAND}" "-DFOLDER=${folder}" "-DFILES=${names}" "-DHEADER=${EMBED_HEADER}"
            "-DFUNCTION=${EMBED_FUNCTION}" "-DOUTPUT=${embedded}" -P "${script}"
    DEPENDS ${files} "${script}"
    COMMENT "Embedding files of ${folder}"
    VERBATIM)
  set(${variable} "${embedded}" PARENT_SCOPE)
endfunction()

# insonate_program(<name> SOURCES <file>... USES <room or library>... [PRECOMPILED <target>]) makes an executable of the
# project, with the precompiled headers of insonate_precompiled unless another target is named.
function(insonate_program name)
  cmake_parse_arguments(PROGRAM "" "PRECOMPILED" "SOURCES;USES" ${ARGN})
  add_executable(${name} ${PROGRAM_SOURCES})
  target_link_libraries(${name} PRIVATE insonate_options ${PROGRAM_USES})
  if(NOT PROGRAM_PRECOMPILED)
    set(PROGRAM_PRECOMPILED insonate_precompiled)
  endif()
  target_precompile_headers(${name} REUSE_FROM ${PROGRAM_PRECOMPILED})
  if(CMAKE_CXX_FLAGS MATCHES "fsanitize=address")
    target_sources(${name} PRIVATE "${CMAKE_SOURCE_DIR}/tests/sanitizer_settings.cpp")
  endif()
endfunction()
