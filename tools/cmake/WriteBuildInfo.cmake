# Run at every build: writes build_info.cpp only when the commit has changed.
execute_process(COMMAND git describe --always --dirty=-modified --abbrev=12 --exclude=*
  WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE TARMAC_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT TARMAC_COMMIT)
  set(TARMAC_COMMIT unknown)
endif()
configure_file(${SOURCE_DIR}/tools/tarmac/build_info.cpp.in ${OUT} @ONLY)
