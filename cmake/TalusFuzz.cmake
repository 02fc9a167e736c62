# talus_fuzz_<entry> for each of tests/fuzz/entries.hpp, with libFuzzer of clang (preset fuzz, tools/fuzz.sh). With the sanitizers a source costs
# several times what it does without, so only those that read are compiled, not optimised, and without the checks of each pointer that the
# address sanitizer makes as well.
# Of laws only the checks of their parameters run.
talus_library(fuzz_materials FOLDER materials EXCLUDE laboratory point_path LINKS talus_core)
target_compile_options(talus_fuzz_materials PRIVATE -fno-sanitize=all)
talus_library(fuzz_io FOLDER io
              ONLY accuracy array_ atomic_file hdf5 cell_count csv document field_reader gdal_plugin gmsh_plugin gmsh_read load_mesh
                   http_request manifest map_crs memory mesh_groups plugin msh_ page_block point_file progress_json raster_file reader record_file
                   result_files scalars scene shape signals stl_file study summary_json surface_file terrain_ text_file traps value_type vtk xml_tags
              EXCLUDE scene_schema
              LINKS talus_mesh talus_fuzz_materials
              PRIVATE yaml-cpp nlohmann_json::nlohmann_json VTK::CommonDataModel VTK::CommonCore VTK::IOCore PkgConfig::TALUS_HDF5 ZLIB::ZLIB)
talus_library(fuzz_solver FOLDER solver ONLY cell_order redistribute loads column_beside boundary_conditions dashpots LINKS talus_mesh talus_fuzz_materials)
talus_library(fuzz_app FOLDER app
              ONLY accounts body_forces checkpoints disk_space expression field_columns history new_results progress rank_slices
                   recorder report_survey results runout validate_state watch_drawing
              LINKS talus_fuzz_io talus_fuzz_solver
              PRIVATE muparser::muparser)

# Linking takes longer than compiling an entry: one program, and a name for each entry.
set(sources tests/fuzz/harness.cpp)
foreach(source scene msh checkpoint terrain results)
  list(APPEND sources tests/fuzz/${source}_entry.cpp)
endforeach()
add_executable(talus_fuzz ${sources})
target_link_libraries(talus_fuzz PRIVATE talus_fuzz_app)
target_link_options(talus_fuzz PRIVATE -fsanitize=fuzzer)   # its main()
set_target_properties(talus_fuzz PROPERTIES ENABLE_EXPORTS ON BUILD_RPATH "$ORIGIN")
add_dependencies(talus_fuzz talus_gdal)   # which it opens as a run does
foreach(entry scene msh checkpoint raster points stl outlines record particles series summary history request)
  add_custom_command(TARGET talus_fuzz POST_BUILD COMMAND ${CMAKE_COMMAND} -E create_symlink talus_fuzz talus_fuzz_${entry})
endforeach()
add_custom_target(fuzzers DEPENDS talus_fuzz)
