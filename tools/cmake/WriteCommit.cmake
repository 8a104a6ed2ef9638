# Writes the header OUT with the short name of the commit at SOURCE, or "unknown" if SOURCE is not the root of a git
# repository, as in an unpacked archive. "+" after the name means that files were changed since. The header is not
# rewritten if its content is the same, so that nothing is rebuilt.
set(commit unknown)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND "${GIT}" -C "${SOURCE}" rev-parse --show-toplevel OUTPUT_VARIABLE root ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  file(REAL_PATH "${SOURCE}" source)
  if(root STREQUAL source)
    execute_process(COMMAND "${GIT}" --no-optional-locks -C "${SOURCE}" describe --always --dirty=+ --abbrev=10 --exclude=*
                    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE)
  endif()
endif()
file(CONFIGURE OUTPUT "${OUT}" CONTENT "#define INSONATE_COMMIT \"${commit}\"\n")
