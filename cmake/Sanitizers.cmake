# CITYMESH_SANITIZE: empty, "address;undefined", "thread" or "fuzzer" (clang, with address and undefined).
set(CITYMESH_SANITIZE "" CACHE STRING "Sanitizers to build with")

if(CITYMESH_SANITIZE STREQUAL "fuzzer")
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
elseif(CITYMESH_SANITIZE)
  list(JOIN CITYMESH_SANITIZE "," _sanitizers)
  add_compile_options(-fsanitize=${_sanitizers} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${_sanitizers})
endif()
