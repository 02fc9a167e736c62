# talus_tests(name [FOLDER folder] [EXCLUDE stems] [ONLY stems] [LIBRARY name] [LINKS more...] [SOURCES more...]):
# tests/<folder>/**/*_test.cpp -> talus_<name>_tests, linked with that folder's library only, so that the linker tests the layers too. A test
# whose name contains "Nightly" gets the label nightly, any other the label unit.
function(talus_tests name)
  cmake_parse_arguments(arg "" "FOLDER;LIBRARY" "EXCLUDE;ONLY;LINKS;SOURCES" ${ARGN})
  foreach(default FOLDER LIBRARY)
    if(NOT arg_${default})
      set(arg_${default} ${name})
    endif()
  endforeach()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${arg_FOLDER}/*_test.cpp)
  talus_choose(sources "${arg_EXCLUDE}" "${arg_ONLY}")
  if(NOT sources)
    return()
  endif()
  set(target talus_${name}_tests)
  add_executable(${target} ${sources} ${arg_SOURCES})
  talus_use_modules(${target})
  target_link_libraries(${target} PRIVATE talus_${arg_LIBRARY} ${arg_LINKS} GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_options(${target} PRIVATE ${TALUS_TEST_OPTIONS})
  target_compile_definitions(${target} PRIVATE TALUS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  # A test may see the third-party headers that the folder under test sees, as tools/check_layers.py allows.
  set(seen $<TARGET_PROPERTY:talus_${arg_LIBRARY},INCLUDE_DIRECTORIES>)
  target_include_directories(${target} SYSTEM PRIVATE "$<FILTER:${seen},EXCLUDE,^${PROJECT_SOURCE_DIR}$|^${PROJECT_BINARY_DIR}/>")
  talus_use_pch(${target} talus_tests_pch)
  talus_in_batches(${target} 6)
  if(name STREQUAL app)
    if(TARGET talus)
      target_compile_definitions(${target} PRIVATE TALUS_BINARY="$<TARGET_FILE:talus>" TALUS_MPIEXEC="${MPIEXEC_EXECUTABLE}")
      add_dependencies(${target} talus)
    endif()
    # The calls of the system that fail at will, for the program under test.
    add_library(talus_failing_calls MODULE ${PROJECT_SOURCE_DIR}/tests/failing/failing_calls.cpp)
    target_compile_options(talus_failing_calls PRIVATE -fno-sanitize=all)
    target_link_libraries(talus_failing_calls PRIVATE ${CMAKE_DL_LIBS})
    target_compile_definitions(${target} PRIVATE TALUS_FAILING_CALLS="$<TARGET_FILE:talus_failing_calls>")
    add_dependencies(${target} talus_failing_calls)
    if(TARGET talus-render)
      target_compile_definitions(${target} PRIVATE TALUS_RENDER_BINARY="$<TARGET_FILE:talus-render>")
      add_dependencies(${target} talus-render)
    endif()
  endif()
  # Idle threads of one test must not spin while the next test wants the core.
  set(common DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
  gtest_discover_tests(${target} ${common} TEST_FILTER "-*Nightly*" PROPERTIES LABELS unit TIMEOUT 300 ENVIRONMENT OMP_WAIT_POLICY=passive)
  gtest_discover_tests(${target} ${common} TEST_FILTER "*Nightly*" PROPERTIES LABELS nightly TIMEOUT 7200 ENVIRONMENT OMP_WAIT_POLICY=passive)
endfunction()

# tests/ranks/*_test.cpp -> talus_ranks_tests: what several ranks do together, the whole of it under mpirun with 1, 2, 3 and 4 of them.
function(talus_rank_tests)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/ranks/*_test.cpp)
  add_executable(talus_ranks_tests ${PROJECT_SOURCE_DIR}/tests/ranks/main.cpp ${sources})
  talus_use_modules(talus_ranks_tests)
  target_link_libraries(talus_ranks_tests PRIVATE talus_app GTest::gtest GTest::gmock)
  target_compile_options(talus_ranks_tests PRIVATE ${TALUS_TEST_OPTIONS})
  target_compile_definitions(talus_ranks_tests PRIVATE TALUS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  talus_use_pch(talus_ranks_tests talus_tests_pch)
  # Open MPI refuses root, which is who runs the tests in a container, and more ranks than cores, unless told.  Ranks that wait leave the core to
  # others: unless told they do so only where there are more ranks than cores.
  foreach(ranks 1 2 3 4)
    add_test(NAME ranks.${ranks} COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks} --oversubscribe --bind-to none
                                         $<TARGET_FILE:talus_ranks_tests>)
    set_tests_properties(ranks.${ranks} PROPERTIES LABELS ranks TIMEOUT 300 PROCESSORS 2
      ENVIRONMENT "OMP_WAIT_POLICY=passive;OMP_NUM_THREADS=1;OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMPI_MCA_mpi_yield_when_idle=1")
  endforeach()
endfunction()

# tests/speed/*.cpp -> talus_speed (Google Benchmark). Not a ctest: a number is no verdict.
function(talus_speed library)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/speed/*.cpp)
  if(sources AND TARGET benchmark::benchmark)
    add_executable(talus_speed EXCLUDE_FROM_ALL ${sources})
    target_link_libraries(talus_speed PRIVATE ${library} benchmark::benchmark benchmark::benchmark_main)
    talus_use_pch(talus_speed talus_pch)
  endif()
endfunction()

# The checkers in tools/ are programs too: tools/*_test.py.
function(talus_tool_tests)
  file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/*_test.py)
  foreach(script ${scripts})
    cmake_path(GET script STEM name)
    add_test(NAME tools.${name} COMMAND ${TALUS_PYTHON} ${script})
    set_tests_properties(tools.${name} PROPERTIES LABELS tools TIMEOUT 120)
  endforeach()
endfunction()

# What the recipes of CONTRIBUTING.md take, and that what they add works: in a copy of the tree, which is compiled anew.
function(talus_recipe_test)
  add_test(NAME recipes COMMAND ${TALUS_PYTHON} -B ${PROJECT_SOURCE_DIR}/tests/recipes/recipes_test.py ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR}/recipes)
  set_tests_properties(recipes PROPERTIES LABELS nightly TIMEOUT 7200)
endfunction()

# What a run writes, read by others, and by the module that comes with Talus.
function(talus_python_tests)
  add_test(NAME read_back COMMAND ${TALUS_PYTHON} ${PROJECT_SOURCE_DIR}/tests/app/read_back.py $<TARGET_FILE:talus>)
  set_tests_properties(read_back PROPERTIES LABELS unit TIMEOUT 120)
  file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/python/*_test.py)
  foreach(script ${scripts})
    cmake_path(GET script STEM name)
    string(REGEX REPLACE "_test$" "" name ${name})
    add_test(NAME python.${name} COMMAND ${TALUS_PYTHON} -B ${script} $<TARGET_FILE:talus>)
    set_tests_properties(python.${name} PROPERTIES LABELS unit TIMEOUT 300 ENVIRONMENT "OMP_WAIT_POLICY=passive;MPLBACKEND=Agg")
  endforeach()
  set_tests_properties(python.reader python.gallery PROPERTIES COST 100)   # they take long: not last, when a core has nothing else to do
endfunction()

# The package of the programs at hand, looked into and run from where it is unpacked.  Nobody packs programs with sanitizers.
function(talus_package_test)
  if(CMAKE_CXX_FLAGS MATCHES -fsanitize)
    return()
  endif()
  add_test(NAME package.deb COMMAND ${TALUS_PYTHON} -B ${PROJECT_SOURCE_DIR}/tests/package/package_test.py ${CMAKE_CPACK_COMMAND} ${PROJECT_BINARY_DIR})
  set_tests_properties(package.deb PROPERTIES LABELS "nightly;package" TIMEOUT 300 COST 100)
endfunction()

# The schema of scenes, as editors use it.
function(talus_schema_test)
  if(TARGET talus)
    add_test(NAME schema COMMAND ${TALUS_PYTHON} ${PROJECT_SOURCE_DIR}/tests/app/schema.py $<TARGET_FILE:talus>)
    set_tests_properties(schema PROPERTIES LABELS unit TIMEOUT 120)
  endif()
endfunction()

# Every shipped scene is checked, and run once, coarse and short.
function(talus_scene_tests)
  file(GLOB scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*/scene.yaml)
  if(NOT TARGET talus)
    return()
  endif()
  foreach(scene ${scenes})
    cmake_path(GET scene PARENT_PATH folder)
    cmake_path(GET folder FILENAME name)
    add_test(NAME scenes.check.${name} COMMAND talus check ${scene})
    set_tests_properties(scenes.check.${name} PROPERTIES LABELS scenes TIMEOUT 120)
    add_test(NAME scenes.run.${name} COMMAND talus run ${scene} --quick --force --out ${PROJECT_BINARY_DIR}/scenes/${name} --quiet)
    set_tests_properties(scenes.run.${name} PROPERTIES LABELS scenes-run TIMEOUT 600 PROCESSORS 2 ENVIRONMENT OMP_WAIT_POLICY=passive)
  endforeach()
endfunction()

include(GoogleTest)
