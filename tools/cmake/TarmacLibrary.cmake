# The layers of the house, kept by the compiler.
#
# A target sees only the folders that it declares: each gets a folder of links of its own, and that
# folder is its whole include path into the project. Linking a library therefore never lends its headers.
#
#   tarmac_library(tarmac_estimators SEES core estimators SOURCES a.cpp b.cpp LINKS tarmac_core Eigen3::Eigen)
#   tarmac_program(tarmac-estimate   SEES core io/sensor estimators SOURCES main.cpp LINKS ...)
#   tarmac_test(core_test LABEL unit SEES core tests/support SOURCES time_test.cpp LINKS tarmac_core)

function(tarmac_sees target)
  set(root ${CMAKE_BINARY_DIR}/sees/${target})
  file(REMOVE_RECURSE ${root})
  foreach(folder IN LISTS ARGN)
    if(NOT IS_DIRECTORY ${CMAKE_SOURCE_DIR}/${folder})
      message(FATAL_ERROR "${target} SEES ${folder}, which is no folder of ${CMAKE_SOURCE_DIR}")
    endif()
    get_filename_component(parent ${root}/${folder} DIRECTORY)
    file(MAKE_DIRECTORY ${parent})
    file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${root}/${folder} SYMBOLIC)
  endforeach()
  target_include_directories(${target} PRIVATE ${root})
endfunction()

function(tarmac_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
    # The same bytes on every machine: a fused multiply-add rounds once where two instructions round twice.
    -ffp-contract=off)
  if(TARMAC_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# What most sources include, parsed once for libraries and once for tests: about three of the eight CPU seconds
# that a test file took. Sources go on including all that they use; with -DTARMAC_PRECOMPILE=OFF they are compiled from that alone.
option(TARMAC_PRECOMPILE "parse Eigen, fmt, the standard library and GoogleTest once" ON)
function(tarmac_precompiled target)
  cmake_parse_arguments(ARG "" "" "HEADERS;OPTIONS;LINKS" ${ARGN})
  if(TARMAC_PRECOMPILE)
    file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp CONTENT "")
    add_library(${target} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
    tarmac_compile_options(${target})
    target_compile_options(${target} PRIVATE ${ARG_OPTIONS})
    target_link_libraries(${target} PRIVATE ${ARG_LINKS})
    target_precompile_headers(${target} PRIVATE ${ARG_HEADERS})
  endif()
endfunction()

function(tarmac_use_precompiled target from)
  if(TARGET ${from})
    target_precompile_headers(${target} REUSE_FROM ${from})
    # Sources with options of their own cannot use it; the compiler then takes the text.
    set_target_properties(${target} PROPERTIES PCH_WARN_INVALID OFF)
    # Lets compiler caches see what was precompiled. What g++ 12 says of the library's own inlined strings (falsely) is
    # silenced in system headers, and only where they are not precompiled.
    target_compile_options(${target} PRIVATE -fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow -Wno-restrict)
  endif()
endfunction()

function(tarmac_library target)
  cmake_parse_arguments(ARG "" "" "SEES;SOURCES;LINKS" ${ARGN})
  add_library(${target} STATIC ${ARG_SOURCES})
  tarmac_compile_options(${target})
  tarmac_sees(${target} ${ARG_SEES})
  target_link_libraries(${target} PUBLIC ${ARG_LINKS})
  tarmac_use_precompiled(${target} tarmac_precompiled)
endfunction()

function(tarmac_program target)
  cmake_parse_arguments(ARG "" "" "SEES;SOURCES;LINKS" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  tarmac_compile_options(${target})
  tarmac_sees(${target} ${ARG_SEES})
  target_link_libraries(${target} PRIVATE ${ARG_LINKS})
endfunction()

# Most of what a test file takes to compile is templates that its neighbours need as well: GoogleTest's, Eigen's. Files of one
# program must then not define the same name twice in a nameless namespace. -DTARMAC_TOGETHER=OFF compiles them one by one,
# which is quicker where one file changes all the time.
option(TARMAC_TOGETHER "compile the sources of a test program several at a time" ON)

# One program of tests. LABEL is unit (all of them together stay below a minute) or slow. With WHOLE it runs as one test
# of ctest's, for tests that share something dear.
function(tarmac_test target)
  cmake_parse_arguments(ARG "WHOLE" "LABEL" "SEES;SOURCES;LINKS" ${ARGN})
  if(NOT ARG_LABEL MATCHES "^(unit|slow)$")
    message(FATAL_ERROR "${target}: LABEL is unit or slow")
  endif()
  tarmac_program(${target} SEES ${ARG_SEES} SOURCES ${ARG_SOURCES} LINKS ${ARG_LINKS} GTest::gmock GTest::gtest_main)
  tarmac_use_precompiled(${target} tarmac_precompiled_tests)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${TARMAC_TOGETHER} UNITY_BUILD_BATCH_SIZE 4)
  if(ARG_WHOLE)
    add_test(NAME ${target} COMMAND ${target})
    set_tests_properties(${target} PROPERTIES LABELS ${ARG_LABEL})
  else()
    gtest_discover_tests(${target} DISCOVERY_MODE PRE_TEST PROPERTIES LABELS ${ARG_LABEL})
  endif()
endfunction()

# Writes the table of a registry, so that adding an entry is one line in a CMake list: no static-initialisation order,
# nothing that the linker may drop. Each entry is an `extern const TYPE name` defined somewhere in the library.
#
#   tarmac_registry(table.cpp HEADER estimators/registry.h NAMESPACE tarmac::estimators TYPE EstimatorEntry
#                   FUNCTION estimators ENTRIES kiss_icp rigid_icp)
function(tarmac_registry file)
  cmake_parse_arguments(ARG "" "HEADER;NAMESPACE;TYPE;FUNCTION" "ENTRIES" ${ARGN})
  set(text "#include \"${ARG_HEADER}\"\n\nnamespace ${ARG_NAMESPACE} {\n\n")
  set(addresses "")
  foreach(entry IN LISTS ARG_ENTRIES)
    string(APPEND text "extern const ${ARG_TYPE} ${entry};\n")
    list(APPEND addresses "&${entry}")
  endforeach()
  list(JOIN addresses ", " addresses)
  string(APPEND text "\nstd::span<const ${ARG_TYPE}* const> ${ARG_FUNCTION}() {\n"
    "  static constexpr const ${ARG_TYPE}* table[] = {${addresses}};\n  return table;\n}\n\n}  // namespace ${ARG_NAMESPACE}\n")
  file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
endfunction()
