# external.cmake — libraries of others that have no CMake package of their own everywhere, for the build and for who
# uses what it installs.

# molmesh_external(NAME HEADER [LIBRARY library] [SUFFIX folder]): the target molmesh_external::NAME. The header and the
# library may lie in the folder below the usual places.
function(molmesh_external name header)
  if(TARGET molmesh_external::${name})
    return()
  endif()
  cmake_parse_arguments(arg "" "LIBRARY;SUFFIX" "" ${ARGN})
  string(TOUPPER molmesh_${name} variable)
  find_path(${variable}_INCLUDE ${header} PATH_SUFFIXES ${arg_SUFFIX} REQUIRED)
  mark_as_advanced(${variable}_INCLUDE)
  if(arg_LIBRARY)
    find_library(${variable}_LIBRARY ${arg_LIBRARY} PATH_SUFFIXES ${arg_SUFFIX} REQUIRED)
    mark_as_advanced(${variable}_LIBRARY)
    add_library(molmesh_external::${name} UNKNOWN IMPORTED)
    set_target_properties(molmesh_external::${name} PROPERTIES IMPORTED_LOCATION ${${variable}_LIBRARY})
  else()
    add_library(molmesh_external::${name} INTERFACE IMPORTED)
  endif()
  target_include_directories(molmesh_external::${name} SYSTEM INTERFACE ${${variable}_INCLUDE})
endfunction()
