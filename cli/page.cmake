# page.cmake: what PROGRAM prints with --help=KIND, in the file TO.
execute_process(COMMAND ${PROGRAM} --help=${KIND} OUTPUT_FILE ${TO} RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  file(REMOVE ${TO})
  message(FATAL_ERROR "${PROGRAM} --help=${KIND}: ${status}")
endif()
