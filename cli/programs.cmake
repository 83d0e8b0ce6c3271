# programs.cmake: pages of the docs, man pages and completion, made by the programs from their tables of options.
#
#   cmake --build build --target program_pages     writes docs/programs/NAME.md
#
# Needs the list `molmesh_programs` and the target `tools`.
set(page_files)
set(docs_commands)
foreach(program ${molmesh_programs})
  set(made man/${program}.1 completions/${program} programs/${program}.md)
  list(TRANSFORM made PREPEND ${CMAKE_BINARY_DIR}/)
  add_custom_command(OUTPUT ${made} DEPENDS ${program}
    COMMAND ${CMAKE_COMMAND} -E make_directory man completions programs
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${program}> -DKIND=man -DTO=man/${program}.1
            -P ${PROJECT_SOURCE_DIR}/cli/page.cmake
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${program}> -DKIND=bash -DTO=completions/${program}
            -P ${PROJECT_SOURCE_DIR}/cli/page.cmake
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${program}> -DKIND=markdown -DTO=programs/${program}.md
            -P ${PROJECT_SOURCE_DIR}/cli/page.cmake
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR} VERBATIM)
  list(APPEND page_files ${made})
  list(APPEND docs_commands COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_BINARY_DIR}/programs/${program}.md
       ${PROJECT_SOURCE_DIR}/docs/programs/${program}.md)
  install(FILES ${CMAKE_BINARY_DIR}/man/${program}.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
          COMPONENT programs)
  install(FILES ${CMAKE_BINARY_DIR}/completions/${program}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT programs)
endforeach()
add_custom_target(pages ALL DEPENDS ${page_files})
add_custom_target(program_pages ${docs_commands} DEPENDS ${page_files})
add_dependencies(tools pages)

if(MOLMESH_TESTS)
  enable_testing()
  find_program(BASH bash REQUIRED)
  add_test(NAME "cli: pages" COMMAND ${BASH} ${PROJECT_SOURCE_DIR}/tests/cli/pages.sh ${CMAKE_BINARY_DIR}
           ${PROJECT_SOURCE_DIR} ${molmesh_programs})
  set_tests_properties("cli: pages" PROPERTIES SKIP_RETURN_CODE 77 LABELS quick)
endif()
