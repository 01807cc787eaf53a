# citymesh_library(heal SOURCES heal.cpp ... USES geometry citymodel PRIVATE_USES GEOS::geos_c)
# One target per folder; USES is the dependency rule that the architecture test checks against #include lines.
function(citymesh_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;USES;PRIVATE_USES" ${ARGN})
  add_library(citymesh_${name} STATIC ${ARG_SOURCES})
  target_include_directories(citymesh_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  list(TRANSFORM ARG_USES PREPEND citymesh_)
  target_link_libraries(citymesh_${name} PUBLIC ${ARG_USES} PRIVATE ${ARG_PRIVATE_USES} citymesh_warnings)
endfunction()
