# staged.cmake — cpack runs it on the files of the packages before it packs them: what Debian's policy wants of every package.
set(packages programs molmesh library libmolmesh-dev)
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC) # SOURCE_DATE_EPOCH, where it is set
function(compress)
  execute_process(COMMAND gzip -9nf ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
while(packages)
  list(POP_FRONT packages component name)
  set(root ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share)
  file(COPY ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${root}/doc/${name})
  file(WRITE ${root}/doc/${name}/changelog "molmesh (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium\n
  * CHANGELOG.md of the sources tells what changed.\n
 -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  file(GLOB pages ${root}/man/man1/*.1)
  compress(${root}/doc/${name}/changelog ${pages})
endwhile()
