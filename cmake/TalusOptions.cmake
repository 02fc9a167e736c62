# Flags of every target alike: the precompiled header is shared, and mixed flags would make two meanings of one inline function.

include(CheckCXXCompilerFlag)
# Never -ffast-math: it removes the NaN checks that diagnose a failing run. These two change no result and let loops vectorise.
set(TALUS_COMPILE_OPTIONS -fno-math-errno -fno-trapping-math)
if(TALUS_TRAPS)   # the second lets the compiler do what may trap before it knows whether it is wanted
  list(REMOVE_ITEM TALUS_COMPILE_OPTIONS -fno-trapping-math)
endif()
if(TALUS_LEVEL)
  list(APPEND TALUS_COMPILE_OPTIONS -march=${TALUS_LEVEL})
elseif(TALUS_NATIVE)
  list(APPEND TALUS_COMPILE_OPTIONS -march=native)
  # Without AVX-512, which gains nothing (docs/development/speed.md): Eigen would add up in another order, so that processors differed in the last bits,
  # and gcc's own header of it makes warnings.
  check_cxx_compiler_flag(-mno-avx512f TALUS_KNOWS_AVX512)
  if(TALUS_KNOWS_AVX512)
    list(APPEND TALUS_COMPILE_OPTIONS -mno-avx512f)
  endif()
endif()
set(TALUS_LIBRARY_KIND STATIC)
if(TALUS_SHARED)
  set(TALUS_LIBRARY_KIND SHARED)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  list(APPEND TALUS_COMPILE_OPTIONS -fno-semantic-interposition)   # inside a library calls are calls of itself
endif()
set(TALUS_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
# Packs of numbers are handed over by value, always inside Talus: where the processor has no vectors of their size, gcc would tell at each that
# other programs may do so in another way.
if((TALUS_LEVEL OR NOT TALUS_NATIVE) AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  list(APPEND TALUS_WARNINGS -Wno-psabi)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)   # gcc's -Wconversion does not mean it in C++
  list(APPEND TALUS_WARNINGS -Wno-sign-conversion)
endif()
if(TALUS_WERROR)
  list(APPEND TALUS_WARNINGS -Werror)
endif()
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:${TALUS_COMPILE_OPTIONS};${TALUS_WARNINGS}>")
# As Debian builds programs (dpkg-buildflags with hardening=+all): packages that are handed to others.
if(TALUS_HARDENED)
  set(CMAKE_POSITION_INDEPENDENT_CODE ON)
  add_compile_options(-fstack-protector-strong -Wformat -Werror=format-security -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  add_link_options($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie> -Wl,-z,relro -Wl,-z,now)
endif()
# Packs of four numbers are entries of tensors; where the processor has no vectors of their size Eigen would align such tensors for less.
add_compile_definitions($<$<CONFIG:Release>:EIGEN_NO_DEBUG> EIGEN_MAX_STATIC_ALIGN_BYTES=32)
include_directories(${PROJECT_SOURCE_DIR})

# The exception: sources of the tests, with a precompiled header of their own; an inline function means the same in either. The two warnings
# are of what only -O2 sees through.
if(TALUS_QUICK_TESTS)
  set(TALUS_TEST_OPTIONS -O1 -Wno-mismatched-new-delete -Wno-maybe-uninitialized)
endif()

# Another exception: input, output and commands compute little, and -O2 instead of -O3 saves 5 to 18 % of their compile time (measured batch by
# batch on two machines). They have a precompiled header of their own. An inline function that is not inlined may come from either; steps
# measured in turn differ by less than the noise.
if(CMAKE_BUILD_TYPE STREQUAL Release)
  set(TALUS_OUTER_OPTIONS -O2)
endif()

# gcc looks for garbage from 1.5 GB on: from 128 MB on, which the precompiled header fills alone, it spends a tenth of its time there.
if(TALUS_PCH AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=1500000>)
endif()

find_program(TALUS_CCACHE ccache)
mark_as_advanced(TALUS_CCACHE)
if(TALUS_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Without these two ccache refuses every file that uses a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${TALUS_CCACHE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)
  endif()
endif()
