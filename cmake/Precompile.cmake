# Heavy third-party headers, parsed once per build directory and shared by the targets that link their library.
# Off in release, so that an #include someone forgot is found there.
option(CITYMESH_PRECOMPILE "Precompile heavy third-party headers" OFF)

# citymesh_precompiled(gtest HEADERS <gtest/gtest.h> LIBRARIES GTest::gtest): makes the shared header.
function(citymesh_precompiled name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES" ${ARGN})
  if(NOT CITYMESH_PRECOMPILE)
    return()
  endif()
  set(stub ${PROJECT_BINARY_DIR}/precompiled_${name}.cpp)
  file(CONFIGURE OUTPUT ${stub} CONTENT "// Carrier of a precompiled header.\n")
  add_library(citymesh_precompiled_${name} STATIC ${stub})
  target_link_libraries(citymesh_precompiled_${name} PUBLIC ${ARG_LIBRARIES})
  target_precompile_headers(citymesh_precompiled_${name} PRIVATE ${ARG_HEADERS})
endfunction()

# citymesh_use_precompiled(target gtest)
function(citymesh_use_precompiled target name)
  if(CITYMESH_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM citymesh_precompiled_${name})
  endif()
endfunction()
