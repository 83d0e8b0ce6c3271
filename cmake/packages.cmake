# packages.cmake — `cpack` in the build folder makes Debian packages: molmesh (programs, pages, example) and libmolmesh-dev
# (headers, libraries, CMake files). packaging/README.md says how they are made and tested.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME molmesh)
set(CPACK_PACKAGE_VENDOR "The molmesh developers")
set(CPACK_PACKAGE_CONTACT "The molmesh developers <maintainers@molmesh.invalid>" CACHE STRING "Maintainer of the packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL programs library)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/packaging/debian/staged.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME molmesh)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON) # libraries of the distribution that builds
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "make, python3")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "bash-completion, freefem++, libfreefem++, man-db, paraview, slurm-client")
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION "tetrahedral meshes of molecules for finite-element solvers
The programs turn the atoms of a molecule into a valid tetrahedral mesh of its
inside, its surroundings or both. The resolution of every residue, chain and
domain can be set. They read PDB, mmCIF and other files, and write the formats
of solvers and viewers.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libmolmesh-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libhwy-dev, libmetis-dev")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "cmake, g++, molmesh")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "tetrahedral meshes of molecules, library for C++
Headers, static libraries and the CMake files that find_package(molmesh) reads,
for programs that make densities and meshes of molecules themselves.")
include(CPack)
