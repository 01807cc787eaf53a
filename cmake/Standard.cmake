# Language level and code generation that every target shares.
option(CITYMESH_SERVICES "Build the services (REST, gRPC, stores) and the program" ON)
option(CITYMESH_TESTS "Build the tests" ON)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
# Debug is for tests under sanitizers: fast enough for real data, checked containers, line numbers in stacks.
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g1 -D_GLIBCXX_ASSERTIONS")

# Geometry gives the same answer on every machine: no fused multiply-add, never fast-math.
add_compile_options(-ffp-contract=off)

# The sloppiness is what precompiled headers ask for; it looks at contents, not at times. Paths are taken relative to the
# source tree, so that a fresh clone of the same sources finds what another one compiled.
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${CCACHE})
endif()
find_program(MOLD mold)
if(MOLD)
  add_link_options(-fuse-ld=mold)
endif()
