# talus_fuzz_<entry> of tests/fuzz/<entry>_entry.cpp, with libFuzzer of clang (preset fuzz, tools/fuzz.sh). With the sanitizers a source costs
# several times what it does without, so only those that read are compiled, not optimised, and without the checks of each pointer that the
# address sanitizer makes as well.
# Of laws only the checks of their parameters run.
talus_library(fuzz_materials FOLDER materials EXCLUDE laboratory point_path LINKS talus_core)
target_compile_options(talus_fuzz_materials PRIVATE -fno-sanitize=all)
talus_library(fuzz_io FOLDER io
              ONLY accuracy array_ hdf5 cell_count csv document field_reader gdal_door gmsh_door gmsh_mesh gmsh_read history_columns map_crs memory mesh_groups module msh_ point_file polygon_file progress_json raster_file reader scalars scene
                   shape stl_file study surface_file terrain_ text_file vtk whole_file
              EXCLUDE scene_json
              LINKS talus_mesh talus_fuzz_materials
              PRIVATE yaml-cpp nlohmann_json::nlohmann_json VTK::IOXML VTK::CommonDataModel VTK::CommonCore VTK::IOCore PkgConfig::TALUS_HDF5)
talus_library(fuzz_solver FOLDER solver ONLY cell_order deal loads soil_column walls LINKS talus_mesh talus_fuzz_materials)
talus_library(fuzz_app FOLDER app
              ONLY accounts checkpoints disk_space duration expression fields history progress reach recorder results runout signals slices sound_state traps
              LINKS talus_fuzz_io talus_fuzz_solver
              PRIVATE muparser::muparser)

function(talus_fuzz entry)
  set(target talus_fuzz_${entry})
  add_executable(${target} tests/fuzz/harness.cpp tests/fuzz/${entry}_entry.cpp)
  target_compile_definitions(${target} PRIVATE TALUS_FUZZ_ENTRY=fuzz_${entry})
  target_link_libraries(${target} PRIVATE talus_fuzz_app)
  target_link_options(${target} PRIVATE -fsanitize=fuzzer)   # its main()
  add_dependencies(fuzzers ${target})
endfunction()

add_custom_target(fuzzers)
foreach(entry scene msh checkpoint)
  talus_fuzz(${entry})
endforeach()
