# Third-party libraries, all from Debian, and why each is there.
find_package(Threads REQUIRED)
find_package(LibXml2 REQUIRED)                 # CityGML: streaming SAX parser with our own limits
find_package(ZLIB REQUIRED)                    # .gz inputs
find_package(nlohmann_json CONFIG REQUIRED)    # options, reports, API bodies
find_package(simdjson CONFIG REQUIRED)         # CityJSON: bounded depth, fast
find_package(PROJ CONFIG REQUIRED)             # coordinate reference systems
find_package(fmt CONFIG REQUIRED)              # formatting (std::format is missing in g++ 12)
find_package(PkgConfig REQUIRED)
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET libzip)  # .zip inputs; its CMake config names programs that are packaged apart
find_library(GEOS_C_LIBRARY geos_c REQUIRED)   # planar overlay on a fixed grid, behind core/geometry/overlay.h
find_path(GEOS_INCLUDE_DIR geos_c.h REQUIRED)
add_library(geos_c INTERFACE)
target_include_directories(geos_c SYSTEM INTERFACE ${GEOS_INCLUDE_DIR})
target_link_libraries(geos_c INTERFACE ${GEOS_C_LIBRARY})

if(CITYMESH_SERVICES)
  find_package(Protobuf REQUIRED)              # before gRPC: module mode
  find_package(gRPC CONFIG REQUIRED)           # streaming API
  find_package(Boost CONFIG REQUIRED)          # Beast: HTTP with coroutines (headers only)
  find_package(OpenSSL REQUIRED)               # signatures and hashes of clients and callbacks, TLS
  find_package(CURL REQUIRED)                  # sends callbacks
  find_package(SQLite3 REQUIRED)               # embedded job store; catalogue with an R*Tree
  pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)  # catalogue: has a file changed?
  pkg_check_modules(LIBPQ REQUIRED IMPORTED_TARGET libpq)  # reads 3DCityDB
  find_package(spdlog CONFIG REQUIRED)         # JSON log lines
  find_package(prometheus-cpp CONFIG REQUIRED) # metrics text format
  find_package(CLI11 CONFIG REQUIRED)          # command line with --help
endif()

if(CITYMESH_TESTS)
  find_package(GTest CONFIG REQUIRED)
endif()

# Last: CGAL alters the module path. Constrained triangulation, behind core/geometry/triangulation.h; alpha wrap and edge
# collapse, behind core/reconstruct/alpha_wrap.h (neither needs Eigen); the checker of the tests shares no code with core/gates.
set(CGAL_DO_NOT_WARN_ABOUT_CMAKE_BUILD_TYPE TRUE)
find_package(CGAL CONFIG REQUIRED)
