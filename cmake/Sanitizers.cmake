# CITYMESH_SANITIZE: empty, "address;undefined", "thread" or "fuzzer" (clang, with address and undefined).
set(CITYMESH_SANITIZE "" CACHE STRING "Sanitizers to build with")

if(CITYMESH_SANITIZE STREQUAL "fuzzer")
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  # Boost 1.74 looks for coroutines under clang only where libc++ has them; those of libstdc++ do.
  add_compile_definitions(BOOST_ASIO_HAS_CO_AWAIT)
elseif(CITYMESH_SANITIZE)
  list(JOIN CITYMESH_SANITIZE "," _sanitizers)
  add_compile_options(-fsanitize=${_sanitizers} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${_sanitizers})
endif()
