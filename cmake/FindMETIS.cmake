# METIS installs neither a CMake package nor a pkg-config file. Defines METIS::METIS and METIS_VERSION.
include(FindPackageHandleStandardArgs)
find_path(METIS_INCLUDE_DIR metis.h)
find_library(METIS_LIBRARY metis)

if(METIS_INCLUDE_DIR)
  set(METIS_VERSION)
  foreach(number MAJOR MINOR SUBMINOR)
    file(STRINGS ${METIS_INCLUDE_DIR}/metis.h line REGEX "^#define METIS_VER_${number}[ \t]+[0-9]+")
    string(REGEX MATCH "[0-9]+$" digits "${line}")
    list(APPEND METIS_VERSION ${digits})
  endforeach()
  list(JOIN METIS_VERSION "." METIS_VERSION)
endif()

find_package_handle_standard_args(METIS REQUIRED_VARS METIS_LIBRARY METIS_INCLUDE_DIR VERSION_VAR METIS_VERSION)
mark_as_advanced(METIS_INCLUDE_DIR METIS_LIBRARY)

if(METIS_FOUND AND NOT TARGET METIS::METIS)
  add_library(METIS::METIS UNKNOWN IMPORTED)
  set_target_properties(METIS::METIS PROPERTIES IMPORTED_LOCATION ${METIS_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${METIS_INCLUDE_DIR})
endif()
