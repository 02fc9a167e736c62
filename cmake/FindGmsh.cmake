# gmsh installs neither a CMake package nor a pkg-config file. Defines Gmsh::Gmsh and Gmsh_VERSION.
include(FindPackageHandleStandardArgs)
find_path(Gmsh_INCLUDE_DIR gmsh.h)
find_library(Gmsh_LIBRARY gmsh)

if(Gmsh_INCLUDE_DIR)
  file(STRINGS ${Gmsh_INCLUDE_DIR}/gmsh.h lines REGEX "^#define GMSH_API_VERSION(_MAJOR|_MINOR|_PATCH)? ")
  string(REGEX MATCH "GMSH_API_VERSION \"([0-9.]+)\"" _ "${lines}")
  set(Gmsh_VERSION ${CMAKE_MATCH_1})
endif()

find_package_handle_standard_args(Gmsh REQUIRED_VARS Gmsh_LIBRARY Gmsh_INCLUDE_DIR VERSION_VAR Gmsh_VERSION)
mark_as_advanced(Gmsh_INCLUDE_DIR Gmsh_LIBRARY)

if(Gmsh_FOUND AND NOT TARGET Gmsh::Gmsh)
  add_library(Gmsh::Gmsh UNKNOWN IMPORTED)
  set_target_properties(Gmsh::Gmsh PROPERTIES IMPORTED_LOCATION ${Gmsh_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${Gmsh_INCLUDE_DIR})
endif()
