# Tests are gtest programs, one per room and kind; the kind is their ctest label.
include(GoogleTest)
include(Precompile)

set(CITYMESH_TEST_KINDS "support;architecture;unit;codes;golden;property;fuzz;integration;e2e;bench" CACHE STRING
    "Folders of tests/ to build")
# Rooms whose code runs on several threads: their tests carry the label `threads` too and run under the thread sanitizer.
set(citymesh_threaded_rooms catalogue jobs stores worker pipeline)
add_custom_target(citymesh_thread_tests)
add_custom_target(citymesh_fuzzers)

citymesh_precompiled(gtest LIBRARIES GTest::gtest GTest::gmock
  HEADERS <gtest/gtest.h> <gmock/gmock.h> <algorithm> <filesystem> <fstream> <map> <sstream> <string> <vector>)

# citymesh_test(unit_heal KIND unit SOURCES heal_test.cpp USES heal PRIVATE_USES ...)
# WHOLE: ctest runs the program once and not once per test, because its tests share what is dear to start.
function(citymesh_test name)
  cmake_parse_arguments(ARG "WHOLE" "KIND;TIMEOUT" "SOURCES;USES;PRIVATE_USES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  list(TRANSFORM ARG_USES PREPEND citymesh_)
  target_link_libraries(${name} PRIVATE ${ARG_USES} ${ARG_PRIVATE_USES} citymesh_warnings GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE CITYMESH_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  if(NOT citymesh_proto IN_LIST ARG_PRIVATE_USES)  # gRPC brings -pthread, which the precompiled header does not know
    citymesh_use_precompiled(${name} gtest)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 1200)  # ends what hangs; under sanitizers on a busy machine a test may take minutes
  endif()
  set(labels ${ARG_KIND})
  get_filename_component(room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  if(room IN_LIST citymesh_threaded_rooms)
    string(APPEND labels "-threads")
    add_dependencies(citymesh_thread_tests ${name})
  endif()
  if(ARG_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    string(REPLACE "-" ";" labels "${labels}")
    set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT ${ARG_TIMEOUT})
    return()
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES LABELS "${labels}" TIMEOUT ${ARG_TIMEOUT})
endfunction()

# citymesh_fuzz(fuzz_citygml SOURCES citygml_fuzz.cpp USES source CORPUS files-or-folders...)
# The source defines LLVMFuzzerTestOneInput. In the preset `fuzz` it becomes a libFuzzer program; elsewhere a smoke test that
# feeds the corpus and deterministic mutations of it, so that every build runs every parser on bad input.
function(citymesh_fuzz name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;PRIVATE_USES;CORPUS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  add_dependencies(citymesh_fuzzers ${name})
  list(TRANSFORM ARG_USES PREPEND citymesh_)
  target_link_libraries(${name} PRIVATE ${ARG_USES} ${ARG_PRIVATE_USES} citymesh_warnings)
  if(CITYMESH_SANITIZE STREQUAL "fuzzer")
    target_link_options(${name} PRIVATE -fsanitize=fuzzer)
    set_property(GLOBAL APPEND_STRING PROPERTY citymesh_fuzzers "$<TARGET_FILE:${name}> ${ARG_CORPUS}\n")
  else()
    target_link_libraries(${name} PRIVATE citymesh_fuzz_smoke)
    add_test(NAME ${name} COMMAND ${name} ${ARG_CORPUS})
    set_tests_properties(${name} PROPERTIES LABELS fuzz TIMEOUT 120)
  endif()
endfunction()
