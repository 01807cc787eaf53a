# One INTERFACE target that all of our own code links; third-party headers are SYSTEM.
option(CITYMESH_WERROR "Warnings are errors" OFF)

add_library(citymesh_warnings INTERFACE)
target_compile_options(citymesh_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
  -Wno-missing-field-initializers
  $<$<CXX_COMPILER_ID:GNU>:-Wno-pedantic>  # __int128 of the exact predicates
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # false alarm of g++ 12 on string concatenation (GCC PR 105651)
  # Instrumented code misleads g++'s flow analysis inside Boost and CGAL headers.
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${CITYMESH_SANITIZE}>>:-Wno-maybe-uninitialized>
  $<$<BOOL:${CITYMESH_WERROR}>:-Werror>)
