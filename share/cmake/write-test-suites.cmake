# SPDX-License-Identifier: BSD-3-Clause
# Writes the tests of one program for CTest, one for each suite of GoogleTest. The start of a program takes longer than most of its
# tests, because it links over a hundred libraries.
#
#     cmake -D PROGRAM=file -D PREFIX=name -D RESULTS=folder -D PROPERTIES=list -D OUTPUT=file -P write-test-suites.cmake
#
# The test PREFIX.Suite writes how each of its cases ended to RESULTS/PREFIX.Suite.xml, with dashes for slashes.
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed ERROR_VARIABLE message RESULT_VARIABLE status
  TIMEOUT 60)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} cannot list its tests: ${message}")
endif()

set(tests "")
list(JOIN PROPERTIES " " properties)
string(REGEX MATCHALL "(^|\n)[A-Za-z0-9_/]+[.]" suites "${listed}")
if(NOT suites)
  message(FATAL_ERROR "${PROGRAM} lists no tests")
endif()
foreach(suite IN LISTS suites)
  string(REGEX REPLACE "^\n|[.]$" "" suite "${suite}")
  string(REPLACE "/" "-" file "${PREFIX}.${suite}.xml")
  string(APPEND tests "add_test([==[${PREFIX}.${suite}]==] [==[${PROGRAM}]==]"
    " [==[--gtest_filter=${suite}.*]==] [==[--gtest_output=xml:${RESULTS}/${file}]==])\n"
    "set_tests_properties([==[${PREFIX}.${suite}]==] PROPERTIES ${properties})\n")
endforeach()
file(WRITE ${OUTPUT} "${tests}")
