# Everything is required but what only tests need, nothing is a switch. Packages of Debian: tools/debian-packages.txt; licences: THIRD_PARTY.md.
set(TALUS_VTK_RENDER
  VTK::CommonCore VTK::CommonColor VTK::CommonDataModel VTK::CommonExecutionModel VTK::CommonMath VTK::CommonTransforms
  VTK::FiltersCore VTK::FiltersExtraction VTK::FiltersGeneral VTK::FiltersGeometry VTK::FiltersHybrid VTK::FiltersSources VTK::ImagingCore VTK::IOGeometry VTK::IOImage
  VTK::IOInfovis VTK::IOPLY VTK::IOXML
  VTK::ChartsCore VTK::RenderingContext2D VTK::RenderingContextOpenGL2
  VTK::RenderingCore VTK::RenderingOpenGL2 VTK::RenderingAnnotation VTK::RenderingFreeType)
list(TRANSFORM TALUS_VTK_RENDER REPLACE "VTK::" "" OUTPUT_VARIABLE vtk_components)

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(MPI REQUIRED COMPONENTS C)
target_compile_definitions(MPI::MPI_C INTERFACE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)   # MPI's old C++ classes, which mpi.h would bring along
find_package(METIS 5.1 REQUIRED)
if(TALUS_PROGRAMS)
  find_package(yaml-cpp 0.7 REQUIRED)
  find_package(Gmsh 4.8 REQUIRED)
  find_package(GDAL 3.4 REQUIRED)
  find_package(nlohmann_json 3.11 REQUIRED)
  find_package(VTK 9.1 REQUIRED QUIET COMPONENTS IOCore ${vtk_components})
  find_package(CLI11 2.1 REQUIRED)
  find_package(muparser 2.3 REQUIRED)
  find_package(ZLIB 1.2.11 REQUIRED)
  find_program(TALUS_PYTHON python3 HINTS /usr/bin)   # the one that has Debian's numpy
  set(Python_EXECUTABLE ${TALUS_PYTHON})
  find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development)
  find_package(pybind11 2.10 REQUIRED)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(TALUS_PETSC REQUIRED IMPORTED_TARGET petsc>=3.15)
  # By its full name: plain `hdf5` may be any of several builds, and two of them must not meet in one program.
  pkg_check_modules(TALUS_HDF5 REQUIRED IMPORTED_TARGET hdf5-openmpi>=1.10.7)
  target_compile_definitions(PkgConfig::TALUS_HDF5 INTERFACE OMPI_SKIP_MPICXX)   # hdf5.h brings along mpi.h
endif()
if(NOT DEFINED BUILD_TESTING OR BUILD_TESTING)
  find_package(GTest 1.12 QUIET)
  find_package(benchmark 1.7 QUIET)
  find_program(TALUS_PYTHON python3 HINTS /usr/bin)   # the one that has Debian's numpy
  if(NOT GTest_FOUND OR NOT TALUS_PYTHON)
    message(STATUS "Tests are left out: they need GoogleTest 1.12 and Python. `make test` installs what is missing.")
    set(BUILD_TESTING OFF)
  endif()
endif()
