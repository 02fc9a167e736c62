# `cmake --install`, and the Debian package by CPack (make package).  What is installed:
#   bin/talus              a link to the program
#   libexec/talus          the program and its companions, which it finds beside itself, and in lib/ there the libraries of TALUS_SHARED
#   share/talus            the pages, scenes, benchmarks and the Python module, arranged as in the sources, so that links between pages hold
#   share/doc/talus        what Debian wants there, and the site if it was built
# What is written at the time of installing (completions, the manual page, the change log, the bill of materials): cmake/WritePackageFiles.cmake.
set(TALUS_MAINTAINER "The Talus authors <talus@talus.invalid>" CACHE STRING "Who answers for the package: name <mail address>")
set(TALUS_HOME libexec/talus)

# Libraries of Talus are found beside the program or in lib/ there, all others where the system has them.  Before any target is made.
macro(talus_find_own_libraries)
  if(TALUS_SHARED)
    set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/lib")
    set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)   # the folder of the build can be copied as it is
  else()
    set(CMAKE_INSTALL_RPATH "$ORIGIN")
  endif()
endmacro()

# A link that is installed as such, to where it leads from its folder.
function(talus_install_link link leads_to)
  cmake_path(GET link PARENT_PATH folder)
  cmake_path(GET link FILENAME name)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/links/${folder})
  file(CREATE_LINK ${leads_to} ${PROJECT_BINARY_DIR}/links/${link} SYMBOLIC)
  install(FILES ${PROJECT_BINARY_DIR}/links/${folder}/${name} DESTINATION ${folder})
endfunction()

function(talus_install)
  install(TARGETS talus talus-render RUNTIME DESTINATION ${TALUS_HOME})
  set(parts $<TARGET_FILE:talus> $<TARGET_FILE:talus-render>)
  get_property(targets DIRECTORY PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    if(type MATCHES "^(SHARED|MODULE)_LIBRARY$")
      list(APPEND parts $<TARGET_FILE:${target}>)
      install(TARGETS ${target} LIBRARY DESTINATION ${TALUS_HOME}$<$<BOOL:${TALUS_SHARED}>:/lib>)
    endif()
  endforeach()
  install(DIRECTORY ${PROJECT_BINARY_DIR}/lib/glibc-hwcaps DESTINATION ${TALUS_HOME}/lib OPTIONAL)   # tools/build_portable.sh
  install(FILES ${PROJECT_BINARY_DIR}/report.html DESTINATION ${TALUS_HOME} OPTIONAL)
  talus_install_link(bin/talus ../${TALUS_HOME}/talus)

  install(DIRECTORY benchmarks docs python scenes DESTINATION share/talus USE_SOURCE_PERMISSIONS PATTERN __pycache__ EXCLUDE)
  install(FILES README.md CHANGELOG.md CITATION.cff CONTRIBUTING.md LICENSE THIRD_PARTY.md DESTINATION share/talus)
  talus_install_link(lib/python3/dist-packages/talus ../../../share/talus/python/talus)
  install(FILES materials/interface/talus_law.h DESTINATION include)
  install(FILES packaging/copyright DESTINATION share/doc/talus)
  talus_install_link(share/doc/talus/examples ../../talus/scenes)
  install(DIRECTORY build/site/ DESTINATION share/doc/talus/html OPTIONAL)
  install(CODE "
    set(program [[$<TARGET_FILE:talus>]])
    set(parts [[${parts}]])
    set(source_dir [[${PROJECT_SOURCE_DIR}]])
    set(version [[${PROJECT_VERSION}]])
    set(maintainer [[${TALUS_MAINTAINER}]])
    set(to \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share\")
    include([[${PROJECT_SOURCE_DIR}/cmake/WritePackageFiles.cmake]])")
endfunction()

# What no library tells: what draws without a display, plots and reads results.
macro(talus_package)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME talus)
  set(CPACK_PACKAGE_CONTACT "${TALUS_MAINTAINER}")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "material point method on triangles and tetrahedra")
  set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Solids and soil that deform without limit: slopes that fail and run
out, columns that collapse, bodies that collide. One scene file says what is
computed, on unstructured meshes made by gmsh or read from files; results are
for ParaView, as tables, and as pictures.")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
  set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_DEBIAN_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  if(TALUS_SHARED)
    set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
  endif()
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3")
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS
      "libgl1-mesa-dri, openmpi-bin, python3-contourpy, python3-h5py, python3-lz4, python3-markdown, python3-matplotlib, python3-numpy, python3-scipy, python3-yaml, xauth, xvfb")
  set(CPACK_DEBIAN_PACKAGE_SUGGESTS "ffmpeg, gmsh, paraview, python3-pandas, python3-xarray")
  include(CPack)
endmacro()
