# openvdb.cmake — the target molmesh_openvdb where the library is, else openvdb_found is OFF. It is found by hand: Debian's
# package file for Imath, which OpenVDB's asks for, names a file of PyImath that need not be installed.
find_path(OPENVDB_INCLUDE openvdb/openvdb.h)
find_path(IMATH_INCLUDE ImathConfig.h PATH_SUFFIXES Imath)
find_library(OPENVDB_LIBRARY openvdb)
find_library(IMATH_LIBRARY Imath)
find_package(TBB QUIET)
set(openvdb_found OFF)
if(OPENVDB_INCLUDE AND OPENVDB_LIBRARY AND IMATH_INCLUDE AND IMATH_LIBRARY AND TBB_FOUND)
  set(openvdb_found ON)
  add_library(molmesh_openvdb INTERFACE)
  target_include_directories(molmesh_openvdb SYSTEM INTERFACE ${OPENVDB_INCLUDE} ${IMATH_INCLUDE})
  target_link_libraries(molmesh_openvdb INTERFACE ${OPENVDB_LIBRARY} ${IMATH_LIBRARY} TBB::tbb)
endif()
