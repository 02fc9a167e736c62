# talus_choose(list exclude only): keeps of the sources in the variable `list` what EXCLUDE and ONLY say, stems as below.
function(talus_choose list exclude only)
  set(chosen ${${list}})
  foreach(stem ${exclude})
    list(FILTER chosen EXCLUDE REGEX "/${stem}[^/]*\\.cpp$")
  endforeach()
  if(only)
    string(JOIN "|" stems ${only})
    list(FILTER chosen INCLUDE REGEX "/(${stems})[^/]*\\.cpp$")
  endif()
  set(${list} ${chosen} PARENT_SCOPE)
endfunction()

# TALUS_UNITY: the sources of the target are compiled `size` at a time, once what their headers declare and what several of them instantiate.
# Batches are small enough to keep two cores busy to the end.
function(talus_in_batches target size)
  if(TALUS_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
    # A source that is included looks like a header to gcc, where anonymous namespaces would be wrong.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# talus_library(name [OUTER] [FOLDER folder] [BATCH size] [EXCLUDE stems] [ONLY stems] LINKS public... PRIVATE private...)
# makes the library talus_<name> of all sources in the folder and below it. A stem is the beginning of a file name: EXCLUDE render leaves out
# render.cpp and render_scene.cpp. A folder of headers alone becomes an INTERFACE library. OUTER:
# compiled with TALUS_OUTER_OPTIONS. BATCH: so many sources at a time (TALUS_UNITY), 12 unless told.
function(talus_library name)
  cmake_parse_arguments(arg "OUTER" "FOLDER;BATCH" "EXCLUDE;ONLY;LINKS;PRIVATE" ${ARGN})
  if(NOT arg_FOLDER)
    set(arg_FOLDER ${name})
  endif()
  if(NOT arg_BATCH)
    set(arg_BATCH 12)
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${arg_FOLDER}/*.cpp)
  talus_choose(sources "${arg_EXCLUDE}" "${arg_ONLY}")

  if(sources)
    add_library(talus_${name} ${TALUS_LIBRARY_KIND} ${sources})
    target_link_libraries(talus_${name} PUBLIC ${arg_LINKS} PRIVATE ${arg_PRIVATE})
    if(arg_OUTER)
      target_compile_options(talus_${name} PRIVATE ${TALUS_OUTER_OPTIONS})
      talus_use_pch(talus_${name} talus_outer_pch)
    else()
      talus_use_pch(talus_${name} talus_pch)
    endif()
    talus_in_batches(talus_${name} ${arg_BATCH})
  else()
    add_library(talus_${name} INTERFACE)
    target_link_libraries(talus_${name} INTERFACE ${arg_LINKS})
  endif()
endfunction()

# talus_module(name FOLDER folder ONLY stems USES library PRIVATE private...): libtalus_<name>.so, which the program opens when it needs it
# (dlopen). What it uses of the library it finds in the program that has opened it.
function(talus_module name)
  cmake_parse_arguments(arg "" "FOLDER;USES" "ONLY;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${arg_FOLDER}/*.cpp)
  talus_choose(sources "" "${arg_ONLY}")
  add_library(talus_${name} MODULE ${sources})
  target_link_libraries(talus_${name} PRIVATE Eigen3::Eigen fmt::fmt OpenMP::OpenMP_CXX ${arg_PRIVATE})
  target_compile_options(talus_${name} PRIVATE ${TALUS_OUTER_OPTIONS})
  talus_in_batches(talus_${name} 12)
  if(TALUS_SHARED)
    target_link_libraries(talus_${name} PRIVATE ${arg_USES})
  endif()
  set_property(GLOBAL APPEND PROPERTY TALUS_MODULES talus_${name})
endfunction()

# For whoever links a library that opens modules.
function(talus_use_modules target)
  get_property(modules GLOBAL PROPERTY TALUS_MODULES)
  if(modules)
    add_dependencies(${target} ${modules})
  endif()
  set_target_properties(${target} PROPERTIES ENABLE_EXPORTS ON BUILD_RPATH "$ORIGIN")
endfunction()

function(talus_executable name source library)
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${source})
    message(STATUS "${name} is left out: there is no ${source}")
    return()
  endif()
  add_executable(${name} ${source})
  target_link_libraries(${name} PRIVATE ${library})
  add_dependencies(programs ${name})
  talus_use_modules(${name})
  talus_use_pch(${name} talus_pch)
endfunction()

# VTK's factories must be told, in the library that draws, which rendering back end to make.
function(talus_render_modules)
  get_target_property(type talus_render TYPE)
  if(NOT type STREQUAL INTERFACE_LIBRARY)
    vtk_module_autoinit(TARGETS talus_render MODULES ${ARGN})
  endif()
endfunction()

# scenes/templates/*.yaml as texts in the program, for `talus new` (app/commands/new/new_command.hpp). A file that changes makes them again.
function(talus_embed_templates folder)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/templates/*.yaml)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${files})
  list(LENGTH files count)
  set(texts)
  foreach(file ${files})
    cmake_path(GET file STEM name)
    file(READ ${file} text)
    string(APPEND texts "    {\"${name}\", R\"template(${text})template\"},\n")
  endforeach()
  set(source ${PROJECT_BINARY_DIR}/generated/scene_templates.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
// Made of scenes/templates by cmake.
#include "app/commands/new/new_command.hpp"

#include <array>

namespace talus {

namespace {

constexpr std::array<TemplateText, @count@> embedded_templates{{
@texts@}};

}  // namespace

std::span<const TemplateText> shipped_templates() { return embedded_templates; }

}  // namespace talus
]])
  target_sources(talus_${folder} PRIVATE ${source})
endfunction()

# The version header is asked for at every build and rewritten only when its text changes. Only `source` sees it.
function(talus_version source)
  if(NOT EXISTS ${PROJECT_SOURCE_DIR}/${source})
    return()
  endif()
  set(header ${PROJECT_BINARY_DIR}/generated/talus_version.hpp)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
  string(JOIN " " flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}} ${TALUS_COMPILE_OPTIONS})
  add_custom_target(talus_version_header
    COMMAND ${CMAKE_COMMAND} -D header=${header} -D source_dir=${PROJECT_SOURCE_DIR} -D version=${PROJECT_VERSION}
            -D "compiler=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" -D build_type=${CMAKE_BUILD_TYPE} -D "flags=${flags}"
            -P ${PROJECT_SOURCE_DIR}/cmake/WriteVersion.cmake
    BYPRODUCTS ${header} COMMENT "Version of the sources" VERBATIM)
  add_dependencies(talus_core talus_version_header)
  set_source_files_properties(${PROJECT_SOURCE_DIR}/${source} PROPERTIES
    INCLUDE_DIRECTORIES ${PROJECT_BINARY_DIR}/generated OBJECT_DEPENDS ${header})
endfunction()
