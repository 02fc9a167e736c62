# Precompiled headers, each made once: talus_pch for what computes, talus_outer_pch for what is compiled with TALUS_OUTER_OPTIONS,
# talus_tests_pch with GoogleTest for the tests.
# Only headers of the standard library, Eigen and fmt: a file must still compile alone (TALUS_PCH=OFF, as the checks do).
function(talus_make_pch name)
  cmake_parse_arguments(arg "" "" "LINKS;HEADERS;OPTIONS" ${ARGN})
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/generated/${name}.cpp CONTENT "")
  add_library(${name} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/generated/${name}.cpp)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt OpenMP::OpenMP_CXX ${arg_LINKS})
  target_compile_options(${name} PRIVATE ${arg_OPTIONS})
  target_precompile_headers(${name} PRIVATE <Eigen/Core> <Eigen/LU> <fmt/format.h>
    <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <optional> <span> <stdexcept>
    <string> <string_view> <tuple> <type_traits> <utility> <variant> <vector> ${arg_HEADERS})
endfunction()

function(talus_use_pch target name)
  if(TALUS_PCH)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()

if(TALUS_PCH)
  talus_make_pch(talus_pch)
  talus_make_pch(talus_outer_pch OPTIONS ${TALUS_OUTER_OPTIONS})
  if(TARGET GTest::gmock)
    talus_make_pch(talus_tests_pch LINKS GTest::gtest GTest::gmock HEADERS <gmock/gmock.h> <gtest/gtest.h> OPTIONS ${TALUS_TEST_OPTIONS})
  endif()
endif()
